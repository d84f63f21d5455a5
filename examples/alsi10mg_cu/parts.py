"""Part 3: what the laser settings of Table 8 build."""
import csv
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "density"))
import overlap  # noqa: E402
from intervals import by_seed, mean_u, regression, table, told, verdict

HATCH, THICKNESS = 90e-6, 50e-6
CENTRE, LENGTH, WIDTH, ACROSS = 500, 240, 280, 180  # of the patch [um]: middle and extent along x, period and extent along y
STEADY = 1  # layers from here on lie on what was built (0: the first layer, on the bare plate)
THIRDS = ("bottom", "middle", "top")


def setting(case):
    """Power [W], speed [m/s], energy density [J/mm3], rounded as the thesis rounds."""
    power, speed = case["settings"]["laser.power"], case["settings"]["scan.scan_speed"]
    return round(power), speed, round(power / (speed * HATCH * THICKNESS) * 1e-9)


def roughness(folder, layers):
    """Arithmetic mean roughness Sa of the top of the patch about its mean height [um]."""
    with open(folder / f"part_surface_{layers:04}.csv") as file:
        heights = [float(r["height_above_plate [um]"]) for r in csv.DictReader(file)
                   if abs(float(r["x [um]"]) - CENTRE) <= LENGTH / 2 and abs(float(r["y [um]"]) - WIDTH / 2) <= ACROSS / 2]
    middle = sum(heights) / len(heights)
    return sum(abs(h - middle) for h in heights) / len(heights), middle


def criterion(width, depth):
    """(Q, relative density) by the overlap of pools that wide and that deep below the old surface [um]."""
    pool = width, depth + 1e6 * THICKNESS, 1e6 * HATCH, 1e6 * THICKNESS
    return overlap.number(*pool), 1 - overlap.unmelted(*pool)


def profile(folder):
    """(height [um], relative density, columns) of the slices that at least half of the patch rises above."""
    with open(folder / "part_profile.csv") as file:
        slices = [tuple(float(v) for v in r.values()) for r in csv.DictReader(file)]
    return [s for s in slices if s[2] >= 0.5 * slices[0][2]] if slices else []


def pooled(slices):
    columns = sum(s[2] for s in slices)
    return sum(s[1] * s[2] for s in slices) / columns if columns else float("nan")


def rows(cases, steady=STEADY):
    out = []
    for case in cases:
        power, speed, density = setting(case)
        layers, slices = case["layers"], profile(case["folder"])
        sa, height = roughness(case["folder"], len(layers))
        later = layers[steady:]

        def mean(value):
            return sum(value(layer) for layer in later) / len(later)

        thirds = {t: pooled([s for s in slices if k <= 3 * s[0] / (slices[-1][0] + slices[0][0]) < k + 1])
                  for k, t in enumerate(THIRDS)}
        q, by_overlap = criterion(1e6 * mean(lambda l: l["pool"]["width"]), 1e6 * mean(lambda l: l["pool"]["depth"]))
        out.append({"energy density [J/mm3]": density, "power [W]": power, "speed [m/s]": speed, "seed": case["seed"],
                    "overlap_number": q, "relative_density_by_overlap": by_overlap,
                    "relative_density": pooled(slices), **{f"{t}_relative_density": thirds[t] for t in THIRDS},
                    "part_relative_density": layers[-1]["part_relative_density"],
                    "height [um]": height, "roughness_sa [um]": sa, "absorptivity": mean(lambda l: l["absorptivity"]),
                    "pool_width [um]": 1e6 * mean(lambda l: l["pool"]["width"]),
                    "pool_depth [um]": 1e6 * mean(lambda l: l["pool"]["depth"]),
                    "pool_depth_u_num [um]": 1e6 * mean(lambda l: l["pool"]["depth_u_num"]),
                    "pool_length [um]": 1e6 * mean(lambda l: l["pool"]["length"]),
                    "real_thickness [um]": 1e6 * mean(lambda l: l["real_effective_thickness"]),
                    "fraction_real": mean(lambda l: l["volume_fraction_real"]),
                    "peak_temperature [K]": max(l["peak_temperature"] for l in layers),
                    "melted_mass [ug]": 1e9 * sum(l["melted_mass"] for l in layers),
                    "grains_trapped": sum(l["grains_trapped"] for l in layers)})
    return sorted(out, key=lambda r: (-r["energy density [J/mm3]"], r["power [W]"], r["seed"]))


def profile_rows(cases):
    out = []
    for case in cases:
        power, _, density = setting(case)
        out += [{"energy density [J/mm3]": density, "power [W]": power, "seed": case["seed"], "height [um]": z,
                 "relative_density": rd, "columns": n} for z, rd, n in profile(case["folder"])]
    return out


def layer_rows(cases):
    out = []
    for case in cases:
        power, speed, density = setting(case)
        for layer in case["layers"]:
            out.append({"energy density [J/mm3]": density, "power [W]": power, "speed [m/s]": speed, "seed": case["seed"],
                        "layer": layer["layer"], "real_thickness [um]": 1e6 * layer["real_effective_thickness"],
                        "surface_coverage": layer["surface_coverage"], "fraction_real": layer["volume_fraction_real"],
                        "absorptivity": layer["absorptivity"],
                        "absorptivity_u_num": layer["absorptivity_u_num"],
                        **{f"pool_{k} [um]": 1e6 * layer["pool"][k] for k in
                           ("width", "width_u_num", "depth", "depth_u_num", "length", "length_u_num")},
                        "peak_temperature [K]": layer["peak_temperature"], "melted_mass [ug]": 1e9 * layer["melted_mass"],
                        "grains_trapped": layer["grains_trapped"],
                        "part_relative_density": layer["part_relative_density"]})
    return out


INPUTS = [("energy density [J/mm3]", 10), ("power [W]", 90)]


def trends(found):
    out = []
    for preset, levels in (("table, 35/30/25", (35, 30, 25)), ("text, 35/25/20", (35, 25, 20)), ("all", (35, 30, 25, 20))):
        of = [r for r in found if r["energy density [J/mm3]"] in levels]
        by_energy, by_power = regression(of, "relative_density", INPUTS)
        out.append((f"relative density for 10 J/mm3 more, {preset}", "rises", by_energy, 1))
        out.append((f"relative density from 150 to 240 W at one energy density, {preset}", "rises", by_power, 1))
    whole = [r["top_relative_density"] - r["bottom_relative_density"] for r in found]
    out.append(("relative density: top third less bottom third", "rises", mean_u([v for v in whole if v == v]), 1))
    for key, name, energy_sign, power_sign in (
            ("part_relative_density", "relative density with the rim", 1, 1),
            ("relative_density_by_overlap", "relative density by the overlap of pools", 1, 1), ("pool_width [um]", "pool width [um]", None, None),
            ("pool_depth [um]", "pool depth [um]", None, None), ("absorptivity", "absorbed share", None, 1),
            ("roughness_sa [um]", "roughness Sa [um]", None, None)):
        by_energy, by_power = regression(found, key, INPUTS)
        out.append((f"{name} for 10 J/mm3 more", "rises" if energy_sign else "(not told)", by_energy, energy_sign))
        out.append((f"{name} from 150 to 240 W at one energy density", "rises" if power_sign else "(not told)", by_power,
                    power_sign))
    return out


def layer_table(layers):
    """Mean over all builds, by layer."""
    columns = [("real_thickness [um]", 1), ("surface_coverage", 3), ("fraction_real", 3), ("absorptivity", 3),
               ("pool_width [um]", 0), ("pool_depth [um]", 1), ("part_relative_density", 3)]
    lines = [[n, *(told(mean_u([r[k] for r in layers if r["layer"] == n]), d) for k, d in columns)]
             for n in sorted({r["layer"] for r in layers})]
    return table(["layer", "real thickness [um]", "coverage", "fraction", "absorbed", "pool width [um]", "depth [um]",
                  "density, rim and all"], lines)


def tables(found, layers):
    lines = []
    for density in sorted({r["energy density [J/mm3]"] for r in found}, reverse=True):
        for power in sorted({r["power [W]"] for r in found}):
            of = [r for r in found if r["energy density [J/mm3]"] == density and r["power [W]"] == power]
            if of:
                lines.append([density, power, f"{of[0]['speed [m/s]']:.3f}", len(of),
                              *(told(by_seed(of, lambda s, k=k: s[0][k]), d) if len(of) > 1 else f"{of[0][k]:.{d}f}"
                                for k, d in (("relative_density", 3), ("bottom_relative_density", 3),
                                             ("middle_relative_density", 3), ("top_relative_density", 3),
                                             ("relative_density_by_overlap", 3), ("overlap_number", 2),
                                             ("pool_width [um]", 0), ("pool_depth [um]", 0),
                                             ("real_thickness [um]", 0), ("absorptivity", 3), ("roughness_sa [um]", 1)))])
    head = ["E [J/mm3]", "P [W]", "v [m/s]", "seeds", "density", "bottom", "middle", "top", "by overlap", "Q", "pool width [um]",
            "depth [um]", "layer [um]", "absorbed", "Sa [um]"]
    judged = [[what, says, told(value), "" if sign is None else verdict(value, sign)]
              for what, says, value, sign in trends(found)]
    by_energy, by_power = regression(found, "relative_density", INPUTS)
    overlap_energy, overlap_power = regression(found, "relative_density_by_overlap", INPUTS)
    return {"overlap_energy": told(overlap_energy), "overlap_power": told(overlap_power),
            "density_energy": told(by_energy), "density_power": told(by_power), "part_layers": layer_table(layers),
            "part_settings": table(head, lines), "part_trends": table(["trend", "thesis", "here", "comes out"], judged)}


def tall_table(cases):
    """Builds of many layers: the patch by thirds, and pools from the fifth layer on, where layers repeat themselves."""
    lines = [[r["energy density [J/mm3]"], r["power [W]"], f"{r['speed [m/s]']:.3f}",
              *(f"{r[f'{t}_relative_density']:.4f}" for t in THIRDS), f"{r['relative_density']:.4f}",
              f"{r['relative_density_by_overlap']:.3f}", f"{r['overlap_number']:.2f}", f"{r['pool_width [um]']:.0f}",
              f"{r['pool_depth [um]']:.1f}", f"{r['real_thickness [um]']:.0f}", f"{r['absorptivity']:.3f}"]
             for r in rows(cases, steady=4)]
    return table(["E [J/mm3]", "P [W]", "v [m/s]", "bottom", "middle", "top", "density", "by overlap", "Q", "pool width [um]",
                  "depth [um]", "layer [um]", "absorbed"], lines)


def plots(found, profiles, folder):
    import svg
    powers = sorted({r["power [W]"] for r in found})
    energies = sorted({r["energy density [J/mm3]"] for r in found}, reverse=True)
    for key, label in (("relative_density", "relative density"), ("absorptivity", "absorbed share"),
                       ("pool_depth [um]", "pool depth [um]"), ("roughness_sa [um]", "Sa of the top [um]")):
        series = []
        for k, density in enumerate(energies):
            of = [r for r in found if r["energy density [J/mm3]"] == density]
            points = [(p + 1.5 * k, *mean_spread([r[key] for r in of if r["power [W]"] == p])) for p in powers
                      if any(r["power [W]"] == p for r in of)]
            series.append((f"{density} J/mm3", points))
        svg.plot(folder / f"part_{key.split()[0]}.svg", series, "power [W]", label)
    series = []
    for density in energies:
        of = [r for r in profiles if r["energy density [J/mm3]"] == density]
        series.append((f"{density} J/mm3", [(z, *mean_spread([r["relative_density"] for r in of if r["height [um]"] == z]))
                                            for z in sorted({r["height [um]"] for r in of})]))
    svg.plot(folder / "part_profile.svg", series, "height above the plate [um]", "relative density")


def mean_spread(values):
    """Mean, and half the range (of a few builds)."""
    return sum(values) / len(values), (max(values) - min(values)) / 2
