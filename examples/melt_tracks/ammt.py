"""IN625, AM-Bench 2018-02, machine AMMT: one absorptivity for three tracks."""
import eagar_tsai
from measured import ammt, ammt_length
from plate import CONDUCTION, case, closed_form, flow, mixing, rms, size, surrogate

SPAN = (0.24, 0.52)  # of the absorptivity
COARSE, FINE = 8e-6, 5.5e-6
MODELS = {  # further settings, spot where it is not the one that was told
    "conduction": (CONDUCTION, None),
    "conduction, no evaporation": ({"effects.evaporation.enabled": "false"}, None),
    **{f"melt mixed x {f:g}": (mixing(f, "IN625"), None) for f in (1.5, 2, 3)},
    "melt mixed x 3 downwards": (flow(1, 3), None),
    **{f"conduction, spot {s * 1e6:.0f} um": (CONDUCTION, s) for s in (140e-6, 120e-6)}}


def judge(model, tracks):
    best, errors = model.best(SPAN)
    return {"absorptivity": best, "width rms": rms(errors[:, 0]), "depth rms": rms(errors[:, 1]), "rms": rms(errors),
            "errors": errors.tolist(),
            "wanted by width": [model.wanted(k, 0, t.width) for k, t in enumerate(tracks)],
            "wanted by depth": [model.wanted(k, 1, t.depth) for k, t in enumerate(tracks)],
            "wanted by length": [model.wanted(k, 2, ammt_length(t.name)[20]) for k, t in enumerate(tracks)]}


def study(melt):
    tracks = ammt()
    found = {"models": {}, "final": {}}
    for name, (more, spot) in MODELS.items():
        found["models"][name] = judge(surrogate(melt, tracks, SPAN, COARSE, more, "IN625", spot), tracks)
    found["models"]["Eagar-Tsai, constant properties"] = judge(closed_form(tracks, SPAN, eagar_tsai.IN625), tracks)
    mixed, narrow = (min((n for n in MODELS if word in n), key=lambda n: found["models"][n]["rms"])
                     for word in ("mixed", "spot"))
    for name in ("conduction", mixed, narrow):
        a, (more, spot) = found["models"][name]["absorptivity"], MODELS[name]

        def pools(cell, isotherm):
            told = {**more, "heat.pool_isotherm": isotherm}
            return [size(s) for s in melt([case(t, a, cell, told, "IN625", spot) for t in tracks])]

        found["final"][name] = {"absorptivity": a, "pools": {f"{c * 1e6:g}": pools(c, '"liquidus"') for c in (COARSE, FINE)},
                                "solidus": pools(COARSE, '"solidus"')}
    found["measured"] = [(t.name, t.width, t.width_u, t.depth, t.depth_u) for t in tracks]
    found["length"] = {t.name: ammt_length(t.name) for t in tracks}
    return found
