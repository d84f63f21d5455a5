#!/usr/bin/env bash
# Strong scaling of the settled bed over ranks and threads, the phases of a step, and a model that says where it ends.
# `bench/dem_scaling.sh --help` tells the options.
exec /usr/bin/python3 "$(dirname "$0")/dem_scaling.py" "$@"
