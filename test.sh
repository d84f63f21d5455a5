#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test.
set -euo pipefail
cd "$(dirname "$0")"

./setup.sh test
[ -f build/build.ninja ] && grep -q LAYERLOOP_TESTS:BOOL=ON build/CMakeCache.txt || cmake --preset tests
cmake --build build
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1  # containers run as root
ctest --test-dir build --output-on-failure
