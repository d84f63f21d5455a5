"""docs/absorptivity.md out of the results of study.py; the measurements it is held against are named with their source."""
import csv
import json
import pathlib

import svg

HERE = pathlib.Path(__file__).parent


def flat(index):
    n, k = index
    return 4 * n / ((n + 1) ** 2 + k * k)


def pm(value, u, digits=3):
    return f"{value:.{digits}f} ± {u:.{digits}f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def measured():
    with open(HERE / "measured.csv") as file:
        return list(csv.DictReader(row for row in file if not row.startswith("#")))


def plots(found, folder):
    svg.plot(folder / "thickness.svg", [("316L on 316L, 30 um grains", [row[:3] for row in found["thickness"]])],
             "solid thickness of the layer / grain diameter", "absorptivity")
    svg.plot(folder / "size.svg", [("a layer of one diameter (solid)", [(r[0], r[1], r[2]) for r in found["size"]]),
                                   ("30 um solid, whatever the size", [(r[0], r[3], r[4]) for r in found["size"]])],
             "grain diameter [um]", "absorptivity")
    svg.plot(folder / "packing.svg", [("4 diameters (solid) deep", sorted((r[1], r[2], r[3]) for r in found["packing"]))],
             "packing density", "absorptivity")
    svg.plot(folder / "spot.svg", [("mean over five beds", [(r[0], r[1], r[2]) for r in found["spot"]])],
             "spot diameter, 1/e2 [um]", "absorptivity")
    svg.plot(folder / "incidence.svg", list(found["incidence"].items()), "angle of incidence [deg]", "absorptivity")
    series = []
    for name, words in (("metals_thin", "1 diameter (solid)"), ("metals_deep", "4 diameters (solid)")):
        series.append((words, sorted((flat(index), a, u) for _, index, a, u in found[name])))
    svg.plot(folder / "metals.svg", series, "absorptivity of the flat metal at normal incidence", "absorptivity of powder")
    svg.plot(folder / "track.svg", [("here, traced on what has melted", [row[:3] for row in found["track"]]),
                                    ("here, traced on the powder as it lay",
                                     [(row[0], *found["track_as_spread"]) for row in found["track"]]),
                                    ("Trapp et al. 2017, calorimetry", [r for r in trapp_powder() if r[0] < 140])],
             "power [W], 1.5 m/s, spot 60 um (1/e2)", "absorptivity over the track")
    svg.plot(folder / "oxide.svg", [("powder", [row[:3] for row in found["oxide"]]),
                                    ("flat, normal incidence", [(r[0], r[3], 0) for r in found["oxide"]])],
             "thickness of Al2O3 on aluminium [nm]", "absorptivity")


def trapp_powder():
    """Trapp et al. 2017, 100 um of 316L powder at 1500 mm/s."""
    with open(HERE / "trapp_powder.csv") as file:
        return [(float(r["power [W]"]), float(r["absorptivity"]), 0.0)
                for r in csv.DictReader(row for row in file if not row.startswith("#"))]


def fill(found):
    thin, deep = found["thickness"][3], found["thickness"][-1]
    by_packing = sorted((r[1], r[2], r[3], r[0]) for r in found["packing"])
    loosest, densest = by_packing[0], by_packing[-1]
    oxide = found["oxide"]
    best = max(oxide, key=lambda row: row[1])
    diode = found["diode_deep"]
    thin_diode = found["diode_thin"]
    rows = []
    for m in measured():
        computed = {"316L powder": "Fe (Johnson 1974)", "Ti-6Al-4V powder A": "Ti (Johnson 1974)",
                    "Ti-6Al-4V powder B": "Ti (Johnson 1974)", "Al powder": "Al (Rakic 1995)"}.get(m["surface"])
        if computed and m["source"].startswith("Rubenchik"):
            a, b = thin_diode[computed], diode[computed]
            here = f"{a[0]:.3f} to {b[0]:.3f} ({computed})"
        elif m["surface"] == "316L powder":
            here = f"{found['thickness'][4][1]:.3f} to {deep[1]:.3f} (Fe (Johnson 1974), not molten)"
        else:
            index = next(row[1] for row in found["metals_deep"] if row[0] == m["stand_in"])
            here = f"{flat(index):.3f} (flat, {m['stand_in']})"
        rows.append((m["surface"], m["wavelength [nm]"], m["absorptivity"], here, m["source"]))
    return {
        "comparison": table(("surface", "nm", "measured", "here", "source"), rows),
        "thickness": table(("solid thickness / d", "absorptivity", "95 % over 5 beds", "share of the floor"),
                           [(f"{r[0]:g}", f"{r[1]:.4f}", f"{r[2]:.4f}", f"{r[4]:.3f}") for r in found["thickness"]]),
        "size": table(("d [um]", "one diameter (solid) deep", "30 um (solid) deep"),
                      [(f"{r[0]:g}", pm(r[1], r[2], 4), pm(r[3], r[4], 4)) for r in found["size"]]),
        "packing": table(("contact", "packing density, deep", "absorptivity, deep", "absorptivity, one diameter (solid)"),
                         [(r[0], f"{r[1]:.3f}", pm(r[2], r[3], 4), pm(r[5], r[6], 4)) for r in found["packing"]]),
        "distribution": table(("powder, 30 um solid", "absorptivity", "95 % over 5 beds"),
                              [(r[0], f"{r[1]:.4f}", f"{r[2]:.4f}") for r in found["distribution"]]),
        "spot": table(("spot, 1/e2 [um]", "absorptivity", "95 % over 5 beds", "from bed to bed (1 sigma)", "rays (1 sigma)"),
                      [(r[0], f"{r[1]:.4f}", f"{r[2]:.4f}", f"{r[3]:.4f}", f"{r[4]:.4f}") for r in found["spot"]]),
        "even": pm(*found["even"], 4),
        "incidence": table(("angle [deg]", "unpolarised", "s", "p"),
                           [(row[0], *(pm(*found["incidence"][p][k][1:], 4) for p in ("unpolarised", "s", "p")))
                            for k, row in enumerate(found["incidence"]["unpolarised"])]),
        "metals": table(("optical constants", "n + ik", "flat", "1 diameter (solid)", "4 diameters (solid)"),
                        [(a[0], f"{a[1][0]:.3f} + {a[1][1]:.3f}i", f"{flat(a[1]):.4f}", pm(a[2], a[3], 4), pm(b[2], b[3], 4))
                         for a, b in zip(found["metals_thin"], found["metals_deep"])]),
        "colours": table(("wavelength [nm]", "absorptivity"),
                         [(f"{w * 1e9:.0f}", pm(a, u, 4)) for w, a, u in sorted(found["colours"])]),
        "temperatures": table(("metal", "300 K", "500 K", "700 K", "900 K"),
                              [(name, *(f"{a:.4f}" for a, _ in row)) for name, row in found["temperatures"].items()]),
        "mixture": table(("of the light", "share"), [(name, pm(*share, 4)) for name, share in found["mixture"].items()]),
        "oxide": table(("Al2O3 [nm]", "flat", "powder"), [(r[0], f"{r[3]:.4f}", pm(r[1], r[2], 4)) for r in oxide]),
        "track": table(("power [W]", "absorptivity over the track"), [(r[0], pm(r[1], r[2])) for r in found["track"]]),
        "track_as_spread": pm(*found["track_as_spread"]),
        "rough": pm(*found["rough"], 4), "deep": pm(deep[1], deep[2], 4), "thin": pm(thin[1], thin[2], 4),
        "loosest": f"{loosest[1]:.4f} at {loosest[0]:.3f} ({loosest[3]})",
        "densest": f"{densest[1]:.4f} at {densest[0]:.3f} ({densest[3]})",
        "best_film": f"{best[0]}", "best_oxide": f"{best[1]:.3f}", "bare_oxide": f"{oxide[0][1]:.3f}",
    }


def write(found, docs):
    plots(found, docs / "absorptivity")
    text = (HERE / "page.md").read_text()
    for name, value in fill(found).items():
        text = text.replace("{" + name + "}", value)
    (docs / "absorptivity.md").write_text(text)


if __name__ == "__main__":  # the page alone, from results.json
    import sys
    write(json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2]))
