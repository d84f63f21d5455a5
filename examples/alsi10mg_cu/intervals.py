"""Means, differences and slopes with 95 % intervals over seeds. A seed has the same feed in every setting, so settings are
compared within it: the comparison is made for each seed and its scatter over the seeds counts."""
import math

# Student's t for 95 %, two sides, by degrees of freedom.
T = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262}


def mean_u(values):
    """Mean, and half the 95 % interval (nan of one value)."""
    n = len(values)
    mean = sum(values) / n
    if n < 2:
        return mean, math.nan
    s = math.sqrt(sum((v - mean) ** 2 for v in values) / (n - 1))
    return mean, T.get(n - 1, 2.2) * s / math.sqrt(n)


def slope(points):
    """Least squares of y on x; points: [(x, y), ...]."""
    xm = sum(x for x, _ in points) / len(points)
    ym = sum(y for _, y in points) / len(points)
    return sum((x - xm) * (y - ym) for x, y in points) / sum((x - xm) ** 2 for x, _ in points)


def by_seed(rows, figure):
    """figure(rows of one seed) over the seeds: mean and half the 95 % interval."""
    return mean_u([figure([r for r in rows if r["seed"] == s]) for s in sorted({r["seed"] for r in rows})])


def verdict(value_u, sign):
    """Whether a trend has the sign that is expected (0: none)."""
    value, u = value_u
    if u != u:
        return "one seed"
    if sign == 0:
        return "not excluded" if abs(value) <= u else "**no**"
    if abs(value) <= u:
        return "not resolved"
    return "yes" if value * sign > 0 else "**no, the opposite**"


def told(value_u, digits=3):
    value, u = value_u
    return f"{value:.{digits}f} ± {u:.{digits}f}"


def table(head, rows):
    return "\n".join("| " + " | ".join(map(str, r)) + " |" for r in [head, ["---"] * len(head), *rows])


def regression(rows, key, inputs):
    """Least squares of key on the inputs [(name, scale), ...], a constant for each seed beside them: the change of key for a
    scale of each input, with half its 95 % interval from the scatter about the fit."""
    seeds = sorted({r["seed"] for r in rows})
    design = [[r[name] / scale for name, scale in inputs] + [float(r["seed"] == s) for s in seeds] for r in rows]
    n = len(design[0])
    normal = [[sum(d[i] * d[j] for d in design) for j in range(n)] for i in range(n)]
    inverse = invert(normal)
    right = [sum(d[i] * r[key] for d, r in zip(design, rows)) for i in range(n)]
    found = [sum(inverse[i][j] * right[j] for j in range(n)) for i in range(n)]
    freedom = len(rows) - n
    if freedom < 1:
        return [(f, math.nan) for f in found[:len(inputs)]]
    scatter = sum((r[key] - sum(a * b for a, b in zip(d, found))) ** 2 for d, r in zip(design, rows)) / freedom
    t = T.get(freedom, 2.2 if freedom < 15 else 2.05)
    return [(found[i], t * math.sqrt(scatter * inverse[i][i])) for i in range(len(inputs))]


def invert(matrix):
    """Gauss and Jordan, with pivots."""
    n = len(matrix)
    rows = [list(row) + [float(i == j) for j in range(n)] for i, row in enumerate(matrix)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for k in range(n):
            if k != i:
                rows[k] = [a - rows[k][i] * b for a, b in zip(rows[k], rows[i])]
    return [row[n:] for row in rows]
