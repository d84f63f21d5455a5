"""316L discs of Trapp et al. 2017 from 48 to 356 W: absorptivity and depth from the keyhole, traced."""
from measured import trapp
from plate import case, size

INDEX = "[3.905, 5.292]"  # n, k of iron times 1.319: absorbs 0.30 when flat, as these discs do below the keyhole
CELL = 5e-6
KEYHOLE = {"effects.keyhole.enabled": "true", "optics.refractive_index": INDEX, "optics.position_spacing": CELL,
           "optics.rays": 4000}


def settings(track):
    """A plate that is deep enough for what was measured; no absorptivity is given, so that rays find it."""
    file, chosen = case(track, 0.30, CELL, KEYHOLE)
    del chosen["laser.absorptivity"]
    depth = track.depth if track.depth == track.depth else 120e-6
    chosen["scan.track_length"] = 500e-6
    chosen["heat.size"] = [0.8e-3, 0.36e-3, round(max(1.6 * depth, 0.15e-3), 5)]
    return file, chosen


def study(melt):
    tracks = [t for t in trapp() if t.power >= 48]
    found = []
    for track, summary in zip(tracks, melt([settings(t) for t in tracks])):
        width, depth, length = size(summary)
        found.append({"power": track.power, "width": width, "depth": depth, "length": length,
                      "absorptivity": summary and summary["absorptivity"], "u": summary and summary["absorptivity_u_num"],
                      "regime": summary and summary["regime"],
                      "measured": (track.width, track.depth, track.absorptivity)})
    return {"tracks": found}
