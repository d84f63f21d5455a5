"""Writes a study folder: study.toml, conditions.csv, measurements.csv, and the case beside them."""
import csv
import pathlib

import numpy as np


def write(folder, name, case, conditions, observations, calibration=""):
    """conditions: rows with condition_id first, keys with units; observations: dicts of measurements.csv."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "case.toml").write_text(case)
    (folder / "study.toml").write_text(
        f'[study]\nname = "{name}"\ncase = "case.toml"\nconditions = "conditions.csv"\n'
        f'measurements = "measurements.csv"\n{calibration}')
    for file, rows in (("conditions.csv", conditions), ("measurements.csv", observations)):
        with open(folder / file, "w", newline="") as out:
            table = csv.DictWriter(out, fieldnames=list(rows[0]))
            table.writeheader()
            table.writerows(rows)


def measured(true_values, u_rel, u_abs, replicates, holdout, seed, source):
    """Readings of {(condition, quantity): (value, unit)} with independent Gaussian noise of known size."""
    draw = np.random.default_rng(seed)
    rows = []
    for (condition, quantity), (value, unit) in true_values.items():
        u = float(np.hypot(u_rel[quantity] * value, u_abs[quantity]))
        for replicate in range(replicates):
            rows.append({"obs_id": f"{condition}-{quantity}-{replicate + 1}", "condition_id": condition,
                         "quantity": quantity, "value": f"{value + u * draw.standard_normal():.6g}", "unit": unit,
                         "u_stat": f"{u:.3g}", "u_sys_rel": 0, "u_sys_abs": 0, "sys_group": "",
                         "rep_id": replicate + 1, "role": "holdout" if condition in holdout else "train",
                         "source": source})
    return rows
