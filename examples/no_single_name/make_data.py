"""Makes the studies group and unknown: tracks as examples/hidden_effect has them, by the program itself, in other cells
and with an absorptivity of its own.
group    melt that flows, seen in two sections of each of six tracks
unknown  melt that flows in the case as well, and a machine that loses a third of its power between 600 and 800 mm/s,
         which no candidate does
Usage: make_data.py LAYERLOOP [POWER SPEED N]   with POWER [W], SPEED [mm/s]: prints N more rows a quantity for group
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).parent
u = {"pool.width": 3.0, "pool.depth": 2.0}  # um
flow = ["effects.marangoni.enabled=true", "effects.marangoni.strength=0.7"]
group = [(120, 400), (150, 800), (180, 600), (200, 1200), (220, 700), (150, 1200)]  # W, mm/s
unknown = [(120, 400), (120, 600), (150, 400), (150, 800), (150, 1200), (180, 600), (180, 1000), (200, 500), (200, 800),
           (200, 1200), (220, 700), (220, 1000)]


def pool(power, speed):
    with tempfile.TemporaryDirectory() as out:
        settings = flow + ["laser.absorptivity=0.37", "heat.cell_size=7um", f"laser.power={power}W",
                           f"scan.scan_speed={speed}mm/s"]
        command = [sys.argv[1], "melt", here / "group/case.toml", "-o", out, "--quiet"]
        subprocess.run(command + [a for s in settings for a in ("--set", s)], check=True)
        return json.loads((pathlib.Path(out) / "summary.json").read_text())["pool"]


def readings(power, speed, share, sections, draw, first):
    """Rows of one track; share: of the power, that arrives."""
    found, rows = pool(power * share, speed), []
    for section in range(sections):
        for quantity, scatter in u.items():
            value = 1e6 * found[quantity.split(".")[1]] + draw.gauss(0, scatter)
            rows.append(f"{first + len(rows)},{power} W {speed} mm/s,{quantity},{value:.1f},um,{scatter},{section + 1}")
    return rows


def write(name, tracks, share, sections, seed):
    draw, rows = random.Random(seed), []
    for power, speed in tracks:
        rows += readings(power, speed, share(speed), sections, draw, len(rows) + 1)
    conditions = [f"{power} W {speed} mm/s,{power},{speed}" for power, speed in tracks]
    header = "condition_id,laser.power [W],scan.scan_speed [mm/s]"
    (here / name / "conditions.csv").write_text("\n".join([header] + conditions) + "\n")
    header = "obs_id,condition_id,quantity,value,unit,u_stat,rep_id"
    (here / name / "measurements.csv").write_text("\n".join([header] + rows) + "\n")


if len(sys.argv) > 2:
    power, speed, count = map(int, sys.argv[2:])
    print("\n".join(readings(power, speed, 1, count, random.Random(power * speed), 1000 * power + speed)))
else:
    write("group", group, lambda speed: 1, 2, 3)
    write("unknown", unknown, lambda speed: 0.67 if 600 <= speed <= 800 else 1, 3, 5)
