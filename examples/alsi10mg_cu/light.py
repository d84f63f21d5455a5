"""Part 2: absorptivity of the beds, under even light."""
import csv
import json
import subprocess

from intervals import by_seed, slope, table, told
from spreading import SPEEDS, THICKNESSES, pick, setting

INDICES = {"clean": None, "measured flat face": "5.291,10.314"}
BEGIN, LENGTH, WIDTH, DENSITY = 350, 800, 150, 2670  # deposition zone of spread.toml [um], powder [kg/m3]


def absorb(program, case, bed, out, arguments=()):
    """Runs the verb once; its folder."""
    if not (out / "summary.json").exists():
        subprocess.run([program, "absorb", case, "--bed", bed, *arguments, "-o", out, "--quiet", "--threads", "1"],
                       check=True, stderr=subprocess.DEVNULL)
    return out


def cut_out(program, case, bed, thickness, out):
    """The grains of the deposition zone alone, as a bed that repeats itself along x too."""
    grains = absorb(program, case, bed, out / "machine", ["--target-se", "0.01"]) / "grains.csv"
    with open(grains) as file, open(out / "bed.csv", "w") as cut:
        cut.write(f"# periodic_x={LENGTH}e-6 periodic_y={WIDTH}e-6 floor_z={-thickness}e-6 units=m density={DENSITY}\n"
                  "# x,y,z,radius,material\n")
        for x, y, z, radius, material in (list(r.values())[:5] for r in csv.DictReader(file)):
            if BEGIN <= float(x) < BEGIN + LENGTH and float(z) < 200:
                cut.write(f"{float(x) - BEGIN}e-6,{y}e-6,{z}e-6,{radius}e-6,{material}\n")
    return out / "bed.csv"


def rows(cases, program, case, out):
    found = []
    for bed in cases:
        thickness, speed = setting(bed)
        folder = out / bed["folder"].name
        folder.mkdir(parents=True, exist_ok=True)
        file = cut_out(program, case, bed["folder"] / "bed_0001.h5", thickness, folder)
        for name, index in INDICES.items():
            told_by = absorb(program, case, file, folder / name.split()[0], ["--refractive-index", index] if index else [])
            s = json.loads((told_by / "summary.json").read_text())
            found.append({"thickness [um]": thickness, "speed [mm/s]": speed, "seed": bed["seed"], "index": name,
                          "absorptivity": s["absorptivity"], "standard_error": s["absorptivity_u_num"],
                          **{f"by {metal}": share for metal, share in s["by_material"].items()},
                          "plate": s["substrate"], "solid_thickness [um]": 1e6 * s["beds"][0]["solid_thickness"],
                          "mean_bounces": s["mean_bounces"]})
    return sorted(found, key=lambda r: (r["index"], *list(r.values())[:3]))


def tables(found):
    lines = []
    for name in INDICES:
        for h in THICKNESSES:
            for v in SPEEDS:
                of = [r for r in pick(found, h, v) if r["index"] == name]
                if of:
                    lines.append([name, h, v, *(told(by_seed(of, lambda s, k=k: s[0][k]), d) for k, d in (
                        ("absorptivity", 3), ("by AlSi10Mg", 3), ("by Cu", 4), ("plate", 3), ("solid_thickness [um]", 1)))])
    gain = []
    for name in INDICES:
        of = [r for r in found if r["index"] == name]
        gain.append(f"{name} {told(by_seed(of, lambda seed: 10 * slope([(r['solid_thickness [um]'], r['absorptivity']) for r in seed])))}")
    head = ["surface", "thickness [um]", "speed [mm/s]", "absorptivity", "by AlSi10Mg", "by Cu", "plate, of it",
            "solid [um]"]
    return {"light": table(head, lines), "light_gain": "; ".join(gain)}
