#!/usr/bin/env bash
# Wall time of the thesis' single layer (4500 grains, one pass at 100 mm/s) in layerloop and in LIGGGHTS, on the same
# triangles and protocol, one core each and one after the other. LIGGGHTS takes more than 20 minutes.
# usage: bench/dem_layer.sh DECK_FOLDER [reference_spread]
#   DECK_FOLDER holds spread.liggghts.in and spread_mesh.py, which writes base.stl and blade.stl
set -euo pipefail
deck=$(realpath "$1")
program=$(realpath "${2:-$(dirname "$0")/../build/bench/reference_spread}")
export OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
/usr/bin/python3 "$deck/spread_mesh.py" --out . > /dev/null

seconds() { # of user CPU of a command
  local TIMEFORMAT=%U
  { time "$@" > log 2>&1; } 2>&1
}
awake=$(seconds "$program" "$work/layerloop" 67867967 s1)
asleep=$(seconds "$program" "$work/layerloop" 67867967 s1 sleep)
theirs=$(seconds liggghts -in "$deck/spread.liggghts.in" -var tag s1 -var seed 67867967 -var vblade 0.1)
echo "| code | user CPU [s] | LIGGGHTS over it (bar 6) |"
echo "| --- | --- | --- |"
awk -v a="$awake" -v s="$asleep" -v b="$theirs" 'BEGIN {
  printf "| layerloop, every grain awake | %.0f | %.2f |\n", a, b / a
  printf "| layerloop, grains at rest sleep | %.0f | %.2f |\n", s, b / s
  printf "| LIGGGHTS | %.0f | 1 |\n", b }'
