"""Settled-bed throughput of layerloop beside LIGGGHTS and LAMMPS. Start it as bench/dem_peers.sh.

Every round runs all codes on all beds, one process at a time; a figure is the median over the timed blocks of all
rounds, with the lowest and highest in brackets. The bars are ratios of medians. Memory is the largest resident set of a
run on one rank: (largest bed - smallest bed) / (difference in grains).
"""
import argparse
import json
import os
import pathlib
import platform
import re
import statistics
import subprocess
import sys
import tempfile

import packing
import peer_decks
import physical_limit

HERE = pathlib.Path(__file__).resolve().parent
TILE = HERE.parent.parent / "shared/reference/packings/packing_tile.csv"
STEPS = {10_000: 400, 50_000: 100, 320_000: 25}  # of a timed block
BARS = {("liggghts", 10_000): 4, ("liggghts", 50_000): 5, ("liggghts", 320_000): 5,
        ("lammps", 10_000): 2, ("lammps", 50_000): 2.5, ("lammps", 320_000): 2.5}
contacts_a_grain = {}  # of the settled beds, as layerloop counts them
CODES = ("layerloop", "liggghts", "lammps")
MODEL = {"layerloop": "Hertz-Mindlin, history, SJKR2, CDT", "liggghts": "Hertz-Mindlin, history, SJKR2, CDT",
         "lammps": "Hertz-Mindlin, history"}


def options():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("tile", nargs="?", type=pathlib.Path, default=TILE, help="periodic tile of a settled bed (bench/packing.py)")
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/layerloop")
    p.add_argument("--sizes", default="10000,50000,320000", help="grains of each bed")
    p.add_argument("--rounds", type=int, default=3)
    p.add_argument("--ranks", default="2,4", help="also on so many ranks, at --ranks-size grains; empty: not")
    p.add_argument("--ranks-size", type=int, default=50_000)
    p.add_argument("--codes", default=",".join(CODES))
    p.add_argument("--limits", type=pathlib.Path, default=HERE.parent / "build/bench/machine_limits",
                   help="program that measures the machine's peaks (LAYERLOOP_BENCH=ON); without it no physical limit is told")
    p.add_argument("--quick", action="store_true", help="one round, no ranks: a minute")
    p.add_argument("-o", "--output", type=pathlib.Path, help="folder for dem_peers.json and dem_peers.md")
    chosen = p.parse_args()
    if chosen.quick:
        chosen.rounds, chosen.ranks = 1, ""
    if not chosen.tile.exists():
        p.error(f"no tile at {chosen.tile}: give its path")
    return chosen


def run(command, folder):
    """Output and largest resident set [bytes] of a process on its own."""
    env = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen([str(word) for word in command], cwd=folder, env=env, stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        out.seek(0)
        text = out.read()
    if status != 0:
        sys.exit(f"{command[0]} failed:\n{text[-2000:]}")
    return text, usage.ru_maxrss * 1024


def measure(code, grains, ranks, blocks, chosen, folder):
    """Particle-steps per second of every timed block, and the resident set."""
    path = packing.write_packing(chosen.tile, grains, folder)
    steps = STEPS.get(grains, max(10, 4_000_000 // grains))
    start = ["mpirun", "-n", ranks, "--oversubscribe", "--bind-to", "none"] if ranks > 1 else []
    if code == "layerloop":
        rates, memory = [], 0
        for _ in range(blocks):
            text, rss = run([*start, chosen.program.resolve(), "bench", "dem", path.with_suffix(".csv"), "--steps", 3 * steps,
                             "--threads", 1], folder)
            result = json.loads(text[text.index("{"):text.rindex("}") + 1])
            rates.append(result["particle_steps_per_second"])
            contacts_a_grain[grains] = result["contacts"] / result["particles"]
            memory = max(memory, rss)
        return rates, memory
    deck = folder / f"{code}_{grains}.in"
    deck.write_text(getattr(peer_decks, code)(path.with_suffix(".data"), steps, 3 * blocks, 100 if grains < 100_000 else 40))
    binary = {"liggghts": "liggghts", "lammps": "lmp"}[code]
    text, memory = run([*start, binary, "-in", deck, "-log", "none"], folder)
    times = re.findall(r"Loop time of ([\d.e+-]+) on", text.split("TIMED")[-1])
    return [grains * steps / float(t) for t in times], memory


def shown(rates):
    mega = sorted(rate / 1e6 for rate in rates)
    return f"{statistics.median(mega):.2f} [{mega[0]:.2f}-{mega[-1]:.2f}]"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def report(rates, memory, sizes, codes, rank_counts, chosen):
    median = {key: statistics.median(values) for key, values in rates.items()}
    text = f"Measured on {cpu_name()}, {os.cpu_count()} cores, {chosen.rounds} rounds; million particle-steps per second.\n\n"
    text += table(["code", "model", *[f"{n:,} grains".replace(",", " ") for n in sizes], "bytes per grain"],
                  [[c, MODEL[c], *[shown(rates[c, n, 1]) for n in sizes], bytes_per_grain(memory, c, sizes)] for c in codes])
    text += "\n"
    if "layerloop" in codes:
        rows = []
        for (peer, n), bar in BARS.items():
            if peer not in codes or n not in sizes:
                continue
            ratio = median["layerloop", n, 1] / median[peer, n, 1]
            rows.append([peer, n, f"{ratio:.2f}", f"{bar:g}", "yes" if ratio >= bar else "no"])
        text += table(["layerloop over", "grains", "ratio", "bar", "reached"], rows) + "\n"
    if rank_counts:
        n = chosen.ranks_size
        text += table([f"ranks, {n} grains", *map(str, [1, *rank_counts])],
                      [[c, *[shown(rates[c, n, r]) for r in [1, *rank_counts]]] for c in codes]) + "\n"
    if "layerloop" in codes and chosen.limits.exists():
        limits = json.loads(run([chosen.limits.resolve()], HERE)[0])[0]
        measured = {n: median["layerloop", n, 1] for n in sizes}
        text += physical_limit.text(contacts_a_grain[max(sizes)], limits, measured)
    return text


def bytes_per_grain(memory, code, sizes):
    if len(sizes) < 2:
        return "-"
    return round((memory[code, max(sizes)] - memory[code, min(sizes)]) / (max(sizes) - min(sizes)))


def cpu_name():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def main():
    chosen = options()
    sizes = [int(n) for n in chosen.sizes.split(",")]
    codes = chosen.codes.split(",")
    rank_counts = [int(r) for r in chosen.ranks.split(",") if r]
    rates, memory = {}, {}
    with tempfile.TemporaryDirectory(prefix="dem-peers-") as name:
        folder = pathlib.Path(name)
        jobs = [(n, 1) for n in sizes] + [(chosen.ranks_size, r) for r in rank_counts]
        if rank_counts and chosen.ranks_size not in sizes:
            jobs.append((chosen.ranks_size, 1))
        for turn in range(chosen.rounds):
            for grains, ranks in jobs:
                for code in codes:
                    found, rss = measure(code, grains, ranks, 1, chosen, folder)
                    rates.setdefault((code, grains, ranks), []).extend(found)
                    if ranks == 1:
                        memory[code, grains] = max(rss, memory.get((code, grains), 0))
                    print(f"round {turn + 1}: {code} {grains} grains {ranks} ranks: {shown(found)}", file=sys.stderr, flush=True)
    text = report(rates, memory, sizes, codes, rank_counts, chosen)
    print(text)
    if chosen.output:
        chosen.output.mkdir(parents=True, exist_ok=True)
        (chosen.output / "dem_peers.md").write_text(text)
        keyed = [{"code": c, "grains": n, "ranks": r, "particle_steps_per_second": v} for (c, n, r), v in rates.items()]
        (chosen.output / "dem_peers.json").write_text(json.dumps(keyed, indent=1))


if __name__ == "__main__":
    main()
