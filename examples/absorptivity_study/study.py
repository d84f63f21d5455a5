#!/usr/bin/env python3
"""Absorptivity against packing, layer thickness, grain size, spot, metal, incidence, and oxide; every point over five
beds. Writes docs/absorptivity.md with its plots:

    examples/absorptivity_study/study.py --program build/layerloop -o out/absorptivity

What lies in the output folder already is not computed again.
"""
import argparse
import json
import math
import pathlib
import shutil
import subprocess

import page

HERE = pathlib.Path(__file__).parent
DIAMETER = 30.0  # of the plain powder [um]
SIDE = 300.0  # of the plate [um]
THICKNESSES = [0.25, 0.5, 0.75, 1.0, 1.5, 2.5, 4.0]  # solid, in grain diameters
POWERS = [10, 20, 30, 45, 60, 80, 100]  # of the tracks [W]
METALS = ["Fe (Johnson 1974)", "Ti (Johnson 1974)", "Ni (Johnson 1974)", "Cr (Johnson 1974)", "Mo (Ordal 1988)",
          "W (Weaver 1975)", "Ta (Ordal 1988)", "Al (Rakic 1995)", "Cu (Ordal 1985)", "Cu (Johnson 1972)",
          "Cu (Babar 2015)", "Au (Babar 2015)", "Ag (Babar 2015)"]
PACKINGS = {  # contact values of deep beds, from dense to loose
    "frictionless": {"contact.sliding_friction": 0, "contact.rolling_friction": 0},
    "friction 0.4": {},
    "friction 1": {"contact.sliding_friction": 1, "contact.rolling_friction": 0.6},
    "cohesive": {"contact.sliding_friction": 1, "contact.rolling_friction": 0.6, "contact.cohesion": "sjkr2",
                 "contact.cohesion_energy_density": "6000 J/m3"}}


class Study:
    def __init__(self, program, out):
        self.program, self.out = program, out

    def absorb(self, name, arguments, settings=None):
        """Runs the verb once; its summary."""
        folder = self.out / name
        if not (folder / "summary.json").exists():
            sets = [word for key, value in (settings or {}).items() for word in ("--set", f"{key}={value}")]
            subprocess.run([self.program, "absorb", HERE / "plate.toml", *arguments, *sets, "-o", folder, "--quiet",
                            "--threads", "1"], check=True)
        return json.loads((folder / "summary.json").read_text())

    def settle(self, name, particles, side=SIDE, diameters=(DIAMETER,), fractions=(1,), settings=None, light=()):
        """Five beds; their summary."""
        lengths = ", ".join(f'"{d} um"' for d in diameters)
        return self.absorb(name, list(light), {
            "powder.particles": particles, "absorb.plate_length": f"{side} um", "powder.diameters": f"[{lengths}]",
            "powder.fractions": f"[{', '.join(map(str, fractions))}]", **(settings or {})})

    def relight(self, name, beds, arguments=(), settings=None):
        """The beds of an earlier run under other light."""
        files = [word for bed in sorted((self.out / beds).glob("bed_*.csv")) for word in ("--bed", bed)]
        return self.absorb(name, [*files, *arguments], {"run.pictures": "false", **(settings or {})})


    def track(self, bed, power, retrace=True):
        """A track over a bed that lies ready, by the layer loop; absorptivity over the track."""
        name = f"track_{bed.stem}_{power}W{'' if retrace else '_as_spread'}"
        folder = self.out / name
        if not (folder / "summary.json").exists():
            ready = self.out / f"ready_{bed.stem}.csv"
            write_ready(bed, ready)
            subprocess.run([self.program, "run", HERE / "track.toml", "-o", folder, "--quiet", "--set", f"powder.bed={ready.resolve()}",
                            "--set", f"laser.power={power} W", "--set", f"optics.retrace={str(retrace).lower()}"], check=True)
        return json.loads((folder / "summary.json").read_text())["layers"][0]["absorptivity"]


def write_ready(bed, ready):
    """A settled bed where the machine of track.toml has its plate; grains that reach over an end are left out."""
    begin, length = 150e-6, 400e-6
    lines = ["# units=m", "# x,y,z,radius,material"]
    for line in bed.read_text().splitlines()[2:]:
        x, y, z, radius, material = line.split(",")
        if float(radius) <= float(x) <= length - float(radius):
            lines.append(f"{float(x) + begin!r},{y},{z},{radius},{material}")
    ready.write_text("\n".join(lines) + "\n")


def grains(solid, side, diameters=(DIAMETER,), fractions=(1,)):
    """Number of grains of these sizes (fractions by volume) that make a solid layer so thick [um]."""
    volume = solid * side * side
    return round(sum(f * volume / (math.pi / 6 * d**3) for d, f in zip(diameters, fractions)))


def mean(values):
    """Mean of five beds, and half its 95 % interval."""
    m = sum(values) / len(values)
    sd = math.sqrt(sum((v - m) ** 2 for v in values) / (len(values) - 1))
    return m, 2.776 * sd / math.sqrt(len(values))


def figure(summary):
    """Absorptivity and half its 95 % interval over beds."""
    return summary["absorptivity"], summary["absorptivity_u_bed"]


def packing(summary):
    return sum(bed["packing_density"] for bed in summary["beds"]) / len(summary["beds"])


def run(study):
    results = {"thickness": [], "size": [], "packing": [], "distribution": [], "spot": [], "incidence": {}, "oxide": []}
    for ratio in THICKNESSES:
        s = study.settle(f"thickness_{ratio}", grains(ratio * DIAMETER, SIDE))
        results["thickness"].append((ratio, *figure(s), packing(s), s["substrate"]))
    for d in (15.0, 30.0, 60.0):
        side = 10 * d
        same = study.settle(f"layers_{d:.0f}", grains(d, side, (d,)), side, (d,))
        fixed = study.settle(f"size_{d:.0f}", grains(30.0, side, (d,)), side, (d,))
        results["size"].append((d, *figure(same), *figure(fixed)))
    for name, contact in PACKINGS.items():
        deep = study.settle(f"deep_{name.replace(' ', '_')}", grains(4 * DIAMETER, SIDE), settings=contact)
        thin = study.settle(f"thin_{name.replace(' ', '_')}", grains(DIAMETER, SIDE), settings=contact)
        results["packing"].append((name, packing(deep), *figure(deep), packing(thin), *figure(thin)))
    for name, diameters, fractions in (("one size, 30 um", (30.0,), (1,)), ("20 to 45 um", (20.0, 30.0, 45.0), (.25, .5, .25)),
                                       ("15 and 45 um", (15.0, 45.0), (.3, .7))):
        s = study.settle("sizes_" + name.replace(" ", "_").replace(",", ""), grains(30.0, SIDE, diameters, fractions), SIDE,
                         diameters, fractions)
        results["distribution"].append((name, *figure(s), packing(s)))
    wide = study.settle("wide", grains(DIAMETER, 2 * SIDE), 2 * SIDE)
    for spot in (30, 50, 80, 120, 200):
        s = study.relight(f"spot_{spot}", "wide", settings={
            "optics.uniform_beam": "false", "laser.spot_diameter": f"{spot} um", "laser.spot_definition": "1/e2"})
        results["spot"].append((spot, *figure(s), s["absorptivity_sd_bed"], s["absorptivity_u_num"]))
    results["even"] = figure(wide)
    for polarisation in ("unpolarised", "s", "p"):
        results["incidence"][polarisation] = [
            (angle, *figure(study.relight(f"incidence_{polarisation}_{angle}", "thickness_1.0", settings={
                "laser.incidence_angle": f"{angle} deg", "laser.polarisation": polarisation,
                "optics.polarisation_model": "tracked"}))) for angle in (0, 20, 40, 60, 75)]
    metals = ",".join(METALS)
    for name, beds in (("thin", "thickness_1.0"), ("deep", "thickness_4.0")):
        s = study.relight(f"metals_{name}", beds, ["--materials", metals])
        results[f"metals_{name}"] = [(m["name"], m["refractive_index"], *figure(m)) for m in s["sets"][1:]]
    colours = study.relight("colours", "thickness_1.0", ["--wavelengths", "450 nm,515 nm,532 nm,1030 nm,1080 nm"])
    results["colours"] = [(m["wavelength"], *figure(m)) for m in colours["sets"]]
    results["temperatures"] = {}
    for metal in ("316L", "Al", "Cu"):
        warm = study.relight(f"temperatures_{metal}", "thickness_4.0", ["--temperatures", "500 K,700 K,900 K"],
                             {"powder.material": metal})
        results["temperatures"][metal] = [figure(m) for m in warm["sets"]]
    mixed = study.settle("mixture", grains(2.5 * DIAMETER, SIDE), settings={
        "powder.material": "AlSi10Mg", "powder.mixture.AlSi10Mg": 0.96, "powder.mixture.Cu": 0.04})
    results["mixture"] = {name: (mixed["by_material"][name], mixed["by_material_figures"][name + "_u_bed"])
                          for name in mixed["by_material"]}
    results["mixture"]["sum"] = figure(mixed)
    for name, beds in (("thin", "thickness_1.5"), ("deep", "thickness_4.0")):
        s = study.relight(f"diode_{name}", beds, ["--materials", "Fe (Johnson 1974),Ti (Johnson 1974),Al (Rakic 1995)"],
                          {"laser.wavelength": "970 nm"})
        results[f"diode_{name}"] = {m["name"]: figure(m) for m in s["sets"][1:]}
    for film in (0, 5, 20, 50, 75, 100, 125, 150, 200):
        s = study.relight(f"oxide_{film}", "thickness_4.0", settings={
            "powder.material": "Al", "optics.oxide_thickness": f"{film} nm"})
        results["oxide"].append((film, *figure(s), s["materials"]["Al"]["flat_absorptivity"]))
    rough = study.relight("rough", "thickness_4.0", settings={"optics.diffuse_share": 1})
    results["rough"] = figure(rough)
    study.settle("track_beds", grains(2 * DIAMETER, 400), 400)
    beds = sorted((study.out / "track_beds").glob("bed_*.csv"))
    results["track"] = [(p, *mean([study.track(bed, p) for bed in beds])) for p in POWERS]
    results["track_as_spread"] = mean([study.track(bed, POWERS[0], retrace=False) for bed in beds])
    return results


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path, default=pathlib.Path("build/layerloop"))
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--docs", type=pathlib.Path, default=HERE.parent.parent / "docs")
    options = parser.parse_args()
    found = run(Study(options.program.resolve(), options.output))
    (options.output / "results.json").write_text(json.dumps(found, indent=1))
    pictures = options.docs / "absorptivity"
    pictures.mkdir(parents=True, exist_ok=True)
    for name in ("thickness_0.5", "deep_frictionless"):
        shutil.copy(options.output / name / "bed.png", pictures / f"{name}.png")
    page.write(found, options.docs)
