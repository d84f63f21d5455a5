#!/usr/bin/env bash
# Particle-steps per second of layerloop, LIGGGHTS and LAMMPS on the same settled beds, one after the other in every
# round, so that a machine that others use slows all of them alike. `bench/dem_peers.sh --help` tells the options.
exec /usr/bin/python3 "$(dirname "$0")/dem_peers.py" "$@"
