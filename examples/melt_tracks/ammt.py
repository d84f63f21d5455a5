"""IN625, AM-Bench 2018-02, machine AMMT: one absorptivity for three tracks."""
import eagar_tsai
from measured import ammt, ammt_length
from plate import CONDUCTION, case, closed_form, mixing, rms, size, surrogate

SPAN = (0.24, 0.52)  # of the absorptivity
COARSE, FINE = 8e-6, 5.5e-6
MODELS = {"conduction": CONDUCTION,
          "conduction, no evaporation": {"effects.evaporation.enabled": "false"},
          **{f"melt mixed x {f:g}": mixing(f, "IN625") for f in (1.5, 2, 3, 5)}}


def judge(model, tracks):
    best, errors = model.best(SPAN)
    return {"absorptivity": best, "width rms": rms(errors[:, 0]), "depth rms": rms(errors[:, 1]), "rms": rms(errors),
            "errors": errors.tolist(),
            "wanted by width": [model.wanted(k, 0, t.width) for k, t in enumerate(tracks)],
            "wanted by depth": [model.wanted(k, 1, t.depth) for k, t in enumerate(tracks)],
            "wanted by length": [model.wanted(k, 2, ammt_length(t.name)[20]) for k, t in enumerate(tracks)]}


def study(melt):
    tracks = ammt()
    found = {"models": {}, "final": {}, "spot": {}}
    for name, more in MODELS.items():
        found["models"][name] = judge(surrogate(melt, tracks, SPAN, COARSE, more, "IN625"), tracks)
    for spot in (130e-6, 150e-6):
        found["spot"][f"{spot * 1e6:.0f}"] = judge(
            surrogate(melt, tracks, SPAN, COARSE, CONDUCTION, "IN625", spot), tracks)
    found["models"]["Eagar-Tsai, constant properties"] = judge(closed_form(tracks, SPAN, eagar_tsai.IN625), tracks)
    mixed = [name for name in MODELS if "mixed" in name]
    for name in ("conduction", min(mixed, key=lambda n: found["models"][n]["rms"])):
        a, more = found["models"][name]["absorptivity"], MODELS[name]
        found["final"][name] = {
            "absorptivity": a,
            "pools": {f"{cell * 1e6:g}": [size(s) for s in melt([case(t, a, cell, more, "IN625") for t in tracks])]
                      for cell in (COARSE, FINE)},
            "solidus": [size(s) for s in melt([case(t, a, COARSE, {**more, "heat.pool_isotherm": '"solidus"'}, "IN625")
                                               for t in tracks])]}
    found["measured"] = [(t.name, t.width, t.width_u, t.depth, t.depth_u) for t in tracks]
    found["length"] = {t.name: ammt_length(t.name) for t in tracks}
    return found
