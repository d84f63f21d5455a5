"""Part 1: surface coverage, volume fraction and sizes of the spread beds."""
import csv

from intervals import by_seed, slope, table, told, verdict

THICKNESSES, SPEEDS = (30, 50), (25, 50, 75)
COARSEST = 42e-6


def sizes(folder):
    """Diameter [m], share of the volume fed, share of the volume of the layer; by class."""
    with open(folder / "size_distribution.csv") as file:
        rows = [[float(v) for v in r.values()] for r in csv.DictReader(file)]
    shares = []
    for column in (1, 3):
        volumes = [r[column] * r[0] ** 3 for r in rows]
        shares.append([v / sum(volumes) for v in volumes])
    return [(1e-6 * r[0], fed, bed) for r, fed, bed in zip(rows, *shares)]


def setting(case):
    """Thickness [um] and speed [mm/s]."""
    swept = case["settings"]
    return round(1e6 * swept["machine.layer_thickness"]), round(1e3 * swept["machine.recoating_speed"])


def rows(cases):
    out = []
    for case in cases:
        layer, (thickness, speed) = case["layers"][0], setting(case)
        rear = layer["bins"][len(layer["bins"]) // 2:]  # where the powder has come down at every speed
        coarse = [s for s in sizes(case["folder"]) if abs(s[0] - COARSEST) < 1e-7][0]
        out.append({"thickness [um]": thickness, "speed [mm/s]": speed, "seed": case["seed"],
                    "surface_coverage": layer["surface_coverage"],
                    "volume_fraction_nominal": layer["volume_fraction_nominal"],
                    "rear_surface_coverage": sum(b["surface_coverage"] for b in rear) / len(rear),
                    "rear_volume_fraction_nominal": sum(b["volume_fraction_nominal"] for b in rear) / len(rear),
                    "volume_fraction_real": layer["volume_fraction_real"],
                    "effective_thickness [um]": 1e6 * layer["effective_thickness"], "d90 [um]": 1e6 * layer["d90"],
                    "mass_diameter [um]": 1e6 * layer["mass_diameter"],
                    "coarsest_volume_share_fed": coarse[1], "coarsest_volume_share_layer": coarse[2],
                    "grains_in_layer": layer["grains_in_layer"], "grains_nipped": layer["grains_nipped"],
                    "copper_mass_share_layer": layer["by_material"]["Cu"]["mass_share_layer"]})
    return sorted(out, key=lambda r: tuple(r.values())[:3])


def bin_rows(cases):
    out = []
    for case in cases:
        (thickness, speed), layer = setting(case), case["layers"][0]
        for b in layer["bins"]:
            out.append({"thickness [um]": thickness, "speed [mm/s]": speed, "seed": case["seed"],
                        "x [um]": 1e6 * (b["x"] - layer["bins"][0]["x"]), "surface_coverage": b["surface_coverage"],
                        "volume_fraction_nominal": b["volume_fraction_nominal"], "grains": b["grains"]})
    return sorted(out, key=lambda r: tuple(r.values())[:4])


def pick(all_rows, thickness=None, speed=None):
    return [r for r in all_rows if thickness in (None, r["thickness [um]"]) and speed in (None, r["speed [mm/s]"])]


def over_speeds(of, key):
    """Change from 25 to 75 mm/s, by least squares over the three speeds."""
    return by_seed(of, lambda seed: 50 * slope([(r["speed [mm/s]"], r[key]) for r in seed]))


def mean(of, key):
    return sum(r[key] for r in of) / len(of)


def between(of, key):
    """50 um less 30 um, mean over the speeds."""
    return by_seed(of, lambda seed: mean(pick(seed, 50), key) - mean(pick(seed, 30), key))


def along(of, key, part):
    """Change over the length of the bed, by least squares over its slices."""
    length = max(r["x [um]"] for r in of)
    of = [r for r in of if part[0] * length <= r["x [um]"] <= part[1] * length]
    return by_seed(of, lambda seed: length * slope([(r["x [um]"], r[key]) for r in seed]))


def trends(beds, bins):
    names = {"surface_coverage": "surface coverage", "volume_fraction_nominal": "volume fraction (nominal layer)"}
    out = []
    for key, name in names.items():
        for where, prefix in (("", ""), (", rear half", "rear_")):
            for h in THICKNESSES:
                out.append((f"{name}{where}: from 25 to 75 mm/s, {h} um", "falls", over_speeds(pick(beds, h), prefix + key), -1))
            out.append((f"{name}{where}: 50 um less 30 um", "about 0" if key == "surface_coverage" else "more",
                        between(beds, prefix + key), 0 if key == "surface_coverage" else 1))
    filtered = {h: by_seed(pick(beds, h), lambda seed: mean(seed, "coarsest_volume_share_layer") -
                           mean(seed, "coarsest_volume_share_fed")) for h in THICKNESSES}
    for h in THICKNESSES:
        out.append((f"volume share of the 42 um grains: layer less fed, {h} um",
                    "nearly all missing" if h == 30 else "less so", filtered[h], -1))
    out.append(("that share: 50 um less 30 um", "more", between(beds, "coarsest_volume_share_layer"), 1))
    for key, name in names.items():
        for h in THICKNESSES:
            says, sign = ("falls", -1) if h == 30 else ("(nothing said)", None)
            out.append((f"{name}: along the bed, {h} um, all speeds", says, along(pick(bins, h), key, (0, 1)), sign))
            out.append((f"{name}: the same at 25 mm/s, first and last quarter left out", says,
                        along(pick(bins, h, 25), key, (0.2, 0.8)), sign))
    return out


def tables(beds, bins):
    settings = []
    for h in THICKNESSES:
        for v in SPEEDS:
            of = pick(beds, h, v)
            if of:
                settings.append([h, v, len(of), *(told(by_seed(of, lambda s, k=k: s[0][k]), d) for k, d in (
                    ("surface_coverage", 3), ("volume_fraction_nominal", 3), ("rear_surface_coverage", 3),
                    ("rear_volume_fraction_nominal", 3), ("effective_thickness [um]", 1), ("d90 [um]", 1),
                    ("coarsest_volume_share_layer", 3)))])
    head = ["thickness [um]", "speed [mm/s]", "seeds", "coverage", "fraction", "coverage, rear half", "fraction, rear half",
            "height [um]", "d90 [um]", "volume share of 42 um"]
    judged = [[what, says, told(found), "" if sign is None else verdict(found, sign)]
              for what, says, found, sign in trends(beds, bins)]
    return {"spread_settings": table(head, settings), "fed_share": f"{mean(beds, 'coarsest_volume_share_fed'):.3f}",
            "spread_trends": table(["trend", "thesis", "here", "comes out"], judged)}


def plots(beds, bins, folder):
    import svg
    for key, label in (("surface_coverage", "surface coverage"), ("volume_fraction_nominal", "volume fraction, nominal layer")):
        series = []
        for h in THICKNESSES:
            points = [(v + 0.4 * (h > 30), *by_seed(pick(beds, h, v), lambda s: s[0][key])) for v in SPEEDS if pick(beds, h, v)]
            series.append((f"{h} um", points))
        svg.plot(folder / f"{key}.svg", series, "speed of the blade [mm/s]", label)
    for h in THICKNESSES:
        series = []
        for v in SPEEDS:
            of = pick(bins, h, v)
            series.append((f"{v} mm/s", [(x, *by_seed([r for r in of if r["x [um]"] == x], lambda s: s[0]["surface_coverage"]))
                                         for x in sorted({r["x [um]"] for r in of})]))
        svg.plot(folder / f"along_{h}um.svg", series, "along the bed [um]", f"surface coverage, {h} um")
