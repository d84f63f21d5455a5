"""docs/melt-tracks.md out of the results of study.py."""
import csv
import math
import pathlib

import numpy as np

import groups
import keyhole
import measured
import plots
import powder as powder_tracks

HERE = pathlib.Path(__file__).parent
NOT_RUN = "Not computed in this run of the study.\n"


def um(value, digits=1):
    return "-" if value is None or math.isnan(value) else f"{value * 1e6:.{digits}f}"


def percent(value):
    return f"{100 * value:+.0f} %"


def off(computed, told):
    """computed / measured - 1 as per cent; - where either is missing."""
    value = computed / told - 1 if computed and told else math.nan
    return "-" if math.isnan(value) else percent(value)


def pm(value, half, digits=2):
    return f"{value:.{digits}f} ± {half:.{digits}f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def write_csv(path, head, rows):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        writer.writerows(rows)


def by_name():
    return {t.name: t for t in measured.hofmann()}


def words_of_groups(found, folder):
    tracks = groups.of(0.0)
    values, columns = groups.shapes(tracks), groups.basis(tracks, 2)
    pairs = {f"{s * 1e6:.0f}": groups.repeats(s) for s in groups.SURFACES}
    plots.groups(folder / "groups.png", tracks, values - columns @ groups.fit(columns, values),
                 set(found["groups"]["0"]["members"]), pairs)
    return f"""187 tracks: 64 on bare plate, 62 and 61 on 30 and 60 um; balling apart everywhere below.

{words_of_batches(found)}
{words_of_two(found)}
![groups](melt-tracks/groups.png)

**The floor.** Relative rms error at a track that was left out of a free fit in power and speed:

{floor_table(found)}
"""


def words_of_batches(found):
    def ratio(step):  # of a mean logarithm and half its interval
        return pm(math.exp(step[0]), math.exp(step[0]) * step[1])

    step = table(("powder [um]", "pairs", "width fine / coarse", "depth", "area", "depth, beside a smooth fit of all tracks"),
                 [(name, len(found["repeats"][name]), *(ratio(found["batch_step"][name][k]) for k in ("width", "depth", "area")),
                   ratio(found["batch_in_fit"][name]["depth"])) for name in ("0", "30", "60")])
    one = {name: [found["batch_step"][name][k] for k in ("width", "depth")] for name in ("0", "30", "60")}
    scatter = table(("powder [um]", "one track, width", "95 %", "depth", "95 %"),
                    [(name, *(cell for s in both for cell in
                              (f"{100 * s[2]:.0f} %", f"{100 * s[3][0]:.0f} to {100 * s[3][1]:.0f} %")))
                     for name, both in one.items()])
    return f"""**Two batches.** Some rows give lengths to 0.001 um ("fine"), the others to 0.1 um ("coarse"); hardly one series
of measurement. Every setting that was made twice was made once in each, so what looks like scatter of repeated tracks holds a
step from one batch to the other, and there is no repeat within a batch. ± is half the 95 % interval.

{step}
On bare plate the batches agree; on powder the fine batch is some 0.6 times as deep. What stands above the plate's surface (molten
area less 0.72 width x depth, over the width) is {bead_words()}:
the fine batch's 30 um layers gave as much metal as 60 um ones. So the beam hardly differs between the batches; the layer,
or how its depth was taken, does. Read as scatter of one track, with the chi-square interval of so few pairs:

{scatter}
"""


def words_of_two(found):
    two = table(("tracks", "n", "2 ln(likelihood ratio)", "gain in BIC", "p (bootstrap)", "second group: share, width, depth",
                 "depth scatter one / two groups"),
                [(label, g["n"], f"{g['ratio']:.1f}", f"{g['bic']:.1f}", f"{g['p']:.3f}",
                  f"{g['share']:.2f}, x {math.exp(g['offset'][0]):.2f}, x {math.exp(g['offset'][1]):.2f}",
                  f"{100 * g['without'][1]:.0f} / {100 * g['within'][1]:.0f} %")
                 for name, label in (("0", "bare"), ("conduction", "bare, conduction range"), ("30", "30 um"), ("60", "60 um"))
                 for g in [found["groups"][name]]])
    named = by_name()
    against = table(("quantity", "more from less", "than from", "ratio", "any monotone function misses one by"),
                    [(k, *(f"{t.power:.0f} W, {t.speed * 1e3:.0f} mm/s ({t.batch}): {um(getattr(t, k))} um"
                           for t in (named[a], named[b])), f"{math.exp(r):.2f}", f"{100 * r / 2:.0f} %")
                     for k in ("depth", "width") for a, b, r in found["against_monotony"][k][:3]])
    members = sorted((named[m] for m in found["groups"]["0"]["members"]), key=lambda t: (t.speed, t.power))
    listed = ", ".join(f"{t.power:.0f} W at {t.speed * 1e3:.0f}" for t in members)
    return f"""**Two groups.** One log-quadratic function of power and speed, for ln width and ln depth, against two a constant apart
(mixture of Gaussians, one covariance; bootstrap of 400 samples of the single function).

{two}
On bare plate the second group is {listed} mm/s. It has nothing to do with the batch (Fisher's exact test
p = {found["groups"]["0"]["batch_p"]:.2f}). Without any fit:

{against}
More light on slower scans left a pool half as deep: no function that grows with power and falls with speed, a smooth one
or not, gives both tracks. These settings lie about the keyhole threshold, where a track may run with a keyhole or without;
inside the conduction range the test finds no second group.
"""


def floor_table(found):
    return table(("tracks", "n", "width: power law, log-quadratic, Gaussian process", "depth"),
                 [(label, f["n"], *(", ".join(f"{100 * f[k][m]:.0f}" for m in ("power law", "log-quadratic",
                                                                                 "Gaussian process")) + " %"
                                      for k in ("width", "depth")))
                    for name, label in (("0", "bare"), ("conduction", "bare, conduction range"),
                                        ("conduction, fine", "that, batch fine"), ("conduction, coarse", "that, batch coarse"),
                                        ("30", "30 um"), ("60", "60 um")) for f in [found["floor"][name]]])


def bead_words():
    """Solid thickness above the plate by batch and layer, from the area that a section has beyond its depth."""
    words = []
    for surface in (30e-6, 60e-6):
        for batch in ("coarse", "fine"):
            values = [(t.area - 0.72 * t.width * t.depth) / t.width for t in groups.of(surface) if t.batch == batch]
            words.append(f"{um(float(np.median(values)), 0)} um ({surface * 1e6:.0f} um, {batch})")
    return ", ".join(words)


def words_of_trapp(found, folder):
    sizes, names = found["cells"], [m[0] for m in found["measured"]]
    fine, coarse = sizes["2.5"], sizes["5"]
    base = sizes["3.75"]
    rows = []
    for k, (name, w, d, a) in enumerate(found["measured"]):
        spot = [max(abs(found["variants"][f"spot {s} um"][k][n] - base[k][n]) for s in (55, 65)) for n in (0, 1)]
        own = [math.hypot(3e-6, s) for s in spot]
        rows.append((name, f"{a:.3f}", *(cell for n, told in ((0, w), (1, d)) for cell in
                     (f"{um(told, 0)} ± {um(own[n])}", f"{um(fine[k][n])} ± {um(abs(fine[k][n] - coarse[k][n]) / 3)}",
                      off(fine[k][n], told), f"{(fine[k][n] - told) / own[n]:+.1f}"))))
    main = table(("track", "A", "width measured [um]", "computed", "off", "off / u", "depth measured [um]", "computed",
                  "off", "off / u"), rows)
    variants = table(("change (cells of 3.75 um)", *(f"{name}: width, depth [um]" for name in names), "off, width", "off, depth"),
                     [(label, *(f"{um(p[0])}, {um(p[1])}" for p in pools),
                       *(", ".join(off(p[n], m[1 + n]) for p, m in zip(pools, found["measured"])) for n in (0, 1)))
                      for label, pools in [("none", base), *found["variants"].items()]])
    write_csv(folder / "trapp.csv", ("model", "track", "width [m]", "depth [m]"),
              [(label, name, *p[:2]) for label, pools in [(f"cell {c} um", v) for c, v in sizes.items()]
               + list(found["variants"].items()) for name, p in zip(names, pools)])
    return f"""Nothing fitted. Latent heat, k(T), evaporation, radiation and convection; the measured absorptivity in. Measured: ± u, from
digitisation (3 um) and what ± 5 um of spot do here; computed: cells of 2.5 um, ± a third of the difference to 5 um (order 2).

{main}
Peak temperatures {", ".join(f"{t:.0f}" for t in found["peak"])} K; the vapour takes
{", ".join(f"{100 * v:.0f}" for v in found["vapour"])} % of the absorbed heat. A calorimeter sees what stays in the disc:
"absorptivity net of vapour" absorbs {", ".join(f"{a:.3f}" for a in found["net absorptivity"])}, so that what stays is what was measured.

{variants}
{found.get("words", "")}"""


def model_rows(models, order):
    rows = []
    for name in order:
        m = models[name]
        rows.append((name, f"{m['absorptivity']:.2f}", f"{100 * m['width rms']:.0f} %", f"{100 * m['depth rms']:.0f} %",
                     f"{100 * m['rms']:.0f} %"))
    return rows


def words_of_ammt(found, folder):
    names = [m[0] for m in found["measured"]]
    models = found["models"]

    def wanted(m, key):
        return ", ".join("-" if math.isnan(a) else f"{a:.2f}" for a in m[key])

    rows = [(*row, ", ".join(f"{percent(e[0])} / {percent(e[1])}" for e in models[row[0]]["errors"]),
             wanted(models[row[0]], "wanted by width"), wanted(models[row[0]], "wanted by depth"))
            for row in model_rows(models, models)]
    main = table(("model", "A, best for all", "rms width", "rms depth", "both", f"{', '.join(names)}: width / depth",
                  "A wanted by widths", "by depths"), rows)
    final = table(("true runs", "A", "case", "width measured [um]", "computed", "depth measured [um]", "computed",
                   "at the solidus: width, depth", "length at 1290 C [um] (camera 20, 100 us)"),
                  [(name, f"{f['absorptivity']:.3f}", m[0], f"{um(m[1])} ± {um(m[2])}", finest(f, k, 0),
                    f"{um(m[3])} ± {um(m[4])}", finest(f, k, 1), f"{um(f['solidus'][k][0])}, {um(f['solidus'][k][1])}",
                    f"{um(f['solidus'][k][2], 0)} ({', '.join(um(v, 0) for v in found['length'][m[0]].values())})")
                   for name, f in found["final"].items() for k, m in enumerate(found["measured"])])
    write_csv(folder / "ammt.csv", ("model", "absorptivity", "case", "ln(width/measured)", "ln(depth/measured)"),
              [(name, m["absorptivity"], case, *e) for name, m in models.items() for case, e in zip(names, m["errors"])])
    return f"""Means over the cross sections of 4, 4 and 5 tracks, ± the standard error between tracks. "Mixed x f": the melt conducts f
times as well in every direction, one number for its flow. Surrogate: runs at cells of 8 um, straight in logarithms.

{main}
{final}
"""


def finest(final, k, n):
    """Pool of the finer cells, ± what the two grids leave open (order 2)."""
    (c1, coarse), (c2, fine) = sorted(((float(c), p) for c, p in final["pools"].items()), reverse=True)
    return f"{um(fine[k][n])} ± {um(abs(fine[k][n] - coarse[k][n]) / ((c1 / c2)**2 - 1))}"


def words_of_hofmann(found, folder, statistics):
    models = found["models"]
    rows = [(*row, f"{percent(m['mean'][0])}, {percent(m['mean'][1])}",
             f"{100 * m['scatter'][0]:.0f} %, {100 * m['scatter'][1]:.0f} %",
             "; ".join(f"{percent(m['by batch'][b][0])}, {percent(m['by batch'][b][1])}" for b in ("fine", "coarse")))
            for row in model_rows(models, models) for m in [models[row[0]]]]
    main = table(("model", "A, best", "rms width", "rms depth", "both", "mean off: width, depth", "scatter about it",
                  "mean off by batch: fine; coarse"), rows)
    told = statistics["sensitivities"]["conduction"]
    slopes = table(("d ln / d ln", "width, power", "width, speed", "depth, power", "depth, speed"),
                   [("measured", *(pm(*told[k][x]) for k in ("width", "depth") for x in ("power", "speed"))),
                    *((name, *(f"{m['sensitivities'][k][x][0]:.2f}" for k in ("width", "depth") for x in ("power", "speed")))
                      for name, m in models.items() if m["sensitivities"])])
    best = found["best"]
    series = []
    for name, colour, marker in (("conduction", plots.BLUE, "o"), (best, plots.RED, "^")):
        m = models[name]
        points = [[(t[3 + n] * 1e6, 0, t[3 + n] * 1e6 * math.exp(e[n]), 0) for t, e in zip(found["tracks"], m["errors"])]
                  for n in (0, 1)]
        series.append((f"{name}, A = {m['absorptivity']:.2f}", colour, marker, points))
    plots.parity(folder / "hofmann.png", series)
    plots.residuals(folder / "hofmann_power.png", found["tracks"],
                    {name: models[name]["errors"] for name in ("conduction", best)})
    write_csv(folder / "hofmann.csv", ("model", "absorptivity", "track", "ln(width/measured)", "ln(depth/measured)"),
              [(name, m["absorptivity"], t[0], *e) for name, m in models.items() for t, e in zip(found["tracks"], m["errors"])])
    fine = {name: [max(abs(math.log(a[n] / b[n])) for a, b in zip(*f.values())) / ((6.5 / 4.5)**2 - 1) for n in (0, 1)]
            for name, f in found["final"].items()}
    return f"""{len(found["tracks"])} tracks whose normalised enthalpy A P / (rho h_s sqrt(pi a v s^3)) with s = 40 um, the 1/e2 radius, and A = 0.30 is
below 9.2 (King et al. 2014: keyhole from 30 ± 4 with s = sigma, 10.6 ± 1.4 here): chosen by power and speed alone; none of
them balled. Errors of true runs in cells of 6.5 um (discretisation, from 4.5 um on every fourth track: at most
{100 * fine["conduction"][0]:.0f} % in width, {100 * fine["conduction"][1]:.0f} % in depth).

{main}
{slopes}
![parity](melt-tracks/hofmann.png)
![against power](melt-tracks/hofmann_power.png)
"""


def keyhole_rows(tracks):
    return [(f"{t['power']:.0f}", f"{t['measured'][2]:.3f}",
             *(("stopped", "-") if t["absorptivity"] is None else
               (f"{t['absorptivity']:.3f}", f"{t['absorptivity'] * (1 - t['vapour']):.3f}")),
             um(t["measured"][0], 0), um(t["width"]), off(t["width"], t["measured"][0]), um(t["measured"][1], 0),
             um(t["depth"]), off(t["depth"], t["measured"][1]), t["regime"]) for t in tracks]


def words_of_keyhole(found, folder):
    head = ("P [W]", "A measured", "absorbed", "less vapour", "width measured [um]", "computed", "off", "depth measured [um]",
            "computed", "off", "regime")
    plots.absorptivity(folder / "absorptivity.png", found["tracks"], found["mixed"])
    mixed = "".join(f"With a melt that mixes x {f}:\n\n{table(head, keyhole_rows(rows))}\n" for f, rows in found["mixed"].items())
    write_csv(folder / "keyhole.csv", ("power [W]", "absorptivity", "share of vapour", "width [m]", "depth [m]"),
              [(t["power"], t["absorptivity"], t["vapour"], t["width"], t["depth"]) for t in found["tracks"]])
    return f"""Nothing fitted to these points. The optical index is iron's times 1.319, so that a flat surface absorbs the 0.30 that the discs
absorb below the keyhole; the depression is the effect `keyhole`, and light is traced on it. Cells of 5 um; A over the whole
track of 0.5 mm (a calorimeter sees what stays: "less vapour"). Measured A ± 0.005 (0.06 at 83 W: two values), lengths ± 3 um.

{table(head, keyhole_rows(found["tracks"]))}
{mixed}![absorptivity](melt-tracks/absorptivity.png)
"""


def words_of_powder(found, folder):
    rows = []
    for models in zip(*(found[name]["tracks"] for name in found)):
        t = models[0]
        for w, d, balling, batch in t["measured"]:
            rows.append((f"{t['powder'] * 1e6:.0f}", f"{t['power']:.0f}", f"{t['speed'] * 1e3:.0f}", batch,
                         "yes" if balling else "",
                         *(cell for n, told in enumerate((w, d)) for cell in
                           (um(told), *(" ± ".join(map(um, predicted(x, n))) + (" in" if within(x, n, told) else " out")
                                        for x in models))),
                         ", ".join(f"{np.mean(x['absorptivity']):.2f}" for x in models)))
    write_csv(folder / "powder.csv", ("model", "powder [m]", "power [W]", "speed [m/s]", "seed", "width [m]", "depth [m]"),
              [(name, t["powder"], t["power"], t["speed"], k + 1, *s) for name in found for t in found[name]["tracks"]
               for k, s in enumerate(t["sizes"])])
    lines = []
    for name in found:
        s = {k: f"{100 * v[0]:.0f} % (95 %: {100 * v[1]:.0f} to {100 * v[2]:.0f} %)" for k, v in found[name]["scatter"].items()}
        parts = "; ".join(f"{layer * 1e6:.0f} um, {batch}: {coverage(found[name], (batch,), (layer,))}"
                          for layer in (30e-6, 60e-6) for batch in ("fine", "coarse"))
        lines.append(f"- {name}: inside, balling apart, {coverage(found[name])} ({parts}); scatter from bed to bed, relative: width "
                     f"{s['width']}, depth {s['depth']}.")
    told = "\n".join(lines)
    head = ("powder [um]", "P [W]", "v [mm/s]", "batch", "balling", "width measured [um]", *found, "depth measured [um]",
            *found, "A")
    return f"""Beds of five seeds, spread by DEM as `bed.toml` says (sizes assumed, 20 to 44 um; the lip lets a median grain pass, a
clearance that was chosen with the measured beads in view: some 10 and 23 um of solid on the plate); absorptivity from the tracer, index as for the keyhole, which is off; cells of
{powder_tracks.CELL * 1e6:.0f} um. Sample: all settings of the conduction range, by their inputs. Computed: mean over the beds ± half the 95 %
interval for one more bed.

{table(head, rows)}
{told}
- measured scatter of one track, batches mixed: see the chi-square intervals above.
"""


def worst(pairs):
    """Largest |computed / measured - 1| as per cent."""
    values = [abs(c / m - 1) for c, m in pairs if m == m]
    return f"{100 * max(values):.0f} %" if all(v == v for v in values) else "stopped"


def in_short(found):
    """One line for each bar."""
    rows = []
    if "trapp" in found:
        f = found["trapp"]
        for label, pools in (("conduction", f["cells"]["2.5"]), ("melt mixed x 3", f["variants"]["melt mixed x 3"]),
                             ("Eagar-Tsai, k = 20", f["variants"]["Eagar-Tsai, k = 20"])):
            off_w, off_d = ([(p[n], m[1 + n]) for p, m in zip(pools, f["measured"])] for n in (0, 1))
            rows.append((f"Trapp 32, 48, 65 W, {label}", "width 7 %, depth 10 %, or the measurement's own ± 3 um",
                         f"worst {worst(off_w)}, {worst(off_d)}; at 65 W {worst(off_w[2:])}, {worst(off_d[2:])}"))
    if "ammt" in found:
        for name in ("conduction", *[n for n in found["ammt"]["final"] if n != "conduction"]):
            m = found["ammt"]["models"][name]
            rows.append((f"AMMT A, B, C, {name}", "12 % in width and depth together, one A",
                         f"rms {100 * m['width rms']:.0f} %, {100 * m['depth rms']:.0f} %, together {100 * m['rms']:.0f} %, "
                         f"A = {m['absorptivity']:.2f}"))
    if "hofmann" in found and "groups" in found:
        floors = found["groups"]["floor"]["conduction"]
        for name in ("conduction", found["hofmann"]["best"], "melt mixed x 2, spot 100 um"):
            m = found["hofmann"]["models"][name]
            rows.append((f"Hofmann bare, conduction range, {name}",
                         f"free power law in P and v, a track left out: {100 * floors['width']['power law']:.0f} %, "
                         f"{100 * floors['depth']['power law']:.0f} %",
                         f"rms {100 * m['width rms']:.0f} %, {100 * m['depth rms']:.0f} %, A = {m['absorptivity']:.2f}"))
    if "keyhole" in found:
        runs = {"": found["keyhole"]["tracks"],
                **{f", melt mixed x {f}": r for f, r in found["keyhole"]["mixed"].items()}}
        for label, tracks in runs.items():
            high = [t for t in tracks if t["power"] >= 83]
            good = [t for t in high if t["absorptivity"]]
            gaps = [abs(t["absorptivity"] - t["measured"][2]) for t in good]
            gap, near = max(gaps), sum(g <= 0.1 for g in gaps)
            rows.append((f"Trapp 83 to 356 W, keyhole traced{label}", "absorptivity within 0.1, depth within 20 %",
                         f"worst {gap:.2f}, {worst([(t['depth'], t['measured'][1]) for t in good])}; width "
                         f"{worst([(t['width'], t['measured'][0]) for t in good])}; {near} of {len(high)} powers within 0.1"))
    if "powder" in found:
        for name in found["powder"]:
            rows.append((f"Hofmann on powder, {name}", "intervals cover the tracks", coverage(found["powder"][name])))
    return table(("what", "bar", "here"), rows)


def coverage(found, batches=("fine", "coarse"), layers=(30e-6, 60e-6)):
    """Of tracks that did not ball, how many lie in the 95 % interval for one more bed."""
    inside = [0, 0, 0]
    for t in found["tracks"]:
        for w, d, balling, batch in t["measured"]:
            if not balling and batch in batches and t["powder"] in layers:
                hits = [within(t, n, told) for n, told in enumerate((w, d))]
                inside = [inside[0] + 1, inside[1] + hits[0], inside[2] + hits[1]]
    return f"{inside[1]} widths and {inside[2]} depths of {inside[0]} tracks"


def predicted(track, n):
    """Mean over beds and half the 95 % interval for one more."""
    good = [s[n] for s in track["sizes"] if s[n] == s[n]]
    return powder_tracks.interval(good) if len(good) > 2 else (math.nan, math.nan)


def within(track, n, told):
    mean, half = predicted(track, n)
    return abs(told - mean) <= half


def write(found, docs):
    folder = docs / "melt-tracks"
    folder.mkdir(parents=True, exist_ok=True)
    parts = {"groups": words_of_groups, "trapp": words_of_trapp, "ammt": words_of_ammt, "keyhole": words_of_keyhole,
             "powder": words_of_powder}
    words = {name: part(found[name], folder) if name in found else NOT_RUN for name, part in parts.items()}
    words["hofmann"] = (words_of_hofmann(found["hofmann"], folder, found["groups"])
                        if "hofmann" in found and "groups" in found else NOT_RUN)
    words["short"] = in_short(found)
    text = (HERE / "page.md").read_text()
    for name, value in words.items():
        text = text.replace("{" + name + "}", value.strip())
    (docs / "melt-tracks.md").write_text(text)
