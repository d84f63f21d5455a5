#!/usr/bin/env python3
"""Absorptivity of powder from another ray tracer than layerloop's, as study folders.

Brute force in numpy: every ray against every sphere and its periodic images, unpolarised light at every hit, Fresnel's
equations in complex form. The beds are layerloop's, settled with other seeds than the model will use.
  tracer.py LAYERLOOP FOLDER   LAYERLOOP: the program; writes FOLDER/light_null, light_oxide, light_rough, light_sphere
"""
import pathlib
import subprocess
import sys

import numpy as np

import study_folder

# n + ik of iron (Johnson & Christy 1974) and of Fe2O3 (Querry 1985) at both wavelengths, as layerloop check prints them
METAL = {1070: 2.961346153846154 + 4.013269230769231j, 515: 2.8312 + 2.9028j}
OXIDE = {1070: 2.7534 + 0.011j, 515: 3.2705 + 0.6075j}

CASE = """# 316L powder that has settled on a plate, evenly lit.
[case]
name = "powder of another tracer"
seed = 1
[powder]
material = "316L"
basis = "number"
diameters = ["30 um", "40 um"]
fractions = [0.5, 0.5]
particles = 150
[contact]
youngs_modulus = "5 MPa"
poisson_ratio = 0.3
restitution = 0.4
sliding_friction = 0.4
rolling_friction = 0.1
cohesion = "none"
[laser]
wavelength = "1070 nm"
[optics]
uniform_beam = true
rays = 20000
[absorb]
bed = "settled"
plate_length = "280 um"
target_standard_error = 0.002
[run]
pictures = false
"""
CONDITIONS = [(wavelength, angle, grains) for wavelength in (1070, 515) for angle in (0, 30, 50)
              for grains in (90, 250)]
HOLDOUT = ("l03", "l06", "l10")
BEDS = 3


def fresnel(cosine, n):
    """Reflectance of unpolarised light."""
    root = np.sqrt(n * n - 1 + cosine**2 + 0j)
    s = (cosine - root) / (cosine + root)
    p = (n * n * cosine - root) / (n * n * cosine + root)
    return 0.5 * (abs(s)**2 + abs(p)**2)


def filmed(cosine, n, film, thickness, wavelength):
    """The same with a film, by characteristic matrices (Born & Wolf 1.6.2)."""
    sine2 = 1 - cosine**2
    inside, below = np.sqrt(film**2 - sine2 + 0j), np.sqrt(n * n - sine2 + 0j)
    phase = 2 * np.pi / wavelength * thickness * inside
    total = 0
    for eta0, eta1, eta2 in ((cosine, inside, below), (1 / cosine, film**2 / inside, n * n / below)):
        b = np.cos(phase) - 1j * np.sin(phase) * eta2 / eta1
        c = eta2 * np.cos(phase) - 1j * np.sin(phase) * eta1
        total = total + 0.5 * abs((eta0 * b - c) / (eta0 * b + c))**2
    return total


def absorptivity(spheres, period, angle, reflectance, rays, draw, roughness=0.0):
    """Share of evenly falling light that spheres and a plate at z = 0 keep."""
    shifts = np.array([(i, j, 0) for i in (-1, 0, 1) for j in (-1, 0, 1)]) * period
    centre = (spheres[None, :, :3] + shifts[:, None, :]).reshape(-1, 3)
    radius = np.tile(spheres[:, 3], 9)
    top = (spheres[:, 2] + spheres[:, 3]).max() + 1e-6
    p = np.column_stack([draw.random(rays) * period, draw.random(rays) * period, np.full(rays, top)])
    d = np.tile([np.sin(angle), 0, -np.cos(angle)], (rays, 1))
    weight, kept = np.ones(rays), 0.0
    for _ in range(400):
        t, which = np.full(len(p), np.inf), np.full(len(p), -1)
        for at in range(0, len(p), 500):
            rows = slice(at, at + 500)
            away = p[rows, None, :] - centre[None]
            b = np.einsum("rsi,ri->rs", away, d[rows])
            disc = b * b - np.einsum("rsi,rsi->rs", away, away) + radius**2
            near = np.where((disc > 0) & (b < 0), -b - np.sqrt(np.maximum(disc, 0)), np.inf)
            near[near < 1e-10] = np.inf
            which[rows] = near.argmin(axis=1)
            t[rows] = near.min(axis=1)
        plate = np.where(d[:, 2] < 0, -p[:, 2] / np.minimum(d[:, 2], -1e-12), np.inf)
        leave = np.where(d[:, 2] > 0, (top - p[:, 2]) / np.maximum(d[:, 2], 1e-12), np.inf)
        sideways = period / np.maximum(np.hypot(d[:, 0], d[:, 1]), 1e-12)
        step = np.minimum(np.minimum(t, plate), np.minimum(leave, sideways))
        p = p + step[:, None] * d
        hit_sphere, hit_plate = step == t, (step == plate) & (step != t)
        hit, gone = hit_sphere | hit_plate, (step == leave) & ~(hit_sphere | hit_plate)
        normal = np.tile([0.0, 0, 1], (len(p), 1))
        normal[hit_sphere] = (p[hit_sphere] - centre[which[hit_sphere]]) / radius[which[hit_sphere], None]
        if roughness:
            tilt = normal + roughness * draw.standard_normal(normal.shape)
            tilt /= np.linalg.norm(tilt, axis=1)[:, None]
            bounced = d - 2 * np.einsum("ri,ri->r", d, tilt)[:, None] * tilt
            good = (np.einsum("ri,ri->r", d, tilt) < 0) & (np.einsum("ri,ri->r", bounced, normal) > 0)
            facet = np.where(good[:, None], tilt, normal)
        else:
            facet = normal
        cosine = np.clip(-np.einsum("ri,ri->r", d, facet), 1e-6, 1)
        R = np.where(hit, reflectance(cosine, draw), 1)
        kept += float((weight * (1 - R))[hit].sum())
        weight = weight * R
        d = np.where(hit[:, None], d + 2 * cosine[:, None] * facet, d)
        p[:, :2] %= period
        stays = ~gone & (weight > 1e-4)
        p, d, weight = p[stays], d[stays], weight[stays]
        if len(p) == 0:
            break
    return kept / rays


def settled_beds(program, folder, grains, seed):
    """Beds of the program, with other seeds than those of the model."""
    where = pathlib.Path(folder) / f"beds_{grains}"
    if not (where / f"bed_{BEDS:04}.csv").exists():
        where.mkdir(parents=True, exist_ok=True)
        (where / "case.toml").write_text(CASE)
        subprocess.run([program, "absorb", where / "case.toml", "-o", where, "--quiet", "--threads", "1",
                        "--seed", str(seed), "--set", f"powder.particles={grains}", "--set", f"run.replicates={BEDS}"],
                       check=True)
    return [np.loadtxt(where / f"bed_{n:04}.csv", delimiter=",", comments="#")[:, :4] for n in range(1, BEDS + 1)]


def film_of(wavelength, mean=20e-9):
    """Films whose thickness varies from place to place by 40 % (layerloop's has one thickness)."""
    def reflectance(cosine, draw):
        thickness = mean * np.exp(0.4 * draw.standard_normal(cosine.shape) - 0.08)
        return filmed(cosine, METAL[wavelength], OXIDE[wavelength], thickness, wavelength * 1e-9)
    return reflectance


def study(program, folder, name, rays=4000):
    draw = np.random.default_rng(11)
    conditions, rows = [], []
    for n, (wavelength, angle, grains) in enumerate(CONDITIONS, 1):
        label = f"l{n:02d}"
        conditions.append({"condition_id": label, "laser.wavelength [nm]": wavelength,
                           "laser.incidence_angle [deg]": angle, "powder.particles": grains})
        bare = lambda cosine, draw, w=wavelength: fresnel(cosine, METAL[w])  # noqa: E731
        values = [absorptivity(bed, 280e-6, np.radians(angle), film_of(wavelength) if name == "light_oxide" else bare,
                               rays, draw, roughness=0.35 if name == "light_rough" else 0)
                  for bed in settled_beds(program, folder, grains, 900)]
        if name == "light_sphere":  # an integrating sphere whose reference has faded
            values = [1.08 * value for value in values]
        u = float(np.hypot(np.std(values, ddof=1), 0.006))
        print(name, label, wavelength, angle, grains, [round(v, 4) for v in values], flush=True)
        for bed, value in enumerate(values, 1):
            rows.append({"obs_id": f"{label}-{bed}", "condition_id": label, "quantity": "absorptivity",
                         "value": f"{value + 0.003 * draw.standard_normal():.5f}", "unit": "1", "u_stat": f"{u:.4f}",
                         "u_sys_rel": 0, "u_sys_abs": 0, "sys_group": "", "rep_id": bed,
                         "role": "holdout" if label in HOLDOUT else "train", "source": "brute-force tracer in numpy"})
    study_folder.write(f"{folder}/{name}", name, CASE, conditions, rows)


if __name__ == "__main__":
    for name in ("light_null", "light_oxide", "light_rough", "light_sphere"):
        if len(sys.argv) < 4 or name in sys.argv[3:]:
            study(sys.argv[1], sys.argv[2], name)
