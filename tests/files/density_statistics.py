"""The statistics of examples/density against closed forms. Run: density_statistics.py FOLDER_OF_THE_EXAMPLE"""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(sys.argv[1])))
import eagar_tsai  # noqa: E402
import overlap  # noqa: E402
import roc  # noqa: E402


def near(found, wanted, error, what):
    if not abs(found - wanted) <= error:
        raise SystemExit(f"{what}: {found} where {wanted} +- {error} was due")


# Normal scores, one deviation apart: AUC = Phi(1 / sqrt 2).
rng = random.Random(3)
n = 1500
scores = [rng.gauss(0, 1) for _ in range(n)] + [rng.gauss(1, 1) for _ in range(n)]
outcomes = [False] * n + [True] * n
phi = 0.5 * (1 + math.erf(0.5))
near(roc.auc(scores, outcomes), phi, 4 * 0.5 / math.sqrt(n), "AUC of two normal distributions")
near(sum((x - u) * (y + v) / 2 for (u, v), (x, y) in zip(roc.curve(scores, outcomes), roc.curve(scores, outcomes)[1:])),
     roc.auc(scores, outcomes), 1e-12, "area under the curve's corners")
# The logit of such an outcome is x - 1/2.
intercept, slope = roc.logistic(scores, outcomes)
near(slope, 1, 0.15, "slope")
near(intercept, -0.5, 0.1, "intercept")
# By hand: 1 of 2 pairs won, one tie; infinity above all.
near(roc.auc([1, 2, 2], [True, True, False]), 0.25, 0, "a tie")
near(roc.auc([math.inf, 5, math.inf], [True, False, False]), 0.75, 0, "infinite scores")
# Shifts between groups make the pooled figure and leave the one within alone.
within = roc.auc_within([1, 2, 101, 102], [True, False, True, False], "aabb")
near(within, 0, 0, "AUC within groups")
near(roc.auc([1, 2, 101, 102], [True, False, True, False]), 0.25, 0, "AUC of the same, pooled")
near(roc.auc_within([3, 1, 2, 9, 0], [True, False, False, True, False], "aaabb"), 1, 0, "every pair of its group won")
# Groups of one kind each: within undefined, and the group left out knows all.
near(roc.auc(roc.left_out_share([True] * 4 + [False] * 4, "aaaabbbb"), [True] * 4 + [False] * 4), 1, 0, "group alone")
# Bootstrap over 60 alike groups: mean +- 1.96 sd / sqrt n.
values = [rng.gauss(5, 2) for _ in range(60)]
low, high = roc.bootstrap(lambda s, y, g: sum(s) / len(s), values, [True] * 60, list(range(60)))
mean = sum(values) / 60
sd = math.sqrt(sum((v - mean)**2 for v in values) / 60)
near(low, mean - 1.96 * sd / math.sqrt(60), 0.08, "lower end")
near(high, mean + 1.96 * sd / math.sqrt(60), 0.08, "upper end")
near(roc.rank_correlation([1, 2, 3, 4], [1, 4, 9, 16]), 1, 1e-12, "rank correlation")

# Eagar-Tsai: pool of an independent code, converged to 1e-4 um.
steel = eagar_tsai.Metal(24, 7300, 789, 1708, 298)
for found, wanted in zip(eagar_tsai.pool(steel, 60, 0.8, 80e-6), (102.0976e-6, 41.1274e-6, 302.5155e-6)):
    near(found, wanted, 2e-9, "Eagar-Tsai")

# Overlap: half an ellipse of every hatch and layer, and nothing left where pools meet at the layer's bottom.
near(overlap.unmelted(80e-6, 25e-6, 200e-6, 30e-6), 1 - math.pi * 80 * 25 / 4 / 6000, 1e-4, "separate pools")
near(overlap.unmelted(150e-6, 100e-6, 90e-6, 60e-6), 0, 0, "pools that join")
near(overlap.number(150e-6, 100e-6, 90e-6, 60e-6), 0.72, 1e-12, "Q")

# The program's own quadrature, in the table of a sweep, is another code.
for line in (pathlib.Path(sys.argv[1]) / "../../docs/density/window.csv").read_text().splitlines()[1:]:
    _, _, _, width, depth, q, density = map(float, line.split(","))
    near(overlap.number(width, depth, 130, 30), q, 1e-4 * q, "Q of the program")
    near(1 - overlap.unmelted(width, depth, 130, 30), density, 1e-4, "density of the program")
