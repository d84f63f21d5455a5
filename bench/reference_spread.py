#!/usr/bin/python3
"""Figures of reference_spread runs beside those of LIGGGHTS-PUBLIC 3.8 on the same triangles and protocol.

usage: reference_spread.py OUT/ TAG [TAG ...]

Lengths in um. The free surface is sampled at the centres of a 5 um grid with exact sphere caps.
  settled height  mean top of the feed over x = 400..1450, above the pit's floor (-300)
  settled density volume of the grains over that height times 1250 x 175
  reservoir lost  1 - mass with centres left of x = 1550, after over before
  deposited       grains with centres in x = 1700..2950 below z = 30
  bins            15 along the recess (1700..2950): thickness = mean free surface over the floor (-100), bare places count
                  0; mean diameter by number of the centres in the bin
  prewall bins    the same, of the frame whose blade has left them and not yet reached the end wall
  angle           heap in front of the blade, front at 800..1500: five points from crest to toe (12 % of the crest over
                  the feed's level), least squares; mean over frames
"""
import glob
import sys

import numpy as np

LY, FLOOR, BEGIN, END, BINS = 175.0, -100.0, 1700.0, 2950.0, 15
# LIGGGHTS-PUBLIC 3.8.0, three seeds, 2.411e-7 s Rayleigh time, dt 3.592e-8 s: mean, standard deviation over seeds
REFERENCE = {
    "settled height [um]": (387.8, 1.0),
    "settled density": (0.574, 0.0015),
    "reservoir lost [%]": (31.7, 0.2),
    "reservoir mean d after [um]": (24.82, 0.04),
    "deposited": (346, 32),
    "left the domain": (988, 23),
    "angle [deg]": (51.9, 0.6),
}
THICKNESS = ([0.4, 0.1, 1.8, 3.5, 7.4, 15.0, 16.5, 30.0, 35.2, 41.2], [0.4, 0.2, 0.9, 1.4, 2.5, 10.2, 7.3, 5.6, 7.7, 9.5])
DIAMETER = ([17.0, np.nan, 21.2, 20.8, 24.5, 23.8, 23.6, 26.7, 24.7, 24.8], [0, np.nan, 0.9, 2.5, 1.7, 2.2, 0.2, 2.6, 2.3, 0.4])


def read(path):
    with open(path) as f:
        head = [f.readline() for _ in range(9)]
    values = np.loadtxt(path, skiprows=9, ndmin=2)
    radius, xyz = values[:, 1] * 1e6, values[:, 2:5] * 1e6
    return int(head[1]), radius, xyz


def surface(radius, xyz, x0, x1, h=5.0):
    nx, ny = int(round((x1 - x0) / h)), int(round(LY / h))
    top = np.full((nx, ny), np.nan)
    xc, yc = x0 + (np.arange(nx) + 0.5) * h, (np.arange(ny) + 0.5) * h
    for r, (x, y, z) in zip(radius, xyz):
        rows = np.arange(max(int((x - r - x0) // h), 0), min(int((x + r - x0) // h) + 1, nx))
        if rows.size == 0:
            continue
        dy = yc - y
        dy -= LY * np.round(dy / LY)
        cap = r * r - (xc[rows, None] - x) ** 2 - dy[None, :] ** 2
        height = np.where(cap > 0, z + np.sqrt(np.maximum(cap, 0)), np.nan)
        top[rows] = np.fmax(top[rows], height)
    return top


def bins(radius, xyz):
    top = surface(radius, xyz, BEGIN, END) - FLOOR
    edges = np.linspace(BEGIN, END, BINS + 1)
    xc = BEGIN + (np.arange(top.shape[0]) + 0.5) * 5
    thickness, diameter = [], []
    for a, b in zip(edges[:-1], edges[1:]):
        thickness.append(np.nan_to_num(top[(xc >= a) & (xc < b)]).mean())
        inside = (xyz[:, 0] >= a) & (xyz[:, 0] < b)
        diameter.append(2 * radius[inside].mean() if inside.any() else np.nan)
    return np.array(thickness), np.array(diameter)


def heap_angle(radius, xyz, front, feed_level):
    h = 25.0
    top = surface(radius, xyz, front, front + h * int((2700 - front) / h))
    with np.errstate(all="ignore"):
        line = np.nanmean(np.where(np.isnan(top), np.nan, top).reshape(-1, 5, top.shape[1]), axis=(1, 2))
    x = front + (np.arange(line.size) + 0.5) * h
    crest = int(np.nanargmax(line[:12]))
    low = 0.12 * line[crest] + max(0.0, feed_level)
    toe = next((i for i in range(crest, line.size) if not line[i] > low), line.size)
    if toe - crest < 5:
        return np.nan
    at = np.unique(np.round(np.linspace(crest, toe - 1, 5)).astype(int))
    return np.degrees(np.arctan(-np.polyfit(x[at], line[at], 1)[0]))


def figures(folder, tag):
    base = f"{folder}/spread_{tag}_"
    _, r0, p0 = read(base + "settled.dump")
    _, r1, p1 = read(base + "final.dump")
    level = np.nanmean(surface(r0, p0, 400, 1450))
    left = p1[:, 0] < 1550
    zone = (p1[:, 0] > BEGIN) & (p1[:, 0] < END) & (p1[:, 2] < 30)
    frames = sorted(glob.glob(base + "*.frame"))
    fronts = [290 + 2920 * (k + 1) / 58 for k in range(len(frames))]
    angles = [heap_angle(*read(f)[1:], x, level) for f, x in zip(frames, fronts) if 800 < x < 1500]
    before_wall = int(2600 / 2920 * 58) - 1
    result = {
        "settled height [um]": level + 300,
        "settled density": (4 / 3 * np.pi * r0**3).sum() / ((level + 300) * 1250 * LY),
        "reservoir lost [%]": 100 * (1 - (r1[left] ** 3).sum() / (r0**3).sum()),
        "reservoir mean d after [um]": 2 * r1[left].mean(),
        "deposited": zone.sum(),
        "left the domain": len(r0) - len(r1),
        "angle [deg]": np.nanmean(angles),
    }
    return result, bins(*read(frames[before_wall])[1:]), bins(r1, p1)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    runs = [figures(sys.argv[1], tag) for tag in sys.argv[2:]]
    spread = lambda values: np.std(values, ddof=1) if len(values) > 1 else np.nan
    print(f"{'':30}{'layerloop':>12}{'+-':>8}{'LIGGGHTS':>12}{'+-':>8}   deviations")
    for name, (mean, sd) in REFERENCE.items():
        own = [run[0][name] for run in runs]
        print(f"{name:30}{np.mean(own):12.4g}{spread(own):8.2g}{mean:12.4g}{sd:8.2g}   {(np.mean(own) - mean) / sd:+.1f}")
    for index, name, (mean, sd) in ((0, "prewall thickness [um]", THICKNESS), (1, "prewall mean diameter [um]", DIAMETER)):
        print(f"\n{name}, bins 1-10\n  layerloop ", *(f"{v:7.1f}" for v in np.nanmean([r[1][index][:10] for r in runs], axis=0)))
        print("  LIGGGHTS  ", *(f"{v:7.1f}" for v in mean), "\n  +-        ", *(f"{v:7.1f}" for v in sd))
    print("\nfinal thickness [um], bins 1-15\n  layerloop ", *(f"{v:6.1f}" for v in np.nanmean([r[2][0] for r in runs], axis=0)))


if __name__ == "__main__":
    main()
