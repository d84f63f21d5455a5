#!/usr/bin/env python3
"""Spread beds from LIGGGHTS, as study folders.

A blade spreads grains from a pit over a recess; grains, walls and measures are those of the case, the program is
another: LIGGGHTS 3.8 (Kloss et al., Prog. Comput. Fluid Dyn. 12 (2012) 140).
  grains.py FOLDER [NAME...]   writes FOLDER/grains_null, grains_cohesion, grains_rolling
"""
import pathlib
import subprocess
import sys

import numpy as np

import study_folder

PIT, DEPTH, GAP, ZONE, WIDTH, BLADE = 300e-6, 60e-6, 50e-6, 400e-6, 130e-6, 50e-6  # [m]
DIAMETERS, DENSITY, MODULUS, GRAINS = (21e-6, 28e-6), 7904.0, 10e6, 650
CONDITIONS = [(speed, layer) for speed in (0.04, 0.06) for layer in (90e-6, 120e-6)]
HOLDOUT = ("g4",)
BEDS = 2
SEEDS = (67867967, 86028121)  # LIGGGHTS wants primes
UNITS = {"bed.effective_thickness": "um", "bed.surface_coverage": "1", "bed.roughness_sa": "um"}

CASE = """# Powder without cohesion, spread by a blade.
[case]
name = "beds of another program"
seed = 1
[powder]
material = "316L"
basis = "number"
diameters = ["21 um", "28 um"]
fractions = [0.5, 0.5]
particles = 650
[contact]
youngs_modulus = "10 MPa"
poisson_ratio = 0.3
restitution = 0.6
sliding_friction = 0.5
rolling_friction = 0.1
cohesion = "none"
[machine]
layer_thickness = "90 um"
recoating_speed = "60 mm/s"
accumulation_length = "300 um"
accumulation_depth = "60 um"
gap_length = "50 um"
deposition_length = "400 um"
width = "130 um"
blade_width = "50 um"
edge_radius = "5 um"
blade_clearance = "0 um"
[run]
layers = 1
bins = 4
pictures = false
"""

DECK = """units si
atom_style granular
atom_modify map array
boundary f p f
newton off
communicate single vel yes
region box block -60e-6 900e-6 0 {width} -200e-6 700e-6 units box
create_box 1 box
neighbor 4e-6 bin
neigh_modify delay 0 every 10 check yes
fix m1 all property/global youngsModulus peratomtype {modulus}
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.6
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 {rolling}
fix m6 all property/global cohesionEnergyDensity peratomtypepair 1 {cohesion}
fix m7 all property/global coefficientRollingViscousDamping peratomtypepair 1 0.3
pair_style gran model {model}
pair_coeff * *
timestep {dt}
fix grav all gravity 9.81 vector 0 0 -1
fix base all mesh/surface file base.stl type 1
fix blade all mesh/surface file blade.stl type 1
fix walls all wall/gran model {model} mesh n_meshes 2 meshes base blade
fix gate all wall/gran model {model} primitive type 1 xplane {pit}
fix pt1 all particletemplate/sphere 15485863 atom_type 1 volume_limit 1e-18 density constant {density} radius constant 10.5e-6
fix pt2 all particletemplate/sphere 15485867 atom_type 1 volume_limit 1e-18 density constant {density} radius constant 14e-6
fix pdd all particledistribution/discrete/numberbased 49979687 2 pt1 0.5 pt2 0.5
region cloud block 1e-6 {pit_inside} 0 {width} {floor} 620e-6 units box volume_limit 1e-16
fix ins all insert/pack seed {seed} distributiontemplate pdd maxattempt 400 insert_every once overlapcheck yes all_in yes vel constant 0 0 -0.1 region cloud particles_in_region {grains} ntry_mc 100000
fix integr all nve/sphere
thermo 100000
thermo_modify lost ignore norm no
run {settle}
unfix gate
fix mv all move/mesh mesh blade linear {speed} 0 0
run {stroke}
unfix mv
run {rest}
write_dump all custom bed.dump id radius x y z modify sort id
"""


def extrude(path, corners, longest=60e-6):
    """The surface over a line in the plane of x and z, across the whole width."""
    points = [corners[0]]
    for end in corners[1:]:
        begin = points[-1]
        parts = max(1, int(np.ceil(np.hypot(end[0] - begin[0], end[1] - begin[1]) / longest)))
        points += [(begin[0] + (end[0] - begin[0]) * i / parts, begin[1] + (end[1] - begin[1]) * i / parts)
                   for i in range(1, parts + 1)]
    rows = np.linspace(0, WIDTH, 3)
    text = "solid s\n"
    for (x0, z0), (x1, z1) in zip(points[:-1], points[1:]):
        for y0, y1 in zip(rows[:-1], rows[1:]):
            for triangle in (((x0, y0, z0), (x1, y0, z1), (x1, y1, z1)), ((x0, y0, z0), (x1, y1, z1), (x0, y1, z0))):
                p = np.array(triangle)
                n = np.cross(p[1] - p[0], p[2] - p[0])
                text += "facet normal %g %g %g\nouter loop\n" % tuple(n / np.linalg.norm(n))
                text += "".join("vertex %.9e %.9e %.9e\n" % tuple(v) for v in p) + "endloop\nendfacet\n"
    pathlib.Path(path).write_text(text + "endsolid s\n")


def arc(x, z, radius, begin, end):
    """Points on a circle, angles in degrees."""
    return [(x + radius * np.cos(t), z + radius * np.sin(t)) for t in np.radians(np.linspace(begin, end, 5))]


def spread(where, speed, layer, seed, model, cohesion=0.0, rolling=0.1):
    """Grains after the stroke: x, y, z, radius; x = 0 where the pit begins, z = 0 on the platforms."""
    where = pathlib.Path(where)
    if not (where / "bed.dump").exists():
        where.mkdir(parents=True, exist_ok=True)
        end = PIT + GAP + ZONE
        e, b = 20e-6, 5e-6  # radii of the platforms' edges and of the blade's
        extrude(where / "base.stl",
                [(-58e-6, 0), (0, 0), (0, -DEPTH), (PIT, -DEPTH)] + arc(PIT + e, -e, e, 180, 90) +
                arc(PIT + GAP - e, -e, e, 90, 0) + [(PIT + GAP, -layer), (end, -layer)] +
                arc(end + e, -e, e, 180, 90) + [(890e-6, 0)])
        extrude(where / "blade.stl", [(-BLADE, 600e-6)] + arc(-BLADE + b, b, b, 180, 270) + arc(-b, b, b, 270, 360) +
                [(0, 600e-6)])
        shear = MODULUS / 2.6
        dt = 0.149 * np.pi * 10.5e-6 * np.sqrt(DENSITY / shear) / (0.1631 * 0.3 + 0.8766)
        (where / "in.deck").write_text(DECK.format(
            width=WIDTH, modulus=MODULUS, rolling=rolling, cohesion=cohesion, model=model, dt=dt, pit=PIT,
            pit_inside=PIT - 1e-6, floor=-DEPTH + 1e-6, density=DENSITY, seed=seed, grains=GRAINS, speed=speed,
            settle=int(5e-3 / dt), stroke=int((end + BLADE) / speed / dt), rest=int(6e-3 / dt)))
        for attempt in range(3):  # its MPI sometimes gives up while it starts
            with open(where / "out.txt", "w") as out:
                subprocess.run(["liggghts", "-in", "in.deck", "-log", "none"], cwd=where, stdout=out, stderr=out)
            if (where / "bed.dump").exists():
                break
    rows = np.loadtxt(where / "bed.dump", skiprows=9)
    return rows[:, 2:5], rows[:, 1]


def measure(position, radius, layer):
    """As layerloop defines them, in the zone without two largest diameters at either end."""
    start, stop = PIT + GAP + 2 * DIAMETERS[1], PIT + GAP + ZONE - 2 * DIAMETERS[1]
    x = np.arange(start, stop, 1e-6) + 0.5e-6
    y = np.arange(0, WIDTH, 1e-6) + 0.5e-6
    top = np.full((len(x), len(y)), -layer)
    covered = np.zeros(top.shape, bool)
    for p, r in zip(position, radius):
        if not start - r < p[0] < stop + r or not -layer < p[2] < 2 * DIAMETERS[1]:  # fell or flies
            continue
        away_y = (y - p[1] + 0.5 * WIDTH) % WIDTH - 0.5 * WIDTH
        square = r * r - (x[:, None] - p[0])**2 - away_y[None]**2
        under = square > 0
        covered |= under
        top = np.where(under, np.maximum(top, p[2] + np.sqrt(np.maximum(square, 0))), top)
    return {"bed.effective_thickness": 1e6 * (top.mean() + layer), "bed.surface_coverage": covered.mean(),
            "bed.roughness_sa": 1e6 * np.abs(top - top.mean()).mean()}


def study(folder, name, model, **hidden):
    conditions, found = [], {}
    for n, (speed, layer) in enumerate(CONDITIONS, 1):
        conditions.append({"condition_id": f"g{n}", "machine.recoating_speed [mm/s]": 1e3 * speed,
                           "machine.layer_thickness [um]": 1e6 * layer})
        for bed in range(BEDS):
            at = f"{folder}/liggghts/{name}_g{n}_{bed}"
            found[f"g{n}", bed] = measure(*spread(at, speed, layer, SEEDS[bed], model, **hidden), layer)
            print(name, n, bed, found[f"g{n}", bed], flush=True)
    rows = []
    for quantity, unit in UNITS.items():
        # from bed to bed, pooled over the conditions as a share of the value
        spreads = [np.std([found[c["condition_id"], b][quantity] for b in range(BEDS)], ddof=1) /
                   np.mean([found[c["condition_id"], b][quantity] for b in range(BEDS)]) for c in conditions]
        relative = float(np.sqrt(np.mean(np.square(spreads))))
        for (condition, bed), values in found.items():
            rows.append({"obs_id": f"{condition}-{quantity}-{bed + 1}", "condition_id": condition,
                         "quantity": quantity, "value": f"{values[quantity]:.6g}", "unit": unit,
                         "u_stat": f"{max(relative, 0.02) * values[quantity]:.3g}", "u_sys_rel": 0, "u_sys_abs": 0,
                         "sys_group": "", "rep_id": bed + 1, "role": "holdout" if condition in HOLDOUT else "train",
                         "source": "LIGGGHTS 3.8"})
    study_folder.write(f"{folder}/{name}", name, CASE, conditions, rows)


PLAIN = "hertz tangential history"
ROLLING = " rolling_friction cdt"
STUDIES = {
    "grains_null": (PLAIN + ROLLING, {}),
    # ten weights of a grain as pull-off force: (16 pi^3/3) k^3 R^2 / E^2
    "grains_cohesion": (PLAIN + " cohesion sjkr2" + ROLLING, {"cohesion": 2.4e4}),
    # another model of rolling than layerloop's default: elastic-plastic spring and dashpot
    "grains_rolling": (PLAIN + " rolling_friction epsd2", {"rolling": 0.5}),
}

if __name__ == "__main__":
    for name, (model, hidden) in STUDIES.items():
        if len(sys.argv) < 3 or name in sys.argv[2:]:
            study(sys.argv[1], name, model, **hidden)
