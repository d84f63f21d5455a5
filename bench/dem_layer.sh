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
ours=$(seconds "$program" "$work/layerloop" 1 s1)
theirs=$(seconds liggghts -in "$deck/spread.liggghts.in" -var tag s1 -var seed 67867967 -var vblade 0.1)
echo "| code | user CPU [s] |"
echo "| --- | --- |"
echo "| layerloop | $ours |"
echo "| liggghts | $theirs |"
awk -v a="$ours" -v b="$theirs" 'BEGIN { printf "ratio %.2f (bar 6): %s\n", b / a, b >= 6 * a ? "reached" : "not reached" }'
