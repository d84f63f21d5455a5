#!/usr/bin/env bash
# Installs what layerloop is built from, with apt alone (Debian 12). `setup.sh test` adds what only the tests need.
# Does nothing, and asks for nothing, when every package is already there.
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config
  libopenmpi-dev openmpi-bin libhdf5-openmpi-dev petsc-dev libpetsc-real-dev
  libembree-dev libtbb-dev libcgal-dev libeigen3-dev libboost-dev libnlopt-dev libsodium-dev libmuparser-dev
  libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev libpng-dev librandom123-dev libxxhash-dev)
if [ "${1:-}" = test ]; then
  packages+=(liggghts lammps libgtest-dev libgmock-dev python3-h5py python3-numpy python3-vtk9)
fi

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

run=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: install these as root: ${missing[*]}" >&2; exit 1; }
  run=(sudo)
fi
echo "setup: installing ${#missing[@]} packages with apt"
"${run[@]}" apt-get update -q
"${run[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
