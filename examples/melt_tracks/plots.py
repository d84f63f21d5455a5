"""Plots of docs/melt-tracks.md."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

BLUE, RED, GREEN, ORANGE, GREY = "#1f6fb2", "#d1495b", "#2a9d6f", "#e08e0b", "#666666"
plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
                     "svg.fonttype": "none"})


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def parity(path, series, names=("width", "depth"), band=0.1):
    """series: [(label, colour, marker, [(measured, u, computed, u), ...] per name), ...] in um."""
    figure, axes = plt.subplots(1, len(names), figsize=(4.2 * len(names), 4))
    for axis, k in zip(axes, range(len(names))):
        every = [v for _, _, _, points in series for p in points[k] for v in (p[0], p[2])]
        ends = np.array([min(every) * 0.85, max(every) * 1.15])
        axis.plot(ends, ends, color=GREY, lw=0.8)
        axis.fill_between(ends, ends * (1 - band), ends * (1 + band), color=GREY, alpha=0.12, lw=0)
        for label, colour, marker, points in series:
            m, mu, c, cu = np.array(points[k], float).T
            axis.errorbar(m, c, xerr=mu, yerr=cu, fmt=marker, color=colour, ms=4, lw=0.8, label=label)
        axis.set(xscale="log", yscale="log", xlim=ends, ylim=ends, xlabel=f"{names[k]} measured [um]",
                 ylabel=f"{names[k]} computed [um]", aspect="equal")
    axes[0].legend()
    save(figure, path)


def groups(path, tracks, residuals, second, repeats):
    """Left: errors of a smooth fit; right: settings made twice, once in each batch."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 4))
    for batch, marker in (("coarse", "o"), ("fine", "^")):
        for inside, colour in ((False, BLUE), (True, RED)):
            rows = [k for k, t in enumerate(tracks) if t.batch == batch and (t.name in second) == inside]
            left.plot(residuals[rows, 0], residuals[rows, 1], marker, color=colour, ms=5, ls="",
                      label=f"{batch}, {'second group' if inside else 'first group'}")
    left.axhline(0, color=GREY, lw=0.6), left.axvline(0, color=GREY, lw=0.6)
    left.set(xlabel="ln(width / smooth fit in P and v)", ylabel="ln(depth / smooth fit)", title="bare plate, no balling")
    left.legend(fontsize=7)
    for (name, pairs), colour in zip(repeats.items(), (GREEN, ORANGE, RED)):
        for key, marker in (("width", "s"), ("depth", "o")):
            right.plot([getattr(b, key) * 1e6 for _, b in pairs], [getattr(a, key) * 1e6 for a, _ in pairs], marker, ls="",
                       color=colour, mfc="none" if key == "width" else colour, label=f"{name} um of powder, {key}")
    ends = np.array([10, 260])
    right.plot(ends, ends, color=GREY, lw=0.8)
    right.set(xscale="log", yscale="log", xlabel="batch \"coarse\" [um]", ylabel="batch \"fine\" [um]", aspect="equal",
              title="the same setting in both batches")
    right.legend(fontsize=7)
    save(figure, path)


def residuals(path, tracks, errors):
    """tracks: (name, power, speed, ...); errors: {model: [(ln width ratio, ln depth ratio), ...]}."""
    figure, axes = plt.subplots(1, 2, figsize=(8.6, 3.4), sharey=True)
    power = [t[1] for t in tracks]
    for axis, n, name in zip(axes, (0, 1), ("width", "depth")):
        for (model, values), colour, marker in zip(errors.items(), (BLUE, RED), ("o", "^")):
            axis.plot(power, [v[n] for v in values], marker, color=colour, ms=4, ls="", label=model)
        axis.axhline(0, color=GREY, lw=0.6)
        axis.set(xlabel="power [W]", title=name)
    axes[0].set_ylabel("ln(computed / measured)")
    axes[0].legend(fontsize=7)
    save(figure, path)


def absorptivity(path, tracks, mixed):
    """Absorptivity and depth against power beside the calorimetry and the sections."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.6))
    power = [t["power"] for t in tracks]
    left.plot(power, [t["measured"][2] for t in tracks], "o", color=GREY, label="Trapp et al. 2017")
    right.errorbar(power, [t["measured"][1] * 1e6 for t in tracks], yerr=3, fmt="o", color=GREY, lw=0.8)
    for (label, rows), colour in zip([("keyhole", tracks), *((f"keyhole, melt mixed x {f}", r) for f, r in mixed.items())],
                                     (RED, ORANGE, BLUE)):
        left.plot(power, [t["absorptivity"] or np.nan for t in rows], "^-", color=colour, ms=4, lw=1, label=label)
        right.plot(power, [t["depth"] * 1e6 for t in rows], "^-", color=colour, ms=4, lw=1)
    left.set(xlabel="power [W]", ylabel="absorptivity", ylim=(0, 1))
    left.legend(fontsize=7)
    right.set(xlabel="power [W]", ylabel="depth [um]")
    save(figure, path)
