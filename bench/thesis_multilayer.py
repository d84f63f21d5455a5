#!/usr/bin/env python3
"""The thesis' multi-layer runs, and whether its trends come out.

    thesis_multilayer.py --program build/layerloop -o OUT [layers] [table6] [zone] [--seeds 3] [--jobs 1] [--set key=value ...]

  layers  21 layers of 50 um at 100 mm/s, R = 15 um (thesis Figs 28-32)
  table6  its ten combinations of thickness, speed and dose, six layers each (Table 6, Figs 33-42)
  zone    six layers of which x = 6000 to 8500 um (--zone) is frozen and meshed, and the same without (Figs 44-47)

Goes on where it was stopped: what is done in OUT is kept. Writes OUT/multilayer.csv (a row a layer) and OUT/multilayer.md.
Interior: bins between 20 % and 80 % of the plate. Steady from: the first layer from which on the interior's real effective
thickness stays within 10 % of the nominal one. At full length 5 min of one core a layer; with --set machine.deposition_length=2.4mm
--set powder.particles=1500 half a minute. Needs Python's standard library only."""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import statistics
import subprocess

CASE = pathlib.Path(__file__).resolve().parent / "thesis_multilayer.toml"
TABLE6 = [(69, 87, 132), (54, 68, 109), (44, 112, 137), (37, 60, 111), (38, 99, 104),
          (30, 51, 149), (48, 78, 143), (54, 96, 118), (65, 123, 128), (60, 40, 122)]  # um, mm/s, %
T975 = [math.nan, 12.71, 4.303, 3.182, 2.776, 2.571, 2.447]  # Student, by degrees of freedom


def cases(names, zone):
    if "layers" in names:
        yield "layers", {}
    if "table6" in names:
        for n, (thickness, speed, dose) in enumerate(TABLE6, 1):
            yield f"table6_{n:02}", {"machine.layer_thickness": f"{thickness}um", "machine.recoating_speed": f"{speed}mm/s",
                                     "machine.dose_factor": dose / 100, "run.layers": 6}
    if "zone" in names:
        yield "zone", {"machine.frozen_zone": f'["{zone[0]:g} um", "{zone[1]:g} um"]',
                       "machine.blade_collision": "report", "run.layers": 6}
        yield "zone_free", {"run.layers": 6}


def run(program, folder, settings, seed, extra):
    words = [w for key, value in settings.items() for w in ("--set", f"{key}={value}")] + [w for s in extra for w in ("--set", s)]
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(folder.parent / (folder.name + ".log"), "w") as log:
        subprocess.run([program, "spread", CASE, "-o", folder, "--resume", "--seed", str(seed), *words], check=True, stdout=log, stderr=log)
    return json.loads((folder / "summary.json").read_text())["layers"]


def mean(values):
    values = [v for v in values if v is not None]
    return statistics.fmean(values) if values else math.nan


def interval(values):
    values = [v for v in values if not math.isnan(v)]
    if len(values) < 2:
        return f"{values[0]:.3g}" if values else "-"
    half = T975[len(values) - 1] * statistics.stdev(values) / math.sqrt(len(values))
    return f"{statistics.fmean(values):.3g} +- {half:.2g}"


def measured(name, seed, layer, nominal, zone):
    bins = layer["bins"]
    low, high = bins[0]["x"], bins[-1]["x"]
    part = lambda a, b: [x for x in bins if low + a * (high - low) <= x["x"] <= low + b * (high - low)]
    thickness = lambda of: 1e6 * mean(x["real_effective_thickness"] for x in of)
    rim = 0.1 * (zone[1] - zone[0])
    over_zone = [x for x in bins if zone[0] + rim < 1e6 * x["x"] < zone[1] - rim]
    return {"run": name, "seed": seed, "layer": layer["layer"], "nominal [um]": nominal,
            "RELT interior [um]": thickness(part(0.2, 0.8)), "RELT first tenth [um]": thickness(part(0, 0.1)),
            "RELT last tenth [um]": thickness(part(0.9, 1)),
            "void layer [um]": 1e6 * mean(x["void_layer"] for x in part(0.2, 0.8)),
            "fraction nominal": layer["volume_fraction_nominal"],
            "fraction real interior": mean(x["relative_density"] for x in part(0.2, 0.8)),
            "fraction real zone": mean(x["relative_density"] for x in over_zone), "coverage": layer["surface_coverage"],
            "heap angle [deg]": layer["heap_angle_accumulation"] if layer["heap_angle_accumulation"] is not None else math.nan}


def steady_from(rows):
    first = None
    for row in rows:
        near = abs(row["RELT interior [um]"] / row["nominal [um]"] - 1) < 0.1
        first = (first or row["layer"]) if near else None
    return first or math.nan


def table(rows, columns):
    return "\n".join(["| " + " | ".join(columns) + " |", "| " + " | ".join("---" for _ in columns) + " |",
                      *("| " + " | ".join(str(c) for c in row) + " |" for row in rows)])


def report(rows):
    names = list(dict.fromkeys(r["run"] for r in rows))
    of = lambda name, layer, key: [r[key] for r in rows if r["run"] == name and r["layer"] == layer]
    parts = []
    for name in (n for n in names if not n.startswith("table6")):
        layers = sorted({r["layer"] for r in rows if r["run"] == name})
        keys = ["RELT interior [um]", "RELT first tenth [um]", "RELT last tenth [um]", "void layer [um]", "fraction real interior",
                "fraction real zone", "coverage"]
        parts.append(f"## {name}\n\n" + table([[n, *(interval(of(name, n, k)) for k in keys)] for n in layers], ["layer", *keys]))
    combos = [n for n in names if n.startswith("table6")]
    if combos:
        lines = []
        for name in combos:
            thickness, speed, dose = TABLE6[int(name[-2:]) - 1]
            seeds = sorted({r["seed"] for r in rows if r["run"] == name})
            steady = [steady_from([r for r in rows if r["run"] == name and r["seed"] == s]) for s in seeds]
            lines.append([name[-2:], thickness, speed, dose, *(interval(of(name, n, "RELT interior [um]")) for n in range(1, 7)),
                          " ".join("-" if math.isnan(s) else str(s) for s in steady)])
        parts.append("## table6: real effective thickness of the interior [um]\n\n" +
                     table(lines, ["run", "nominal [um]", "speed [mm/s]", "dose [%]", *map(str, range(1, 7)), "steady from (by seed)"]))
    return "\n\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", default=["layers", "table6", "zone"])
    parser.add_argument("--program", default="build/layerloop")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--zone", nargs=2, type=float, default=[6000, 8500], metavar="UM", help="x from, to (default 6000 8500)")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    o = parser.parse_args()
    todo = [(name, settings, seed) for seed in range(1, o.seeds + 1) for name, settings in cases(o.what, o.zone)]
    with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        done = list(pool.map(lambda t: run(o.program, o.output / f"{t[0]}_seed{t[2]}", t[1], t[2], o.set), todo))
    rows = []
    for (name, settings, seed), layers in zip(todo, done):
        nominal = float(str(settings.get("machine.layer_thickness", "50um"))[:-2])
        rows += [measured(name, seed, layer, nominal, o.zone) for layer in layers]
    with open(o.output / "multilayer.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    (o.output / "multilayer.md").write_text(report(rows))
    print(report(rows))


if __name__ == "__main__":
    main()
