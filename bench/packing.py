"""Settled beds of any size out of one periodic tile.

A tile is a CSV file with the lines `x,y,z,class` [um] of a bed that is settled on z = 0 and periodic over 450 x 450 um;
classes 0 to 3 are radii of 6.5, 10.5, 14 and 21 um. Copies of it side by side make a bed; the order of the grains is
shuffled with a fixed seed, as fresh powder has none.
"""
import pathlib

import numpy as np

SIDE = 450.0  # of the tile [um]
RADII = np.array([6.5, 10.5, 14.0, 21.0])  # [um]
DENSITY = 9187  # [kg/m3]
ROOM_ABOVE = 1.2e-3  # top of the box in the peers' decks [m]


def settled_bed(tile, grains):
    """Centres (n, 3) and radii (n) [m], and both periods [m]; `grains` is a multiple of the tile's number."""
    rows = np.loadtxt(tile, delimiter=",")
    copies, rest = divmod(grains, len(rows))
    if rest or copies < 1:
        raise SystemExit(f"{grains} grains are no multiple of the tile's {len(rows)}")
    along_y = max(d for d in range(1, int(copies**0.5) + 1) if copies % d == 0)
    along_x = copies // along_y
    shifts = [(SIDE * i, SIDE * j, 0.0) for i in range(along_x) for j in range(along_y)]
    centres = np.concatenate([rows[:, :3] + shift for shift in shifts])
    radii = np.tile(RADII[rows[:, 3].astype(int)], copies)
    order = np.random.RandomState(20240607).permutation(grains)
    return centres[order] * 1e-6, radii[order] * 1e-6, along_x * SIDE * 1e-6, along_y * SIDE * 1e-6


def write_packing(tile, grains, folder):
    """PACKING.csv for layerloop and PACKING.data for both peers; returns the path without its ending."""
    path = pathlib.Path(folder) / f"packing_{grains}"
    if path.with_suffix(".data").exists():
        return path
    centres, radii, x, y = settled_bed(tile, grains)
    with open(path.with_suffix(".csv"), "w") as file:
        file.write(f"# periodic_x={x:.17g} periodic_y={y:.17g} floor_z=0 units=m density={DENSITY}\n# x,y,z,radius\n")
        np.savetxt(file, np.column_stack([centres, radii]), fmt="%.17g", delimiter=",")
    ids = np.arange(1, grains + 1)
    with open(path.with_suffix(".data"), "w") as file:
        file.write(f"settled bed\n\n{grains} atoms\n1 atom types\n\n0 {x:.17g} xlo xhi\n0 {y:.17g} ylo yhi\n"
                   f"0 {ROOM_ABOVE} zlo zhi\n\nAtoms\n\n")
        np.savetxt(file, np.column_stack([ids, 0 * ids + 1, 2 * radii, 0 * radii + DENSITY, centres]),
                   fmt="%d %d %.17g %.17g %.17g %.17g %.17g")
    return path
