#!/usr/bin/env bash
# Installs what is missing, builds, runs the layer loop on IN718 powder and ends with the path of its report.
# usage: ./demo.sh [FOLDER]      default folder: demo
set -euo pipefail
cd "$(dirname "$0")"
folder=${1:-demo}

./setup.sh
[ -f build/build.ninja ] || cmake --preset release
cmake --build build --target layerloop
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1  # containers run as root
build/layerloop run examples/in718_two_layers.toml -o "$folder" --resume
echo "$(cd "$folder" && pwd)/report.html"
