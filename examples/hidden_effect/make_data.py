"""Makes conditions.csv and measurements.csv of this study: what the program itself would measure if an effect that
case.toml lacks were at work, in other cells and with an absorptivity of its own, three sections a track.
Usage: make_data.py LAYERLOOP"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).parent
tracks = [(120, 400), (120, 600), (150, 400), (150, 800), (150, 1200), (180, 600), (180, 1000), (200, 500), (200, 800),
          (200, 1200), (220, 700), (220, 1000)]  # W, mm/s
held_out = {(150, 600), (180, 800), (200, 1000), (220, 900)}
hidden = ["effects.marangoni.enabled=true", "effects.marangoni.strength=0.7"]
truth = hidden + ["laser.absorptivity=0.37", "heat.cell_size=7um", "case.seed=99"]
u = {"pool.width": 3.0, "pool.depth": 2.0}  # um
draw = random.Random(11)
conditions, rows = ["condition_id,laser.power [W],scan.scan_speed [mm/s]"], []
for power, speed in tracks + sorted(held_out):
    with tempfile.TemporaryDirectory() as out:
        settings = truth + [f"laser.power={power}W", f"scan.scan_speed={speed}mm/s"]
        command = [sys.argv[1], "melt", here / "case.toml", "-o", out, "--quiet"]
        subprocess.run(command + [a for s in settings for a in ("--set", s)], check=True)
        pool = json.loads((pathlib.Path(out) / "summary.json").read_text())["pool"]
    name = f"{power} W {speed} mm/s"
    conditions.append(f"{name},{power},{speed}")
    role = "holdout" if (power, speed) in held_out else "train"
    for section in (1, 2, 3):
        for quantity, scatter in u.items():
            value = 1e6 * pool[quantity.split(".")[1]] + draw.gauss(0, scatter)
            rows.append(f"{len(rows) + 1},{name},{quantity},{value:.1f},um,{scatter},section {section},{role}")
(here / "conditions.csv").write_text("\n".join(conditions) + "\n")
header = "obs_id,condition_id,quantity,value,unit,u_stat,rep_id,role"
(here / "measurements.csv").write_text("\n".join([header] + rows) + "\n")
