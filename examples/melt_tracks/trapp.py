"""316L discs of Trapp et al. 2017 below the keyhole, with the absorptivity that was measured on the same tracks."""
import eagar_tsai
from measured import trapp
from plate import case, mixing, size

POWERS = (32, 48, 65)
CELLS = (5e-6, 3.75e-6, 2.5e-6)
COMPARED = 3.75e-6  # cell of the variants; their differences count, not their values
VARIANTS = {
    "pool at the solidus": {"heat.pool_isotherm": '"solidus"'},
    "spot 55 um": {"laser.spot_diameter": 55e-6}, "spot 65 um": {"laser.spot_diameter": 65e-6},
    "k of the melt x 0.7": mixing(0.7),
    "k of the melt x 1.3": mixing(1.3),
    "no evaporation": {"effects.evaporation.enabled": "false"},
    "density 7300 kg/m3": {"material.316L.density": 7300},
    **{f"melt mixed x {f:g}": mixing(f) for f in (2, 3)}}


def study(melt):
    tracks = [t for t in trapp() if t.power in POWERS]

    def pools(cell, more=None, absorptivity=None):
        values = absorptivity or [t.absorptivity for t in tracks]
        return melt([case(t, a, cell, more) for t, a in zip(tracks, values)])

    found = {"measured": [(t.name, t.width, t.depth, t.absorptivity) for t in tracks],
             "cells": {f"{cell * 1e6:g}": [size(s) for s in pools(cell)] for cell in CELLS},
             "variants": {name: [size(s) for s in pools(COMPARED, more)] for name, more in VARIANTS.items()}}
    found["peak"] = [s["peak_temperature"] for s in pools(COMPARED)]
    found["vapour"] = [vapour_share(s) for s in pools(COMPARED)]
    net = [t.absorptivity for t in tracks]
    for _ in range(3):  # the calorimeter sees what stays in the disc: absorb more, until that is what was measured
        stays = [1 - vapour_share(s) for s in pools(COMPARED, None, net)]
        net = [round(t.absorptivity / share, 3) for t, share in zip(tracks, stays)]
    found["net absorptivity"] = net
    found["variants"]["absorptivity net of vapour"] = [size(s) for s in pools(COMPARED, None, net)]
    for k in (20, 24):
        metal = eagar_tsai.Metal(k, 7300, 789, 1708)
        found["variants"][f"Eagar-Tsai, k = {k}"] = [eagar_tsai.pool(metal, t.absorptivity * t.power, t.speed, t.spot)
                                                     for t in tracks]
    return found


def vapour_share(summary):
    """Of the absorbed heat, what left with the vapour."""
    return summary["ledger"]["heat_evaporated"] / summary["ledger"]["heat_in"]
