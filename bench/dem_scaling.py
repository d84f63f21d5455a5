"""Strong scaling of the settled bed: ranks x threads, the phases of a step, and where the fitted model says it ends.

Every rank and every thread is a worker. Workers beyond the cores of the machine are measured for completeness and left
out of the fit. On a machine with few cores the model's message terms rest on few points; the table says how many of its
terms the points determine. Start it again on a larger machine: nothing in it is tied to this one.
"""
import argparse
import json
import os
import pathlib
import statistics
import sys
import tempfile

import packing
import scaling_model
from dem_peers import HERE, TILE, cpu_name, run, shown, table


def options():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("tile", nargs="?", type=pathlib.Path, default=TILE, help="periodic tile of a settled bed (bench/packing.py)")
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/layerloop")
    p.add_argument("--sizes", default="320000,80000", help="grains; the largest is shown, all are fitted")
    p.add_argument("--workers", default="1x1,2x1,4x1,1x2,2x2", help="ranks x threads")
    p.add_argument("--rounds", type=int, default=3)
    p.add_argument("--steps", type=int, default=60, help="at the largest size; more at smaller ones")
    p.add_argument("-o", "--output", type=pathlib.Path, help="folder for dem_scaling.json and dem_scaling.md")
    chosen = p.parse_args()
    if not chosen.tile.exists():
        p.error(f"no tile at {chosen.tile}: give its path")
    return chosen


def measure(chosen, grains, ranks, threads, folder):
    path = packing.write_packing(chosen.tile, grains, folder)
    steps = max(chosen.steps, chosen.steps * 320_000 // grains // 2)
    start = ["mpirun", "-n", ranks, "--oversubscribe", "--bind-to", "none"] if ranks > 1 else []
    text, _ = run([*start, chosen.program.resolve(), "bench", "dem", path.with_suffix(".csv"), "--steps", steps, "--threads",
                   threads], folder)
    return json.loads(text[text.index("{"):text.rindex("}") + 1])


def face_grains(tile, grains):
    """Grains in a cross-section one cell of 42 um thick: what a slice shows its neighbour."""
    _, _, x, _ = packing.settled_bed(tile, grains)
    return grains * 42e-6 / x


def report(results, sizes, workers, chosen, cores):
    largest = max(sizes)
    text = f"Measured on {cpu_name()}, {cores} cores, {chosen.rounds} rounds, {largest} grains.\n\n"
    alone = statistics.median(r["particle_steps_per_second"] for r in results[largest, 1, 1])
    rows = []
    for ranks, threads in workers:
        rates = [r["particle_steps_per_second"] for r in results[largest, ranks, threads]]
        speed_up = statistics.median(rates) / alone
        share = speed_up / min(ranks * threads, cores)
        note = "" if ranks * threads <= cores else f"{ranks * threads} workers on {cores} cores"
        rows.append([ranks, threads, shown(rates), f"{speed_up:.2f}", f"{100 * share:.0f} %", note])
    text += table(["ranks", "threads", "million particle-steps/s", "speed-up", "of the cores", ""], rows) + "\n"
    text += phase_table(results, largest, workers) + fit_text(results, sizes, workers, chosen, cores)
    return text


def phase_table(results, grains, workers):
    """Share of every phase in the time of a step, where the program tells it."""
    rows, names = [], []
    for ranks, threads in workers:
        phases = results[grains, ranks, threads][0].get("phases", {})
        names = names or list(phases)
        total = sum(phases.values())
        if total > 0:
            rows.append([ranks, threads, *[f"{100 * phases[name] / total:.1f} %" for name in names]])
    return table(["ranks", "threads", *names], rows) + "\n" if rows else ""


def fit_text(results, sizes, workers, chosen, cores):
    points = []
    for grains in sizes:
        face = face_grains(chosen.tile, grains)
        for ranks, threads in workers:
            if ranks * threads > cores or threads > 1:
                continue
            for r in results[grains, ranks, threads]:
                points.append((grains, ranks, face, grains / r["particle_steps_per_second"]))
    coefficients, known, misfit = scaling_model.fit(points)
    grains, face = max(sizes), face_grains(chosen.tile, max(sizes))
    text = "Model of the time of a step over ranks: " + scaling_model.__doc__.splitlines()[0] + "\n\n"
    text += table(["term", "seconds"], [[n, f"{c:.3g}"] for n, c in zip(scaling_model.NAMES, coefficients)])
    text += f"\nRelative misfit {100 * misfit:.1f} %; the points determine {known} of the 4 terms.\n\n"
    text += table(["ranks", "efficiency by the model", "grains a rank"],
                  [[p, f"{100 * scaling_model.efficiency(coefficients, grains, p, face):.0f} %", grains // p]
                   for p in (1, 2, 4, 8, 16, 32, 64, 128, 256, 512)])
    half = scaling_model.largest_efficient(coefficients, grains, face)
    return text + f"\nHalf of every rank's time is lost beyond {half} ranks ({grains // half} grains a rank).\n"


def main():
    chosen = options()
    cores = os.cpu_count()
    sizes = [int(n) for n in chosen.sizes.split(",")]
    workers = [tuple(map(int, w.split("x"))) for w in chosen.workers.split(",")]
    results = {}
    with tempfile.TemporaryDirectory(prefix="dem-scaling-") as name:
        folder = pathlib.Path(name)
        for turn in range(chosen.rounds):
            for grains in sizes:
                for ranks, threads in workers:
                    found = measure(chosen, grains, ranks, threads, folder)
                    results.setdefault((grains, ranks, threads), []).append(found)
                    print(f"round {turn + 1}: {grains} grains {ranks} x {threads}: "
                          f"{found['particle_steps_per_second'] / 1e6:.2f}", file=sys.stderr, flush=True)
    text = report(results, sizes, workers, chosen, cores)
    print(text)
    if chosen.output:
        chosen.output.mkdir(parents=True, exist_ok=True)
        (chosen.output / "dem_scaling.md").write_text(text)
        keyed = [{"grains": n, "ranks": r, "threads": t, "results": v} for (n, r, t), v in results.items()]
        (chosen.output / "dem_scaling.json").write_text(json.dumps(keyed, indent=1))


if __name__ == "__main__":
    main()
