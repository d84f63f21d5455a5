#!/usr/bin/python3
"""Core-minutes until packing and thickness are known to +-1 %, for layerloop and LIGGGHTS on one rig.

usage: dem_quality.py OUT/ LAYERLOOP_SECONDS LIGGGHTS_SECONDS TAG TAG [TAG ...]
  OUT/ and the tags: runs of reference_spread with different seeds; the seconds of one run: bench/dem_layer.sh

Seeds needed: the fewest n with t(0.975, n - 1) s / sqrt(n) <= 1 % of the mean. The two codes solve the same equations on
the same triangles, so the spread s over seeds is a property of the rig: it is pooled over the seeds of both (LIGGGHTS:
three, reference_spread.REFERENCE), and the cost per run tells the codes apart. The range of n follows from the 95 %
interval of s (chi square)."""
import sys

import numpy as np
from scipy import stats

from reference_spread import REFERENCE, THICKNESS, figures

LIGGGHTS_SEEDS = 3


def seeds_needed(relative_sd, wanted=0.01):
    n = 2
    while stats.t.ppf(0.975, n - 1) * relative_sd / np.sqrt(n) > wanted:
        n = n + 1 if n < 1000 else int(n * 1.02)
    return n


def pooled(values, reference_mean, reference_sd):
    """Relative standard deviation over seeds, and the bounds of its 95 % interval."""
    own, theirs = len(values) - 1, LIGGGHTS_SEEDS - 1
    relative = (np.var(values, ddof=1) / np.mean(values) ** 2 * own + (reference_sd / reference_mean) ** 2 * theirs) / (own + theirs)
    freedom = own + theirs
    return np.sqrt(relative * np.array([1, freedom / stats.chi2.ppf(0.975, freedom), freedom / stats.chi2.ppf(0.025, freedom)]))


def main():
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    folder, ours, theirs, tags = sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4:]
    runs = [figures(folder, tag) for tag in tags]
    layer = [run[1][0][6:10].mean() for run in runs]  # slices 7 to 10, before the blade meets the end wall
    layer_mean = np.mean(THICKNESS[0][6:10])
    rows = [
        ("packing of the settled feed", [run[0]["settled density"] for run in runs], *REFERENCE["settled density"]),
        ("thickness of the settled feed", [run[0]["settled height [um]"] for run in runs], *REFERENCE["settled height [um]"]),
        # its seeds are not kept slice by slice together: as if four slices were independent
        ("thickness of the layer, slices 7-10", layer, layer_mean, np.sqrt(np.mean(np.square(THICKNESS[1][6:10])) / 4)),
    ]
    print("| to +-1 % | spread over seeds [%] | seeds needed | layerloop [core min] | LIGGGHTS [core min] |")
    print("| --- | --- | --- | --- | --- |")
    for name, values, mean, sd in rows:
        spread = pooled(values, mean, sd)
        n, fewest, most = (seeds_needed(s) for s in spread)
        print(f"| {name} | {100 * spread[0]:.2g} | {n} ({fewest} to {most}) | {n * ours / 60:.3g} | {n * theirs / 60:.3g} |")


if __name__ == "__main__":
    main()
