#!/usr/bin/env python3
"""Measured density of AlSi10Mg below 60 J/mm3 against energy density, against the overlap of analytic melt pools, and
against this program's chain. Writes docs/density.md with its plots (Debian's python3 with python3-numpy):

    examples/density/study.py --program build/layerloop -o out/density barrionuevo2025.csv

The CSV is that of Barrionuevo et al., Sci. Data 12 (2025) 375 (Harvard Dataverse 10.7910/DVN/VPBQK8, CC0), or a part of
its rows. What lies in the output folder already is not computed again; rows with the same powder, beam and speed share
their runs. 98 settings, half a minute to three of one core
each.
"""
import argparse
import json
import math
import pathlib
import sys

import measured
import overlap
import page
import roc
from chain import Chain, size
from eagar_tsai import ALSI10MG, pool

LITERATURE_ABSORPTIVITY = 0.52  # of aluminium powder, 0.51 to 0.54: Rubenchik et al., Appl. Opt. 54 (2015) 7230
MODELS = ("energy", "analytic", "plate", "powder")


def pools_of(row, speed, chain, seeds):
    """Width and depth [m] of the row's pool by each model, depths below the top of the layer once solid; None where a
    guard of the physics stopped the run: hotter than the model knows metal to be."""
    track = (row.power, speed, row.spot)
    absorptivity = sum(chain.absorptivity(row.d50, row.layer, s) for s in seeds) / len(seeds)
    told = [chain.on_powder(*track, row.d50, row.layer, s) for s in seeds]
    return {"analytic": pool(ALSI10MG, LITERATURE_ABSORPTIVITY * row.power, row.speed, row.spot)[:2],
            "plate": size(chain.on_plate(*track, absorptivity)), "powder": on_solid(told, row.layer),
            "absorptivity": absorptivity, "on_powder": [t["absorptivity"] for t in told if t],
            "regimes": [t["regime"] if t else "stopped" for t in told]}


def on_solid(told, layer):
    """Mean pool of tracks on powder, depth from the top of the new layer; None where all were stopped."""
    sizes = [size(t) for t in told if t]
    if not sizes:
        return None
    width, depth = (sum(s[k] for s in sizes) / len(sizes) for k in (0, 1))
    return width, depth + layer if width else 0.0


def scores_of(rows, pools):
    """{model: score}, the higher the likelier a low density; to nine digits, so that equal settings tie."""
    scores = {"energy": [-r.energy_density for r in rows],
              "paper": roc.left_out_share([r.low for r in rows], [r.paper for r in rows])}
    for model in MODELS[1:]:
        scores[model] = [q_of(p[model], r) for r, p in zip(rows, pools)]
    return {model: rounded(values) for model, values in scores.items()}


def q_of(size, row):
    """Q of the row; 0 where the run was stopped: what is too hot for the model lacks no fusion."""
    return overlap.number(*size, row.hatch, row.layer) if size else 0.0


def rounded(scores):
    return [float(f"{v:.9g}") for v in scores]


def past_maximum(rows):
    """Numbers of the rows that are slower than the densest row of their series: one paper, power, hatch and layer, four
    speeds or more. What lowers their density is no lack of fusion."""
    series = {}
    for r in rows:
        series.setdefault((r.paper, r.power, r.hatch, r.layer), []).append(r)
    found = set()
    for of in series.values():
        if len({r.speed for r in of}) >= 4:
            densest = max(of, key=lambda r: (r.density, r.speed))
            found |= {r.number for r in of if r.speed < densest.speed}
    return found


def ceiling(rows):
    """Within papers, the most that any score reaches which never calls a part less dense for more power, less speed,
    smaller hatch or thinner layers: pairs that measure the opposite are lost, equal settings tie."""
    lost = pairs = 0.0
    for a in rows:
        for b in rows:
            if a.paper == b.paper and a.low and not b.low:
                pairs += 1
                more = [a.power >= b.power, a.speed <= b.speed, a.hatch <= b.hatch, a.layer <= b.layer, a.spot == b.spot]
                less = [a.power <= b.power, a.speed >= b.speed, a.hatch >= b.hatch, a.layer >= b.layer]
                lost += (0.5 if all(less) else 1) if all(more) else 0
    return 1 - lost / pairs


def without(scores, rows, numbers):
    """A score and rows less some of them."""
    kept = [k for k, r in enumerate(rows) if r.number not in numbers]
    return [scores[k] for k in kept], [rows[k] for k in kept]


def logs(scores):
    """ln Q for a logistic fit; where nothing melts, that of the largest finite Q."""
    finite = [math.log(q) for q in scores if math.isfinite(q)]
    return [math.log(q) if math.isfinite(q) else max(finite) for q in scores]


def slope(scores, outcomes, _):
    return roc.logistic(scores, outcomes)[1]


def judge(scores, rows):
    """Figures of one score with their intervals over papers."""
    low, papers = [r.low for r in rows], [r.paper for r in rows]
    found = {"pooled": roc.auc(scores, low), "within": roc.auc_within(scores, low, papers),
             "pooled_ci": roc.bootstrap(lambda s, y, g: roc.auc(s, y), scores, low, papers),
             "within_ci": roc.bootstrap(roc.auc_within, scores, low, papers),
             "rank": roc.rank_correlation(scores, [-r.density for r in rows])}
    found["papers"] = {paper: (roc.auc(*part), roc.wins(*part)[1]) for paper, part in roc.by_group(scores, low, papers).items()}
    return found


def gain(scores, energy, rows):
    """How much more often than energy density a score wins a pair of one paper, with its interval over papers."""
    def difference(both, outcomes, groups):
        return roc.auc_within([a for a, _ in both], outcomes, groups) - roc.auc_within([b for _, b in both], outcomes, groups)

    both, low, papers = list(zip(scores, energy)), [r.low for r in rows], [r.paper for r in rows]
    return difference(both, low, papers), roc.bootstrap(difference, both, low, papers)


def calibration(scores, rows):
    """Logistic regression of a low density on ln Q: slope, the Q at which one half is expected, and its interval."""
    low, papers, x = [r.low for r in rows], [r.paper for r in rows], logs(scores)
    intercept, b = roc.logistic(x, low)
    return {"slope": b, "slope_ci": roc.bootstrap(slope, x, low, papers), "half": math.exp(-intercept / b)}


def parts(scores, rows):
    """Within papers, once more for pairs that share a further property."""
    low = [r.low for r in rows]
    return {"method": roc.auc_within(scores, low, [(r.paper, r.method) for r in rows]),
            "layer": roc.auc_within(scores, low, [(r.paper, r.layer) for r in rows]),
            "hatch": roc.auc_within(scores, low, [(r.paper, r.layer, r.hatch) for r in rows])}


def analytic_over(rows, absorptivity):
    sizes = [pool(ALSI10MG, absorptivity * r.power, r.speed, r.spot)[:2] for r in rows]
    return rounded([overlap.number(*p, r.hatch, r.layer) for p, r in zip(sizes, rows)])


def mixed_over(rows, speeds, chain, mixing):
    """Figures within papers that have pairs, with a melt that flows, over all their rows; with the number of stopped rows."""
    pairs = {paper for paper, (s, y) in roc.by_group(rows, [r.low for r in rows], [r.paper for r in rows]).items() if 0 < sum(y) < len(y)}
    rows = [r for r in rows if r.paper in pairs]
    told = [chain.on_powder(r.power, speeds[r.number], r.spot, r.d50, r.layer, 1, mixing) for r in rows]
    sizes = [on_solid([t], r.layer) for t, r in zip(told, rows)]
    found = judge(rounded([q_of(s, r) for s, r in zip(sizes, rows)]), rows)
    return {"mixing": mixing, "judged": found, "stopped": sizes.count(None)}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("csv", type=pathlib.Path)
    options.add_argument("--program", type=pathlib.Path, required=True)
    options.add_argument("-o", "--out", type=pathlib.Path, required=True)
    options.add_argument("--seeds", type=int, default=1, help="beds for every track on powder")
    options.add_argument("--mixing", type=float, help="tracks on powder once more with a melt that conducts so many times as well")
    options.add_argument("--docs", type=pathlib.Path, default=pathlib.Path(__file__).parents[2] / "docs")
    told = options.parse_args()
    rows, lacking = measured.read(told.csv)
    chain, seeds = Chain(told.program, told.out), range(1, told.seeds + 1)
    pools, speeds = [], measured.speeds_to_run(rows)
    for k, row in enumerate(rows):
        pools.append(pools_of(row, speeds[row.number], chain, seeds))
        print(f"\r{k + 1} of {len(rows)} rows", end="", file=sys.stderr, flush=True)
    answered = [k for k, p in enumerate(pools) if p["plate"] and p["powder"]]
    every, rows_of_all = scores_of(rows, pools), rows
    as_none = [q if p["powder"] else math.inf for q, p in zip(every["powder"], pools)]
    rows, pools = [rows[k] for k in answered], [pools[k] for k in answered]
    scores, past = scores_of(rows, pools), past_maximum(rows)
    results = {"every": {"rows": rows_of_all, "judged": {m: judge(s, rows_of_all) for m, s in every.items()},
                         "gain": {m: gain(every[m], every["energy"], rows_of_all) for m in MODELS[1:]},
                         "as_none": [judge(as_none, rows_of_all)[k] for k in ("within", "pooled")]},
               "rows": rows, "lacking": lacking, "pools": pools, "scores": scores, "past": past, "ceiling": ceiling(rows),
               "judged": {model: judge(s, rows) for model, s in scores.items()},
               "gain": {m: gain(scores[m], scores["energy"], rows) for m in MODELS[1:]},
               "calibration": {model: calibration(scores[model], rows) for model in MODELS[1:]},
               "rising": {m: judge(*without(scores[m], rows, past)) for m in MODELS},
               "parts": {model: parts(scores[model], rows) for model in MODELS},
               "analytic_over": {a: judge(analytic_over(rows, a), rows) for a in (0.3, 0.4, 0.6, 0.7)}}
    results["mixed"] = mixed_over(rows_of_all, speeds, chain, told.mixing) if told.mixing else None
    page.write(results, told.docs, told.out)
    print(json.dumps({m: {k: j[k] for k in ("pooled", "within", "within_ci")} for m, j in results["judged"].items()}))


if __name__ == "__main__":
    main()
