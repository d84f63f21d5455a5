"""Settings of `layerloop melt` for a track on bare plate, and what comes back. SI."""
import math

import numpy as np

import eagar_tsai
from measured import Track

CASE = "plate.toml"
METALS = {"316L": eagar_tsai.STEEL_316L, "IN625": eagar_tsai.IN625}
CONDUCTION = {}  # further settings of the plain model: latent heat, k(T), radiation, evaporation
LONGEST = 350e-6  # vapour keeps pools below this, whatever the closed form says [m]


CONDUCTIVITY = {  # W/(m K) over K: points of the solid, points of the melt, as built in (docs/materials.md)
    "316L": ([[298, 13.93], [1000, 24.96], [1675, 27.5]], [[1708, 28], [2000, 32], [2800, 41]]),
    "IN625": ([[294, 9.8], [589, 14.1], [811, 17.5], [1033, 20.8], [1255, 25.2], [1563, 29.5]], [[1623, 30]])}


def mixing(factor, metal="316L"):
    """A melt that conducts `factor` times as well, the same in every direction: its flow as mixing (Lampa et al., Int. J.
    Heat Mass Transf. 40 (1997) 1239)."""
    solid, melt = CONDUCTIVITY[metal]
    return {f"material.{metal}.conductivity": str(solid + [[t, round(k * factor, 3)] for t, k in melt])}


def flow(lateral, vertical):
    """The effect marangoni: the melt conducts `lateral` times as well along the surface, `vertical` times downwards."""
    return {"effects.marangoni.enabled": "true", "effects.marangoni.lateral_factor": lateral,
            "effects.marangoni.vertical_factor": vertical}


def case(track, absorptivity, cell, more=None, metal="316L", spot=None):
    """(case file, settings) for one track; the track is as long as a pool that no longer changes needs."""
    spot = spot or track.spot
    length = min(eagar_tsai.pool(METALS[metal], absorptivity * track.power, track.speed, spot)[2], LONGEST)
    settings = {
        "powder.material": f'"{metal}"', "laser.power": track.power, "laser.spot_diameter": spot,
        "laser.absorptivity": round(absorptivity, 4), "scan.scan_speed": track.speed,
        "scan.track_length": round(2 * length + 4 * spot, 6), "heat.cell_size": cell, "optics.position_spacing": cell / 2}
    return CASE, {**settings, **(more or {})}


def size(summary):
    """Width, depth, length [m] of the pool; nan where nothing melted or the run was stopped by a guard."""
    if summary is None:
        return (math.nan,) * 3
    return tuple(summary["pool"][k] or math.nan for k in ("width", "depth", "length"))


class Surrogate:
    """Pool sizes of tracks over the absorptivity, straight in logarithms between true runs.

    What melts at a speed depends on the absorbed power alone, so tracks of one speed share their runs.
    tables: for each track ln(absorbed power), ascending, and ln(size), shape (powers, 3).
    """

    def __init__(self, tracks, tables):
        self.tracks, self.tables = tracks, tables

    def __call__(self, absorptivity):
        """(tracks, 3) of ln(size); nan outside the runs."""
        return np.array([[np.interp(np.log(absorptivity * t.power), x, y[:, k], left=np.nan, right=np.nan)
                          for k in range(3)] for t, (x, y) in zip(self.tracks, self.tables)])

    def wanted(self, row, k, measured):
        """Absorptivity that gives one measured size of one track; nan outside the runs."""
        x, y = self.tables[row]
        return float(np.exp(np.interp(np.log(measured), y[:, k], x, left=np.nan, right=np.nan))) / self.tracks[row].power

    def best(self, span):
        """One absorptivity for all tracks: least rms of ln(width), ln(depth) together. Returns it and the errors
        ln(computed / measured), shape (tracks, 2)."""
        measured = np.log([[t.width, t.depth] for t in self.tracks])
        scale = np.exp(np.linspace(*np.log(span), 300))
        errors = [self(a)[:, :2] - measured for a in scale]
        k = int(np.argmin([np.mean(e**2) if np.isfinite(e).all() else np.inf for e in errors]))
        return float(scale[k]), errors[k]


def powers(tracks, span, ratio=1.45):
    """{speed: absorbed powers [W]} a factor `ratio` apart or less, that hold all tracks between two absorptivities."""
    found = {}
    for speed in sorted({t.speed for t in tracks}):
        of_speed = [t.power for t in tracks if t.speed == speed]
        low, high = span[0] * min(of_speed) * 0.999, span[1] * max(of_speed) * 1.001
        found[speed] = np.geomspace(low, high, 1 + int(np.ceil(np.log(high / low) / np.log(ratio))))
    return found


def surrogate(melt, tracks, span, cell, more=None, metal="316L", spot=None):
    """Runs for all tracks between two absorptivities, `span`."""
    absorbed = powers(tracks, span)
    spot = spot or tracks[0].spot
    cases = [case(Track("", q / 0.5, speed, spot, 0, 0), 0.5, cell, more, metal) for speed in absorbed for q in absorbed[speed]]
    found = iter(melt(cases))
    tables = {speed: (np.log(absorbed[speed]), np.log([size(next(found)) for _ in absorbed[speed]])) for speed in absorbed}
    return Surrogate(tracks, [tables[t.speed] for t in tracks])


def closed_form(tracks, span, metal):
    """The same by Eagar and Tsai with constant properties."""
    absorbed = powers(tracks, span)
    tables = {speed: (np.log(absorbed[speed]), np.log([eagar_tsai.pool(metal, q, speed, tracks[0].spot)
                                                       for q in absorbed[speed]])) for speed in absorbed}
    return Surrogate(tracks, [tables[t.speed] for t in tracks])


def rms(values):
    return float(np.sqrt(np.nanmean(np.square(values))))
