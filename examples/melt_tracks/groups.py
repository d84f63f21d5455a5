"""Statistics of the Hofmann tracks alone, no model of heat in it: batches, groups, the floor of a smooth fit,
log-sensitivities. All figures are of ln(width) and ln(depth), that is relative."""
import numpy as np
from scipy.linalg import inv, lstsq
from scipy.optimize import minimize
from scipy.stats import chi2, fisher_exact, t as student

from measured import conduction_range, hofmann

SURFACES = (0.0, 30e-6, 60e-6)
POWER, SPEED = 200.0, 0.8  # the middle of the settings, where the logarithms are zero


def of(surface, balling=False):
    return [t for t in hofmann() if t.powder == surface and (balling or not t.balling)]


def inputs(tracks):
    return np.log([t.power / POWER for t in tracks]), np.log([t.speed / SPEED for t in tracks])


def basis(tracks, order):
    """Columns of a polynomial of that order in ln P and ln v."""
    x, y = inputs(tracks)
    columns = [np.ones_like(x), x, y] + ([x * x, x * y, y * y] if order == 2 else [])
    return np.stack(columns, axis=1)


def shapes(tracks):
    return np.log([[t.width, t.depth] for t in tracks])


def fit(columns, values):
    return lstsq(columns, values)[0]


def left_out(columns, values):
    """Errors of a linear fit at each track when that track is left out."""
    hat = columns @ np.linalg.pinv(columns)
    return (values - hat @ values) / (1 - np.diag(hat))


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


class Process:
    """Gaussian process over ln P and ln v with a linear trend, a length for each, and a part that is not smooth."""

    def __init__(self, tracks, values):
        self.gaps = [(a[:, None] - a[None])**2 for a in inputs(tracks)]
        self.trend, self.values = basis(tracks, 1), values
        best = None
        for length in (0.22, 0.6, 1.3):
            for rest in (0.05, 0.15):
                found = minimize(self.cost, np.log([0.1, length, length, rest]), method="L-BFGS-B",
                                 bounds=np.log([(0.002, 3), (0.05, 8), (0.05, 8), (0.02, 1)]))
                best = found if best is None or found.fun < best.fun else best
        self.amplitude, self.length_power, self.length_speed, self.rest = np.exp(best.x)
        self.logs = best.x

    def covariance(self, logs):
        a, lp, lv, rest = np.exp(2 * logs)
        return a * np.exp(-(self.gaps[0] / lp + self.gaps[1] / lv) / 2) + rest * np.eye(len(self.values))

    def projected(self, logs):
        """Inverse covariance with the trend taken out, and the two determinants of the restricted likelihood."""
        k = self.covariance(logs)
        ki = inv(k)
        g = self.trend.T @ ki @ self.trend
        return ki - ki @ self.trend @ inv(g) @ self.trend.T @ ki, np.linalg.slogdet(k)[1] + np.linalg.slogdet(g)[1]

    def cost(self, logs):
        p, determinants = self.projected(logs)
        return (self.values @ p @ self.values + determinants) / 2

    def left_out(self):
        p, _ = self.projected(self.logs)
        return p @ self.values / np.diag(p)


def gaussian_likelihood(residuals):
    n, d = residuals.shape
    return -0.5 * n * (d * np.log(2 * np.pi) + np.linalg.slogdet(residuals.T @ residuals / n)[1] + d)


def two_groups(columns, values, random, starts):
    """One smooth function and a second one beside it at a constant offset: a mixture of two Gaussians about them with one
    covariance, by expectation and maximisation. Returns log-likelihood, share of each track in the second, offset,
    standard deviations."""
    n, d = values.shape
    both, twice = np.block([[columns, np.ones((n, 1))], [columns, np.zeros((n, 1))]]), np.tile(values, (2, 1))
    first = values - columns @ fit(columns, values)
    best = (-np.inf,)
    for _ in range(starts):
        along = first @ random.normal(size=d)
        share, before = 1 / (1 + np.exp(-3 * along / along.std())), -np.inf
        for _ in range(400):
            weight = np.r_[share, 1 - share]
            root = np.sqrt(weight)[:, None]
            b = fit(both * root, twice * root)
            r = twice - both @ b
            s = (r * weight[:, None]).T @ r / n
            if np.linalg.det(s) < 1e-7:  # a group of hardly more tracks than numbers: no likelihood
                break
            log = -0.5 * np.einsum("ij,jk,ik->i", r, inv(s), r) - 0.5 * np.linalg.slogdet(2 * np.pi * s)[1]
            second, one = log[:n] + np.log(share.mean() + 1e-300), log[n:] + np.log(1 - share.mean() + 1e-300)
            total = np.logaddexp(one, second)
            share = np.exp(second - total)
            if total.sum() - before < 1e-6:
                break
            before = total.sum()
        if before > best[0]:
            best = (before, share, b[-1], np.sqrt(np.diag(s)))
    return best


def groups_test(tracks, order, samples, seed=1):
    """Likelihood ratio of two groups against one smooth function, its parametric bootstrap, and who is in the second."""
    random = np.random.default_rng(seed)
    columns, values = basis(tracks, order), shapes(tracks)
    residuals = values - columns @ fit(columns, values)
    found = two_groups(columns, values, random, 20)
    ratio = 2 * (found[0] - gaussian_likelihood(residuals))
    spread = np.linalg.cholesky(residuals.T @ residuals / len(tracks))
    below = []
    for _ in range(samples):
        sample = columns @ fit(columns, values) + random.normal(size=values.shape) @ spread.T
        alone = gaussian_likelihood(sample - columns @ fit(columns, sample))
        below.append(2 * (two_groups(columns, sample, random, 6)[0] - alone))
    second, offset = found[1] > 0.5, found[2]
    if second.mean() > 0.5:  # which group is called the second is up to chance: the smaller one
        second, offset = ~second, -offset
    members = [t for t, inside in zip(tracks, second) if inside]
    inside = [[sum((t in members) == side and t.batch == batch for t in tracks) for side in (True, False)]
              for batch in ("fine", "coarse")]
    return {"n": len(tracks), "ratio": ratio, "bic": ratio - 3 * np.log(len(tracks)),
            "p": (1 + sum(b >= ratio for b in below)) / (samples + 1), "offset": offset.tolist(),
            "within": found[3].tolist(), "without": residuals.std(axis=0).tolist(), "share": len(members) / len(tracks),
            "members": [t.name for t in members], "batch_p": float(fisher_exact(inside)[1])}


def floor(tracks):
    """Relative rms error at a track left out: power law, log-quadratic, Gaussian process; per width, depth."""
    values = shapes(tracks)
    found = {"n": len(tracks)}
    for k, name in enumerate(("width", "depth")):
        process = Process(tracks, values[:, k])
        found[name] = {"power law": rms(left_out(basis(tracks, 1), values[:, k])),
                       "log-quadratic": rms(left_out(basis(tracks, 2), values[:, k])),
                       "Gaussian process": rms(process.left_out()), "not smooth": float(process.rest)}
    return found


def sensitivities(tracks, values=None):
    """d ln y / d ln P and d ln y / d ln v of a power law, with half the 95 % interval; per column of `values`."""
    columns, values = basis(tracks, 1), shapes(tracks) if values is None else values
    found = {}
    for k, name in enumerate(("width", "depth")):
        b = fit(columns, values[:, k])
        left = len(tracks) - 3
        variance = np.sum((values[:, k] - columns @ b)**2) / left
        half = student.ppf(0.975, left) * np.sqrt(variance * np.diag(inv(columns.T @ columns)))
        found[name] = {"power": (b[1], half[1]), "speed": (b[2], half[2])}
    return found


def repeats(surface):
    """Settings made more than once, neither track balling: pairs (fine, coarse), and whether any pair is of one batch."""
    by_setting = {}
    for t in of(surface):
        by_setting.setdefault((t.power, t.speed), []).append(t)
    return [sorted(group, key=lambda t: t.batch == "coarse") for group in by_setting.values() if len(group) > 1]


def batch_step(pairs, key):
    """Mean of ln(fine / coarse) over the pairs, half its 95 % interval, and the scatter of one track (relative standard
    deviation from the differences, their mean included) with its 95 % chi-square interval."""
    steps = np.array([np.log(getattr(a, key) / getattr(b, key)) for a, b in pairs])
    n = len(steps)
    half = student.ppf(0.975, n - 1) * steps.std(ddof=1) / np.sqrt(n)
    one = np.sum(steps**2) / 2
    return steps.mean(), half, np.sqrt(one / n), (np.sqrt(one / chi2.ppf(0.975, n)), np.sqrt(one / chi2.ppf(0.025, n)))


def batch_in_fit(tracks, key):
    """Step fine - coarse of ln(key) beside a log-quadratic fit, and half its 95 % interval."""
    values = np.log([getattr(t, key) for t in tracks])
    columns = np.c_[basis(tracks, 2), [t.batch == "fine" for t in tracks]]
    b = fit(columns, values)
    left = len(tracks) - columns.shape[1]
    variance = np.sum((values - columns @ b)**2) / left
    return b[-1], student.ppf(0.975, left) * np.sqrt(variance * inv(columns.T @ columns)[-1, -1])


def against_monotony(tracks, key, smallest=0.15):
    """Pairs in which less power at no less speed gave more: [(less, more, ln ratio)], largest first. Any function that does
    not fall with power nor rise with speed misses one of the two by at least half of ln ratio."""
    found = [(low, high, float(np.log(getattr(low, key) / getattr(high, key)))) for low in tracks for high in tracks
             if low.power <= high.power and low.speed >= high.speed]
    return sorted((f for f in found if f[2] > smallest), key=lambda f: -f[2])


def study(samples=400):
    bare = of(0.0)
    low = [t for t in bare if conduction_range(t)]
    result = {"batch_step": {}, "batch_in_fit": {}, "groups": {}, "floor": {}, "sensitivities": {}, "repeats": {}}
    for surface in SURFACES:
        name = f"{surface * 1e6:.0f}"
        tracks, pairs = of(surface), repeats(surface)
        result["repeats"][name] = [[(p.name, p.batch, p.power, p.speed) for p in pair] for pair in pairs]
        result["batch_step"][name] = {k: batch_step(pairs, k) for k in ("width", "depth", "area")}
        result["batch_in_fit"][name] = {k: batch_in_fit(tracks, k) for k in ("width", "depth", "area")}
        result["groups"][name] = groups_test(tracks, 2, samples)
        result["floor"][name] = floor(tracks)
    result["groups"]["conduction"] = groups_test(low, 1, samples)
    members = set(result["groups"]["0"]["members"])
    result["floor"]["conduction"] = floor(low)
    result["floor"]["0, first group"] = floor([t for t in bare if t.name not in members])
    for batch in ("fine", "coarse"):
        result["floor"][f"0, {batch}"] = floor([t for t in bare if t.batch == batch])
        result["floor"][f"conduction, {batch}"] = floor([t for t in low if t.batch == batch])
    result["sensitivities"] = {"conduction": sensitivities(low), "all bare": sensitivities(bare)}
    result["against_monotony"] = {k: [(a.name, b.name, r) for a, b, r in against_monotony(bare, k)]
                                  for k in ("width", "depth")}
    return result
