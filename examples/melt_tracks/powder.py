"""316L on 30 and 60 um of powder, spot 80 um (Hofmann et al. 2025): tracks over beds of five seeds each."""
import collections

import numpy as np
from scipy.stats import chi2, t as student

from keyhole import FACTOR, INDEX
from measured import conduction_range, hofmann
from plate import CASE, case, mixing, size

SEEDS = range(1, 6)
CELL = 7e-6
PLATE_BEGINS = 760e-6  # accumulation zone and gap of bed.toml [m]
LIGHT = {"optics.refractive_index": INDEX, "optics.position_spacing": 2 * CELL, "optics.rays": 4000}
MODELS = {f"melt mixed x {FACTOR}": mixing(FACTOR)}


def settings(track, more):
    file, chosen = case(track, 0.45, CELL, {**more, **LIGHT})
    del chosen["laser.absorptivity"]
    chosen.update({"scan.track_length": 420e-6, "heat.size": [0.63e-3, 0.28e-3, 0.16e-3]})
    return file, chosen


def sample():
    """Settings of the conduction range by their inputs, balling or not: {(powder, power, speed): tracks}."""
    found = collections.defaultdict(list)
    for t in hofmann():
        if t.powder > 0 and conduction_range(t):
            found[t.powder, t.power, t.speed].append(t)
    return found


def beds(melt):
    """{thickness: files of the beds}, spread as bed.toml says; what lies on the plate, without the feed."""
    found = {}
    for thickness in (30e-6, 60e-6):
        folders = melt.spread([("bed.toml", {"machine.layer_thickness": thickness}, ["--seed", str(s), "--export", "csv"])
                               for s in SEEDS])
        found[thickness] = [on_plate(folder / "bed_0001.csv") for folder in folders]
    return found


def on_plate(bed):
    lines = bed.read_text().splitlines()
    kept = [line for line in lines[2:] if float(line.split(",")[0]) > PLATE_BEGINS]
    file = bed.with_name("on_plate.csv")
    file.write_text("\n".join([*lines[:2], *kept]) + "\n")
    return file


def study(melt):
    lying, tracks = beds(melt), sample()
    return {name: judge(melt, lying, tracks, more) for name, more in MODELS.items()}


def judge(melt, lying, tracks, more):
    runs = [(key, seed) for key in sorted(tracks) for seed in range(len(SEEDS))]
    summaries = dict(zip(runs, melt([(*settings(tracks[key][0], more), ("--bed", str(lying[key[0]][seed])))
                                     for key, seed in runs])))
    found = []
    for key in sorted(tracks):
        of_beds = [summaries[key, seed] for seed in range(len(SEEDS))]
        found.append({"powder": key[0], "power": key[1], "speed": key[2], "sizes": [size(s)[:2] for s in of_beds],
                      "regimes": [s["regime"] for s in of_beds if s], "absorptivity": [s["absorptivity"] for s in of_beds if s],
                      "measured": [(t.width, t.depth, t.balling, t.batch) for t in tracks[key]]})
    return {"tracks": found, "scatter": {k: scatter(found, n) for n, k in enumerate(("width", "depth"))}}


def interval(values):
    """Mean and half the 95 % interval for one more track on one more bed."""
    n = len(values)
    return float(np.mean(values)), float(student.ppf(0.975, n - 1) * np.std(values, ddof=1) * np.sqrt(1 + 1 / n))


def scatter(found, k):
    """Relative standard deviation of a track from bed to bed, pooled, with its 95 % chi-square interval."""
    squares, left = 0.0, 0
    for row in found:
        logs = np.log([s[k] for s in row["sizes"] if s[k] == s[k] and s[k] > 0])
        if len(logs) > 1:
            squares, left = squares + np.sum((logs - logs.mean())**2), left + len(logs) - 1
    return [float(np.sqrt(squares / left))] + [float(np.sqrt(squares / chi2.ppf(p, left))) for p in (0.975, 0.025)] + [left]
