"""How pools that are half ellipses join: Tang, Pistorius & Beuth, Addit. Manuf. 14 (2017) 39; and what they leave, with
tracks turned from layer to layer (coupling/pool_overlap.hpp says how). Depth below the top of the layer, once solid."""
import math


def number(width, depth, hatch, layer):
    """Q; at most 1 where nothing stays unmelted, infinite without a pool."""
    return (hatch / width)**2 + (layer / depth)**2 if width > 0 and depth > 0 else math.inf


def unmelted(width, depth, hatch, layer, steps=4000):
    """Share of the cross-section that no pool reaches; midpoint rule over the layer."""
    q = number(width, depth, hatch, layer)
    if q <= 1 or math.isinf(q):
        return float(q > 1)

    def left(s):
        share = 1.0
        while s < depth and share > 0:
            share *= max(0.0, 1 - width / hatch * math.sqrt(1 - (s / depth)**2))
            s += layer
        return share

    return sum(left((k + 0.5) / steps * layer) for k in range(steps)) / steps
