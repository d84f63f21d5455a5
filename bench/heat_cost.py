#!/usr/bin/env python3
"""Core-seconds per millimetre of track against the error of the pool that the cells make: `layerloop bench heat --tracks`
over cell sizes, as a table and a picture. The reference is Richardson's, from the two finest grids at second order."""
import argparse
import csv
import json
import subprocess
from pathlib import Path

TRACK = 0.5  # [mm]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="build/layerloop")
    parser.add_argument("--cells", type=float, nargs="+", default=[20, 10, 7.5, 5, 4], help="edges in um, coarse to fine")
    parser.add_argument("-o", type=Path, default=Path("docs/heat-speed"))
    options = parser.parse_args()
    rows = []
    for cell in options.cells:
        command = [options.program, "bench", "heat", "--tracks", "--cell", str(cell * 1e-6)]
        result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        rows += [(name, cell, result[name]) for name in ("316L", "AlSi10Mg")]
    options.o.mkdir(parents=True, exist_ok=True)
    with open(options.o / "cost.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["metal", "cell [um]", "cost [core-s/mm]", "sweeps", "width [um]", "depth [um]", "length [um]",
                        "error of depth [%]"])
        for metal in ("316L", "AlSi10Mg"):
            runs = [(cell, r) for name, cell, r in rows if name == metal]
            (coarse, a), (fine, b) = runs[-2:]
            ratio = (coarse / fine) ** 2
            reference = (ratio * b["depth"] - a["depth"]) / (ratio - 1)
            errors = [100 * (r["depth"] / reference - 1) for _, r in runs]
            costs = [r["seconds"] / TRACK for _, r in runs]
            for (cell, r), cost, error in zip(runs, costs, errors):
                table.writerow([metal, cell, f"{cost:.4g}", r["sweeps"], f"{1e6 * r['width']:.3f}",
                                f"{1e6 * r['depth']:.3f}", f"{1e6 * r['length']:.2f}", f"{error:.3f}"])
    draw(options.o)


def draw(folder):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    rows = list(csv.DictReader(open(folder / "cost.csv")))
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.6))
    for metal, colour in (("316L", "#1f6fb2"), ("AlSi10Mg", "#d08a00")):
        of = [r for r in rows if r["metal"] == metal]
        cost = [float(r["cost [core-s/mm]"]) for r in of]
        left.loglog([abs(float(r["error of depth [%]"])) for r in of], cost, "o-", color=colour, label=metal)
        right.loglog([float(r["cell [um]"]) for r in of], cost, "o-", color=colour, label=metal)
        for r, c in zip(of, cost):
            left.annotate(r["cell [um]"], (abs(float(r["error of depth [%]"])), c), fontsize=7)
    left.set_xlabel("error of depth [%] (points: cell in um)")
    right.set_xlabel("cell [um]")
    for axes in (left, right):
        axes.set_ylabel("core-seconds per mm of track")
        axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(folder / "cost.png", dpi=100)


if __name__ == "__main__":
    main()
