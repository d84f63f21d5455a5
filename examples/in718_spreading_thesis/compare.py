#!/usr/bin/env python3
"""Runs `layerloop spread` for experiments of the thesis' Table 2 and holds the layers against its measurements.

    compare.py --program build/layerloop -o OUT [e8 e9 ...] [--seeds 3]

Without names: every experiment with the good powder (e8 to e14). The poor powder (e1 to e7, irregular aluminium grains of
unknown sizes) is not run: the case has no powder for it. Leaves OUT/comparison.csv and OUT/comparison.md; experiments
whose summary is already there are not run again. Needs Python's standard library only."""
import argparse
import csv
import json
import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
SIZES = {"bed.d10": "d10", "bed.d50": "d50", "bed.d90": "d90"}


def rows(name):
    with open(HERE / name, newline="") as file:
        return list(csv.DictReader(file))


def settings(condition):
    """--set options of a row of conditions.csv: every column that names a case key."""
    for column, value in condition.items():
        key = re.fullmatch(r"(\w+\.\w+) \[(.+)\]", column)
        if key:
            yield from ("--set", f"{key[1]}={value} {key[2]}")


def run(condition, options):
    folder = options.output / condition["condition_id"]
    if not (folder / "summary.json").exists():
        subprocess.run([options.program, "spread", HERE / "case.toml", "-o", folder, "--set",
                        f"run.replicates={options.seeds}", *settings(condition)], check=True)
    return json.loads((folder / "summary.json").read_text())


def modelled(summary, observation):
    """Value and half width of its 95 % interval (None with one seed or nothing to measure), in the unit of the data."""
    layer = summary["layers"][-1]
    if observation["quantity"] in SIZES:
        third = {"front": 0, "rear": -1}[observation["rep_id"]]
        source, name, scale = layer["bins"][third], SIZES[observation["quantity"]], 1e6
    else:
        source, name, scale = layer, "volume_fraction_real", 1
    value, width = source.get(name), source.get(name + "_u_bed")
    return (None if value is None else scale * value), (None if width is None else scale * width)


def text(value, digits=3):
    return "" if value is None else f"{value:.{digits}g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiments", nargs="*", help="condition ids; default: all with the good powder")
    parser.add_argument("--program", default="build/layerloop")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()

    conditions = {c["condition_id"]: c for c in rows("conditions.csv")}
    wanted = options.experiments or [c for c, row in conditions.items() if row["lot"] == "good"]
    for name in wanted:
        if name not in conditions or conditions[name]["lot"] != "good":
            parser.error(f"{name} is not an experiment with the good powder (e8 to e14 are)")
    head = ["experiment", "speed [mm/s]", "thickness [um]", "quantity", "where", "measured", "model", "u_bed", "model - measured"]
    table = []
    for name in wanted:
        condition, summary = conditions[name], run(conditions[name], options)
        for observation in rows("measurements.csv"):
            if observation["condition_id"] != name:
                continue
            measured = float(observation["value"])
            value, width = modelled(summary, observation)
            table.append([name, condition["machine.recoating_speed [mm/s]"], condition["machine.layer_thickness [um]"],
                          observation["quantity"], observation["rep_id"], text(measured), text(value), text(width, 2),
                          "" if value is None else f"{value - measured:+.2g}"])
    with open(options.output / "comparison.csv", "w", newline="") as file:
        csv.writer(file).writerows([head, *table])
    lines = ["| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *table]]
    (options.output / "comparison.md").write_text("\n".join(lines) + "\n")
    print(options.output / "comparison.md")


if __name__ == "__main__":
    main()
