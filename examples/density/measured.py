"""Rows of Barrionuevo et al., Sci. Data 12 (2025) 375, as their CSV has them. SI; relative density in per cent."""
import csv
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    number: int
    paper: str
    power: float
    speed: float
    hatch: float
    layer: float
    spot: float
    d50: float
    density: float
    method: str

    @property
    def energy_density(self):
        """P / (v h t) [J/mm3]"""
        return 1e-9 * self.power / (self.speed * self.hatch * self.layer)

    @property
    def low(self):
        return self.density < 98


def read(path, material="AlSi10Mg", below=60.0):
    """Rows of a material with less than this energy density [J/mm3]; the numbers of those that lack a value, apart."""
    rows, lacking = [], []
    with open(path, newline="", encoding="utf-8-sig") as file:
        for line in csv.DictReader(file):
            if line["Material"] != material:
                continue
            try:
                row = Row(int(line["No."]), line["DOI"].split("doi.org/")[-1], float(line["Laser Power (W)"]),
                          1e-3 * float(line["Scan Speed (mm/s)"]), 1e-3 * float(line["Hatch space (mm)"]),
                          1e-3 * float(line["Layer thickness (mm)"]), 1e-3 * float(line["Spot size (mm)"]),
                          1e-6 * float(line["D50 μm"]), float(line["RD (%)"]), line["Density Measurement Method"])
            except ValueError:
                lacking.append(line["No."])
                continue
            if row.energy_density < below:
                rows.append(row)
    return rows, lacking


def speeds_to_run(rows, near=1.045):
    """{row number: speed}: of rows that differ in little but their speed, those within `near` of one share its run."""
    series, found = {}, {}
    for r in rows:
        series.setdefault((r.power, r.spot, r.d50, r.layer), []).append(r)
    for of in series.values():
        run = 0.0
        for r in sorted(of, key=lambda r: r.speed):
            if r.speed > near * run:
                run = r.speed
            found[r.number] = run
    return found
