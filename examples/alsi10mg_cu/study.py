#!/usr/bin/env python3
"""Trends of the AlSi10Mg + 4 % Cu case study, held against what the thesis says. First the sweeps, then this:

    layerloop sweep examples/alsi10mg_cu/spread.toml -o out/spread
    layerloop sweep examples/alsi10mg_cu/table8.toml -o out/table8
    for case in 1 4 13 16; do     # twelve layers at the corners of the table
      layerloop sweep examples/alsi10mg_cu/table8.toml -o out/tall --set run.layers=12 --set sweep.replicates=1 --index $case
    done
    layerloop sweep examples/alsi10mg_cu/table8.toml -o out/tall --set run.layers=12 --set sweep.replicates=1 --report
    examples/alsi10mg_cu/study.py --program build/layerloop --spread out/spread --table8 out/table8 --tall out/tall -o out/light

Lights the beds of the first, and writes docs/alsi10mg-cu.md with its CSV files and plots. Cases that failed are left out,
beds with their seed, and counted.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

import light
import parts
import spreading

HERE = pathlib.Path(__file__).parent
sys.path.append(str(HERE.parent / "absorptivity_study"))


def cases_of(sweep):
    """Cases of a sweep that are done, each with its folder; and how many there should be."""
    told = json.loads((sweep / "summary.json").read_text())["cases"]
    for case in told:
        case["folder"] = sweep / case["folder"]
    return [c for c in told if c["state"] == "done"], len(told)


def of_whole_seeds(cases):
    """Cases of the seeds that lack no setting: settings are compared within a seed."""
    number = [case["seed"] for case in cases].count
    return [case for case in cases if number(case["seed"]) == max(number(c["seed"]) for c in cases)]


def write_rows(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("program", "spread", "table8", "tall", "output"):
        parser.add_argument(f"--{name}", *(["-o"] if name == "output" else []), type=pathlib.Path, required=True)
    parser.add_argument("--docs", type=pathlib.Path, default=HERE.parent.parent / "docs")
    given = parser.parse_args()
    figures = given.docs / "alsi10mg-cu"
    figures.mkdir(exist_ok=True)

    beds, beds_wanted = cases_of(given.spread)
    beds = of_whole_seeds(beds)
    builds, builds_wanted = cases_of(given.table8)
    tall, _ = cases_of(given.tall)
    spread_rows, bins = spreading.rows(beds), spreading.bin_rows(beds)
    light_rows = light.rows(beds, given.program, HERE / "absorb.toml", given.output)
    part_rows, layers, profiles = parts.rows(builds), parts.layer_rows(builds), parts.profile_rows(builds)
    for name, rows in (("spread", spread_rows), ("bins", bins), ("light", light_rows), ("table8", part_rows),
                       ("layers", layers), ("profile", profiles)):
        write_rows(figures / f"{name}.csv", rows)
    spreading.plots(spread_rows, bins, figures)
    parts.plots(part_rows, profiles, figures)

    tables = {"beds": len(beds), "beds_wanted": beds_wanted, "builds": len(builds), "builds_wanted": builds_wanted,
              **spreading.tables(spread_rows, bins), **light.tables(light_rows), **parts.tables(part_rows, layers),
              "tall": parts.tall_table(tall)}
    (given.docs / "alsi10mg-cu.md").write_text((HERE / "page.md").read_text().format(**tables))


if __name__ == "__main__":
    main()
