"""docs/density.md and its plots and tables out of the results of study.py."""
import csv
import math
import pathlib
import sys

import overlap
import roc

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "absorptivity_study"))
import svg  # noqa: E402

NAMES = {"paper": "the paper alone (share of its other rows)", "energy": "energy density P / (v h t)",
         "analytic": "Q, Eagar-Tsai pool", "plate": "Q, bed's absorptivity on a bare plate",
         "powder": "Q, track on the powder"}
KINDS = {"Archimedes method": "Archimedes", "Image analysis": "image analysis"}


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def number(value, digits=2):
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def interval(ends, digits=2):
    return f"{number(ends[0], digits)} to {number(ends[1], digits)}"


def discrimination(judged, gain):
    rows = []
    for m, j in judged.items():
        alone = m == "paper"  # a constant within a paper
        more = f"{gain[m][0]:+.2f} ({gain[m][1][0]:+.2f} to {gain[m][1][1]:+.2f})" if m in gain else "-"
        rows.append((NAMES[m], "-" if alone else f"**{number(j['within'])}**", "-" if alone else interval(j["within_ci"]), more,
                     number(j["pooled"]), interval(j["pooled_ci"]), number(j["rank"])))
    return table(["score", "within papers", "95 %", "more than energy density (95 %)", "pooled", "95 %", "rank correlation with the density"],
                 rows)


def papers(found):
    rows = []
    for paper, (_, pairs) in found["judged"]["energy"]["papers"].items():
        of = [r for r in found["rows"] if r.paper == paper]
        methods = sorted({KINDS.get(r.method, r.method) for r in of})
        rows.append((paper, len(of), sum(r.low for r in of), ", ".join(methods), pairs,
                     *(number(found["judged"][m]["papers"][paper][0]) for m in ("energy", "analytic", "plate", "powder"))))
    return table(["paper (DOI)", "rows", "below 98 %", "method", "pairs", "energy density", "Eagar-Tsai", "bare plate", "on powder"], rows)


def calibration(found):
    def end(value):
        return number(value) if value < 20 else "> 20 (the drawn papers part without overlap)"

    return table(["score", "slope of the logit over ln Q", "95 %", "Q of even odds"],
                 [(NAMES[m], number(c["slope"]), " to ".join(map(end, c["slope_ci"])), number(c["half"]))
                  for m, c in found["calibration"].items()])


def sensitivities(found):
    rows = [(NAMES["analytic"], f"absorptivity {a:g}", number(j["within"]), number(j["pooled"]))
            for a, j in found["analytic_over"].items()]
    if found["mixed"]:
        of = found["mixed"]
        rows.append((NAMES["powder"], f"melt conducts x {of['mixing']:g}; all rows with pairs, {of['stopped']} of them stopped",
                     f"{number(of['judged']['within'])} ({interval(of['judged']['within_ci'])})", "-"))
    return table(["score", "change", "within papers", "pooled"], rows)


def alike(found):
    return table(["score", "all pairs", "same method", "same layer thickness", "same layer and hatch"],
                 [(NAMES[m], number(found["judged"][m]["within"]), *(number(p[k]) for k in ("method", "layer", "hatch")))
                  for m, p in found["parts"].items()])


def rising(found):
    """Within papers, all rows and those up to the densest of their series."""
    left = len(found["rows"]) - len(found["past"])
    return table(["score", "within papers, all rows", f"without {len(found['past'])} rows slower than the densest of their series ({left} left)", "95 %"],
                 [(NAMES[m], number(found["judged"][m]["within"]), number(j["within"]), interval(j["within_ci"]))
                  for m, j in found["rising"].items()])


def lost(found, model, count=8):
    """Rows of the pairs that a score gets wrong, those in most of them first."""
    rows, scores, pools = found["rows"], found["scores"][model], found["pools"]
    wrong = [0] * len(rows)
    for i, a in enumerate(rows):
        for j, b in enumerate(rows):
            if a.paper == b.paper and a.low and not b.low and scores[i] < scores[j]:
                wrong[i] += 1
                wrong[j] += 1
    order = sorted(range(len(rows)), key=lambda k: -wrong[k])[:count]
    return table(["power [W]", "speed [mm/s]", "hatch [um]", "layer [um]", "density [%]", "J/mm3" if model == "energy" else "Q", "pool on powder, W x D [um]", "pairs lost"],
                 [(f"{r.power:g}", f"{1e3 * r.speed:.0f}", f"{1e6 * r.hatch:.0f}", f"{1e6 * r.layer:.0f}", f"{r.density:.1f}",
                   number(abs(scores[k])), " x ".join(f"{1e6 * s:.0f}" for s in pools[k]["powder"]), wrong[k])
                  for k in order for r in [rows[k]] if wrong[k]])


def roc_plot(curves, side=400, left=60, top=12):
    """ROC curves as SVG, the diagonal of chance, and their names with the area where none of them runs."""
    bottom, right = top + side, left + side
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {right + 12} {bottom + 48}" width="{right + 12}" '
           f'height="{bottom + 48}" font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>']
    for share in (0, 0.2, 0.4, 0.6, 0.8, 1):
        x, y = left + side * share, bottom - side * share
        out.append(f'<path d="M{left} {y:.1f}h{side}M{x:.1f} {top}v{side}" stroke="#e4e8ec"/><text x="{left - 7}" y="{y + 4:.1f}" '
                   f'text-anchor="end" fill="#555">{share:g}</text><text x="{x:.1f}" y="{bottom + 17}" text-anchor="middle" '
                   f'fill="#555">{share:g}</text>')
    out.append(f'<path d="M{left} {bottom}L{right} {top}" stroke="#999" stroke-dasharray="4 4"/>'
               f'<path d="M{left} {top}v{side}h{side}" fill="none" stroke="#555"/>'
               f'<text x="{left + side / 2}" y="{bottom + 38}" text-anchor="middle">false alarms: share of the rows at or above 98 %</text>'
               f'<text transform="translate(16 {top + side / 2}) rotate(-90)" text-anchor="middle">found: share of the rows below 98 %</text>')
    for k, (name, corners) in enumerate(curves):
        points = " ".join(f"{left + side * x:.1f},{bottom - side * y:.1f}" for x, y in corners)
        y = bottom - 18 * (len(curves) - k)
        out.append(f'<polyline points="{points}" fill="none" stroke="{svg.COLOURS[k]}" stroke-width="1.8"/>'
                   f'<rect x="{left + 130}" y="{y}" width="12" height="10" fill="{svg.COLOURS[k]}"/>'
                   f'<text x="{left + 148}" y="{y + 9}">{name}</text>')
    return "\n".join(out + ["</svg>\n"])


def plots(found, folder):
    low = [r.low for r in found["rows"]]
    corners = {m: roc.curve(found["scores"][m], low) for m in ("energy", "analytic", "plate", "powder")}
    (folder / "roc.svg").write_text(roc_plot([(f"{NAMES[m]}: {found['judged'][m]['pooled']:.2f}", c) for m, c in corners.items()]))
    with open(folder / "roc.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["score", "false_positive_rate", "true_positive_rate"])
        out.writerows((m, f"{x:.5f}", f"{y:.5f}") for m, c in corners.items() for x, y in c)
    kinds = {}
    for kind, computed, told in densities(found, "powder"):
        kinds.setdefault(kind, []).append((computed, told, 0))
    svg.plot(folder / "density.svg", sorted(kinds.items()), "computed from the overlap, track on the powder [%]",
             "measured relative density [%]", lines=False)


def densities(found, model):
    """(method, computed, measured) of every row [%]."""
    return [(KINDS.get(r.method, r.method), 100 * (1 - overlap.unmelted(*p[model], r.hatch, r.layer, 500)), r.density)
            for r, p in zip(found["rows"], found["pools"])]


def by_method(found):
    rows = []
    for model in ("analytic", "plate", "powder"):
        told = densities(found, model)
        for kind in sorted({k for k, _, _ in told}):
            pairs = [(c, m) for k, c, m in told if k == kind]
            off = [c - m for c, m in pairs]
            mean = sum(off) / len(off)
            rows.append((NAMES[model], kind, len(pairs), number(roc.rank_correlation(*zip(*pairs))), f"{mean:+.1f}",
                         number(math.sqrt(sum(v * v for v in off) / len(off)), 1)))
    return table(["pools", "measured by", "rows", "rank correlation", "computed less measured, mean [%]", "rms [%]"], rows)


def rows_csv(found, path):
    """Every row with what was computed for it; beside the runs, since it holds the measurements."""
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["number", "paper", "power [W]", "speed [mm/s]", "hatch [um]", "layer [um]", "spot [um]", "d50 [um]",
                      "density [%]", "method", "energy_density [J/mm3]", "absorptivity_bed", "absorptivity_on_powder", "regimes",
                      *(f"{k}_{m}" for m in ("analytic", "plate", "powder") for k in ("width [um]", "depth [um]", "Q", "density [%]"))])
        for r, p in zip(found["rows"], found["pools"]):
            of_models = []
            for m in ("analytic", "plate", "powder"):
                w, d = p[m]
                of_models += [f"{1e6 * w:.1f}", f"{1e6 * d:.1f}", f"{overlap.number(w, d, r.hatch, r.layer):.4f}",
                              f"{100 * (1 - overlap.unmelted(w, d, r.hatch, r.layer)):.2f}"]
            out.writerow([r.number, r.paper, r.power, round(1e3 * r.speed, 3), round(1e6 * r.hatch, 3), round(1e6 * r.layer, 3),
                          round(1e6 * r.spot, 3), round(1e6 * r.d50, 3), r.density, r.method, f"{r.energy_density:.2f}",
                          f"{p['absorptivity']:.4f}", f"{sum(p['on_powder']) / len(p['on_powder']):.4f}", " ".join(p["regimes"]), *of_models])


def write(found, docs, out):
    folder = docs / "density"
    folder.mkdir(exist_ok=True)
    plots(found, folder)
    rows_csv(found, out / "rows.csv")
    rows = found["rows"]
    values = {"rows": len(rows), "low": sum(r.low for r in rows), "papers": len({r.paper for r in rows}),
              "lacking": ", ".join(found["lacking"]) or "none", "discrimination": discrimination(found["judged"], found["gain"]), "every": discrimination(found["every"]["judged"], found["every"]["gain"]),
              "all_rows": len(found["every"]["rows"]), "all_low": sum(r.low for r in found["every"]["rows"]),
              "as_none": "{:.2f} within papers and {:.2f} pooled".format(*found["every"]["as_none"]),
              "stopped": len(found["every"]["rows"]) - len(rows), "by_paper": papers(found),
              "calibration": calibration(found), "sensitivities": sensitivities(found), "alike": alike(found),
              "rising": rising(found), "by_method": by_method(found), "ceiling": number(found["ceiling"]),
              **{f"lost_{m}": lost(found, m) for m in ("energy", "analytic", "plate", "powder")}}
    text = (HERE / "page.md").read_text()
    for name, value in values.items():
        text = text.replace("{" + name + "}", str(value))
    (docs / "density.md").write_text(text)
