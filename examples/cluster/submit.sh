#!/bin/bash
# Submits a sweep as a Slurm job array of one task a case, and a last job that writes tables and report.
#   submit.sh SWEEP.toml OUT [options of sbatch, for example --partition=short --cpus-per-task=8]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
export SWEEP=$1 OUT=$2 LAYERLOOP=${LAYERLOOP:-layerloop}
shift 2
plan=$("$LAYERLOOP" sweep "$SWEEP" -o "$OUT" --dry-run | tail -1)   # "36 of 36 cases to do: ..."
cases=$(echo "$plan" | sed 's/^[0-9]* of \([0-9]*\) cases.*/\1/')
echo "$plan"
job=$(sbatch --parsable --array="1-$cases" "$@" "$here/sweep.sbatch")
sbatch --dependency="afterany:$job" "$@" --ntasks=1 --job-name=layerloop-report \
  --wrap "\"$LAYERLOOP\" sweep \"$SWEEP\" -o \"$OUT\" --report"
