"""316L discs of Trapp et al. 2017 from 48 to 356 W: absorptivity and depth from the keyhole, traced."""
from measured import trapp
from plate import case, mixing, size
from trapp import vapour_share

INDEX = "[3.905, 5.292]"  # n, k of iron times 1.319: absorbs 0.30 when flat, as these discs do below the keyhole
CELL = 5e-6
FACTOR = 2  # of the mixing of the melt, on powder
KEYHOLE = {"effects.keyhole.enabled": "true", "optics.refractive_index": INDEX, "optics.position_spacing": CELL,
           "optics.rays": 4000}


FACTORS = (1.5, 2)


def settings(track, more=None):
    """A plate that is deep enough for what was measured; no absorptivity is given, so that rays find it."""
    file, chosen = case(track, 0.30, CELL, {**KEYHOLE, **(more or {})})
    del chosen["laser.absorptivity"]
    depth = track.depth if track.depth == track.depth else 120e-6
    chosen["scan.track_length"] = 500e-6
    chosen["heat.size"] = [0.8e-3, 0.36e-3, round(max(1.6 * depth, 0.15e-3), 5)]
    return file, chosen


def row(track, summary):
    width, depth, length = size(summary)
    told = summary or {"absorptivity": None, "absorptivity_u_num": None, "regime": None}
    return {"power": track.power, "width": width, "depth": depth, "length": length, "absorptivity": told["absorptivity"],
            "u": told["absorptivity_u_num"], "regime": told["regime"], "vapour": vapour_share(summary) if summary else None,
            "measured": (track.width, track.depth, track.absorptivity)}


def study(melt):
    tracks = [t for t in trapp() if t.power >= 48]

    def rows(more):
        return [row(t, s) for t, s in zip(tracks, melt([settings(t, more) for t in tracks]))]

    return {"tracks": rows({}), "mixed": {f"{f:g}": rows(mixing(f)) for f in FACTORS}}
