"""Discrimination and calibration of a score against an outcome, over groups. Scores may be infinite; ties count half."""
import math
import random
from collections import defaultdict


def wins(scores, outcomes):
    """Pairs of one with and one without the outcome in which the first scores higher, and the number of such pairs."""
    with_it = [s for s, y in zip(scores, outcomes) if y]
    without = [s for s, y in zip(scores, outcomes) if not y]
    return sum((a > b) + 0.5 * (a == b) for a in with_it for b in without), len(with_it) * len(without)


def auc(scores, outcomes):
    """Area under the ROC curve, the probability that a row with the outcome scores higher than one without (Mann and
    Whitney); nan where there is no pair."""
    won, pairs = wins(scores, outcomes)
    return won / pairs if pairs else math.nan


def by_group(scores, outcomes, groups):
    """{group: (scores, outcomes)}"""
    found = defaultdict(lambda: ([], []))
    for s, y, g in zip(scores, outcomes, groups):
        found[g][0].append(s)
        found[g][1].append(y)
    return dict(found)


def auc_within(scores, outcomes, groups):
    """The same over pairs of one group alone, every pair counted once."""
    counted = [wins(*part) for part in by_group(scores, outcomes, groups).values()]
    pairs = sum(n for _, n in counted)
    return sum(won for won, _ in counted) / pairs if pairs else math.nan


def curve(scores, outcomes):
    """Corners of the ROC curve: (false positive rate, true positive rate) as the threshold falls."""
    positive, points = sum(outcomes), [(0.0, 0.0)]
    for threshold in sorted(set(scores), reverse=True):
        called = [y for s, y in zip(scores, outcomes) if s >= threshold]
        points.append(((len(called) - sum(called)) / (len(outcomes) - positive), sum(called) / positive))
    return points


def bootstrap(statistic, scores, outcomes, groups, samples=2000, seed=1):
    """95 % percentile interval of statistic(scores, outcomes, groups) when whole groups are drawn anew. A group that is
    drawn twice counts as two."""
    parts, rng, found = list(by_group(scores, outcomes, groups).values()), random.Random(seed), []
    for _ in range(samples):
        drawn = [rng.randrange(len(parts)) for _ in parts]
        s = [v for k in drawn for v in parts[k][0]]
        y = [v for k in drawn for v in parts[k][1]]
        value = statistic(s, y, [n for n, k in enumerate(drawn) for _ in parts[k][0]])
        if math.isfinite(value):
            found.append(value)
    found.sort()
    return found[int(0.025 * len(found))], found[int(math.ceil(0.975 * len(found))) - 1]


def left_out_share(outcomes, groups):
    """Score that knows nothing but the group: the share with the outcome among its other rows; 1/2 where there is none."""
    total, number = defaultdict(int), defaultdict(int)
    for y, g in zip(outcomes, groups):
        total[g] += y
        number[g] += 1
    return [(total[g] - y) / (number[g] - 1) if number[g] > 1 else 0.5 for y, g in zip(outcomes, groups)]


def logistic(x, outcomes):
    """Intercept and slope of logit P(outcome) over x, by maximum likelihood (Newton); nan where the outcome splits x."""
    a = b = 0.0
    for _ in range(50):
        p = [1 / (1 + math.exp(-max(-700.0, min(700.0, a + b * v)))) for v in x]
        w = [q * (1 - q) for q in p]
        ga, gb = sum(y - q for y, q in zip(outcomes, p)), sum((y - q) * v for y, q, v in zip(outcomes, p, x))
        haa, hab, hbb = sum(w), sum(u * v for u, v in zip(w, x)), sum(u * v * v for u, v in zip(w, x))
        det = haa * hbb - hab * hab
        if not det > 1e-12 * max(haa * hbb, 1e-300) or abs(b) > 1e3:
            return math.nan, math.nan
        da, db = (hbb * ga - hab * gb) / det, (haa * gb - hab * ga) / det
        a, b = a + da, b + db
        if abs(da) + abs(db) < 1e-10 * (1 + abs(a) + abs(b)):
            break
    return a, b


def rank_correlation(x, y):
    """Spearman's, ties sharing their mean rank."""
    def ranks(values):
        order = sorted(range(len(values)), key=lambda k: values[k])
        rank, k = [0.0] * len(values), 0
        while k < len(order):
            last = k
            while last + 1 < len(order) and values[order[last + 1]] == values[order[k]]:
                last += 1
            for m in range(k, last + 1):
                rank[order[m]] = 0.5 * (k + last)
            k = last + 1
        return rank

    u, v = ranks(x), ranks(y)
    mu, mv = sum(u) / len(u), sum(v) / len(v)
    suu, svv = sum((p - mu)**2 for p in u), sum((q - mv)**2 for q in v)
    return sum((p - mu) * (q - mv) for p, q in zip(u, v)) / math.sqrt(suu * svv) if suu and svv else math.nan
