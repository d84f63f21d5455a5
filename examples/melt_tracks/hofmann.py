"""316L on bare plate, spot 80 um (Hofmann et al. 2025): one set of parameters for the tracks of the conduction range."""
import numpy as np

import eagar_tsai
import groups
from measured import FLAT_316L, conduction_range, hofmann
from plate import CONDUCTION, Surrogate, case, mixing, rms, size, surrogate

ABSORPTIVITIES = (0.26, 0.32, 0.39, 0.48, 0.59)
CELL, FINE = 5e-6, 3.5e-6
MODELS = {"conduction": CONDUCTION,
          "conduction, no evaporation": {"effects.evaporation.enabled": "false"},
          **{f"melt mixed x {f:g}": mixing(f) for f in (1.5, 2, 3, 5)},
          **{f"melt mixed x {f:g} along the surface": mixing(f, 1) for f in (2, 4)},
          **{f"melt mixed x {f:g} downwards": mixing(1, f) for f in (2, 4)}}
SPOTS = (100e-6, 120e-6)


def settings_of(tracks):
    """One track of each setting: tracks that share one share its run."""
    return list({(t.power, t.speed): t for t in tracks}.values())


def spread(model, once, tracks):
    """A surrogate over settings as one over tracks."""
    places = [next(k for k, t in enumerate(once) if (t.power, t.speed) == (track.power, track.speed)) for track in tracks]
    return Surrogate(np.exp(model.logs), np.exp(model.sizes[places]))


def judge(model, tracks):
    measured = np.array([[t.width, t.depth] for t in tracks])
    best, errors = model.best(measured)
    at_flat = model(FLAT_316L)[:, :2] - np.log(measured)
    computed = model(best)[:, :2]
    return {"absorptivity": best, "rms": rms(errors), "width rms": rms(errors[:, 0]), "depth rms": rms(errors[:, 1]),
            "mean": errors.mean(axis=0).tolist(), "scatter": errors.std(axis=0, ddof=1).tolist(),
            "mean at 0.30": at_flat.mean(axis=0).tolist(), "errors": errors.tolist(),
            "by batch": {b: errors[[t.batch == b for t in tracks]].mean(axis=0).tolist() for b in ("fine", "coarse")},
            "sensitivities": groups.sensitivities(tracks, computed) if np.isfinite(computed).all() else None}


def study(melt):
    tracks = sorted((t for t in hofmann() if t.powder == 0 and not t.balling and conduction_range(t)),
                    key=lambda t: (t.speed, t.power))
    once = settings_of(tracks)
    found = {"tracks": [(t.name, t.power, t.speed, t.width, t.depth, t.batch) for t in tracks], "models": {}}
    jobs = {**{name: (more, None) for name, more in MODELS.items()},
            **{f"conduction, spot {s * 1e6:.0f} um": (CONDUCTION, s) for s in SPOTS},
            "melt mixed x 3, spot 100 um": (mixing(3), 100e-6)}
    for name, (more, spot) in jobs.items():
        model = surrogate(melt, once, ABSORPTIVITIES, CELL, more, spot=spot)
        found["models"][name] = judge(spread(model, once, tracks), tracks)
    closed = [[eagar_tsai.pool(eagar_tsai.STEEL_316L, a * t.power, t.speed, t.spot) for a in ABSORPTIVITIES] for t in tracks]
    found["models"]["Eagar-Tsai, constant properties"] = judge(Surrogate(ABSORPTIVITIES, closed), tracks)
    best = min((n for n in MODELS if "mixed" in n), key=lambda n: found["models"][n]["rms"])
    found["best"], found["final"] = best, {}
    for name in ("conduction", best):
        a = found["models"][name]["absorptivity"]
        found["final"][name] = {f"{cell * 1e6:g}": [size(s) for s in melt([case(t, a, cell, MODELS[name]) for t in tracks])]
                                for cell in (CELL, FINE)}
    return found
