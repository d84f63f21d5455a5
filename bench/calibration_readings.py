#!/usr/bin/python3
"""Which reading of the thesis meets its two angles? One run of `layerloop calibrate` for each reading, as one table.

The thesis gives friction 0.7 and cohesion 90000 J/m3 and the angles that were measured, 28.7 and 41.6 degrees. It leaves
open how walls cohere, what bounds friction, how large the pile is, how it is poured, and when a layer counts as slipping.
usage: bench/calibration_readings.py [--program build/layerloop] [--only NAME,...] -o FOLDER
"""
import argparse
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
CASE = """[case]
name = "thesis calibration"
preset = "thesis"

[contact]
wall_cohesion_area = "liggghts"

[calibrate]
tilt_from = "30 deg"
"""
READINGS = {
    "reference: walls as LIGGGHTS, friction on the repulsive force": [],
    "wall cohesion by eq. 6": ["contact.wall_cohesion_area=eq6"],
    "friction on the total force": ["contact.coulomb_on=total"],
    "eq. 6 and total force": ["contact.wall_cohesion_area=eq6", "contact.coulomb_on=total"],
    "wall friction 0.9": ["contact.wall_friction=0.9"],
    "rolling friction 0.3": ["contact.rolling_friction=0.3"],
    "poured in 10 batches over a third of the base": ["calibrate.batches=10", "calibrate.cloud_width=0.33"],
    "the same, wall cohesion by eq. 6": ["calibrate.batches=10", "calibrate.cloud_width=0.33", "contact.wall_cohesion_area=eq6"],
    "layer tilted after 3 ms": ["calibrate.settling_time=3 ms"],
    "wall friction 0.9, rolling friction 0.3": ["contact.wall_friction=0.9", "contact.rolling_friction=0.3"],
}


def angle(summary, name):
    value, u = summary[name], summary.get(name + "_u_num") or 0
    return "none" if value is None else f"{value:.1f} ± {u:.1f}" if u else f"{value:.1f}"


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/layerloop")
    p.add_argument("--only", type=int, nargs="*", help="numbers of readings, from 0")
    p.add_argument("-o", "--output", type=pathlib.Path, required=True)
    chosen = p.parse_args()
    chosen.output.mkdir(parents=True, exist_ok=True)
    case = chosen.output / "case.toml"
    case.write_text(CASE)
    rows = ["| reading | angle of repose | arctan(h/(d/2)) | grains on the base | slipping angle | tilt at one diameter | both within 4 % |",
            "| --- | --- | --- | --- | --- | --- | --- |"]
    for k, (name, settings) in enumerate(READINGS.items()):
        if chosen.only is not None and k not in chosen.only:
            continue
        folder = chosen.output / f"reading_{k}"
        command = [chosen.program, "calibrate", case, "-o", folder, "--quiet", "--threads", "1"]
        for setting in settings:
            key, value = setting.split("=")
            command += ["--set", f'{key}="{value}"' if " " in value else f"{key}={value}"]
        subprocess.run([str(word) for word in command], check=True)
        s = json.loads((folder / "summary.json").read_text())
        rows.append(f"| {name} | {angle(s, 'angle_of_repose')} | {angle(s, 'angle_of_repose_from_height')} "
                    f"| {s['grains_on_base']:.0f} | {angle(s, 'slipping_angle')} | {angle(s, 'tilt_at_one_diameter')} "
                    f"| {'yes' if s['target_reached'] else 'no'} |")
        print(rows[-1], file=sys.stderr, flush=True)
    text = "\n".join(rows) + "\n"
    (chosen.output / "readings.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
