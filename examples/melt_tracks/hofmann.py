"""316L on bare plate, spot 80 um (Hofmann et al. 2025): one set of parameters for the tracks of the conduction range."""
import numpy as np

import eagar_tsai
import groups
from keyhole import KEYHOLE
from measured import FLAT_316L, conduction_range, hofmann
from plate import CONDUCTION, case, closed_form, flow, mixing, rms, size, surrogate

SPAN = (0.30, 0.52)  # of the absorptivity
CELL, FINE = 6.5e-6, 4.5e-6
MODELS = {"conduction": CONDUCTION, **{f"melt mixed x {f:g}": mixing(f) for f in (2, 3.5)},
          "melt mixed x 4 along the surface": flow(4, 1)}
TRACED = {"keyhole, traced": {}, "keyhole, traced, melt mixed x 2": mixing(2)}
SPOT = 100e-6  # what if the beam were wider


def judge(model, tracks):
    best, errors = model.best(SPAN)
    return {"absorptivity": best, **figures(tracks, errors)}


def traced(melt, tracks, more):
    """No absorptivity at all: rays find it on the depressed surface, which absorbs 0.30 where it is flat."""
    cases = []
    for t in tracks:
        file, chosen = case(t, FLAT_316L, CELL, {**KEYHOLE, **more, "optics.position_spacing": CELL})
        del chosen["laser.absorptivity"]
        cases.append((file, chosen))
    found = melt(cases)
    errors = np.log([size(s)[:2] for s in found]) - np.log([[t.width, t.depth] for t in tracks])
    return {"absorptivity": float(np.mean([s["absorptivity"] for s in found if s])), **figures(tracks, errors)}


def figures(tracks, errors):
    computed = errors + np.log([[t.width, t.depth] for t in tracks])
    return {"rms": rms(errors), "width rms": rms(errors[:, 0]), "depth rms": rms(errors[:, 1]),
            "mean": errors.mean(axis=0).tolist(), "scatter": errors.std(axis=0, ddof=1).tolist(),
            "errors": errors.tolist(),
            "by batch": {b: errors[[t.batch == b for t in tracks]].mean(axis=0).tolist() for b in ("fine", "coarse")},
            "sensitivities": groups.sensitivities(tracks, computed) if np.isfinite(computed).all() else None}


def study(melt):
    tracks = sorted((t for t in hofmann() if t.powder == 0 and not t.balling and conduction_range(t)),
                    key=lambda t: (t.speed, t.power))
    found = {"tracks": [(t.name, t.power, t.speed, t.width, t.depth, t.batch) for t in tracks], "models": {}}
    jobs = {**{name: (more, None) for name, more in MODELS.items()},
            "conduction, spot 100 um": (CONDUCTION, SPOT), "melt mixed x 2, spot 100 um": (mixing(2), SPOT)}
    for name, (more, spot) in jobs.items():
        found["models"][name] = judge(surrogate(melt, tracks, SPAN, CELL, more, spot=spot), tracks)
    for name, more in TRACED.items():
        found["models"][name] = traced(melt, tracks, more)
    closed = closed_form(tracks, SPAN, eagar_tsai.STEEL_316L)
    found["models"]["Eagar-Tsai, constant properties"] = judge(closed, tracks)
    best = min((n for n in MODELS if "mixed" in n), key=lambda n: found["models"][n]["rms"])
    found["best"], found["final"] = best, {}
    for name in ("conduction", best):
        a = found["models"][name]["absorptivity"]
        some = tracks[::4]
        found["final"][name] = {f"{cell * 1e6:g}": [size(s) for s in melt([case(t, a, cell, MODELS[name]) for t in some])]
                                for cell in (CELL, FINE)}
    return found
