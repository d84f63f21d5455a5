"""Settings of `layerloop melt` for a track on bare plate, and what comes back. SI."""
import math

import numpy as np

import eagar_tsai

CASE = "plate.toml"
METALS = {"316L": eagar_tsai.STEEL_316L, "IN625": eagar_tsai.IN625}
CONDUCTION = {}  # further settings of the plain model: latent heat, k(T), radiation, evaporation
ISOTHERMS = ("liquidus", "solidus")


def mixing(lateral, vertical=None):
    """The effect marangoni: conductivity of the melt times `lateral` along the surface, `vertical` down (the same)."""
    return {"effects.marangoni.enabled": "true", "effects.marangoni.lateral_factor": lateral,
            "effects.marangoni.vertical_factor": lateral if vertical is None else vertical}


def conductivity(metal_table, liquidus, factor):
    """A conductivity table with its liquid part times `factor`, as text."""
    return str([[t, k * (factor if t >= liquidus else 1)] for t, k in metal_table])


def case(track, absorptivity, cell, more=None, metal="316L", spot=None):
    """(case file, settings) for one track; the track is as long as a pool that no longer changes needs."""
    spot = spot or track.spot
    length = eagar_tsai.pool(METALS[metal], min(absorptivity, 0.5) * track.power, track.speed, spot)[2]
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
    """Pool sizes over absorptivity, straight in logarithms between true runs. Shapes: sizes (tracks, absorptivities, 3)."""

    def __init__(self, absorptivities, sizes):
        self.logs, self.sizes = np.log(absorptivities), np.log(sizes)

    def __call__(self, absorptivity):
        """(tracks, 3) of ln(size)."""
        x = np.log(absorptivity)
        return np.array([[np.interp(x, self.logs, row[:, k], left=np.nan, right=np.nan) for k in range(3)]
                         for row in self.sizes])

    def wanted(self, track, k, measured):
        """Absorptivity that gives one measured size of one track; nan outside the runs."""
        row = self.sizes[track, :, k]
        return float(np.exp(np.interp(np.log(measured), row, self.logs, left=np.nan, right=np.nan)))

    def best(self, measured):
        """One absorptivity for all tracks: least rms of ln(width), ln(depth) together. Returns it and the errors
        ln(computed / measured), shape (tracks, 2)."""
        scale = np.exp(np.linspace(self.logs[0], self.logs[-1], 400))
        errors = [self(a)[:, :2] - np.log(measured) for a in scale]
        k = int(np.argmin([np.mean(e**2) if np.isfinite(e).all() else np.inf for e in errors]))
        return float(scale[k]), errors[k]


def surrogate(melt, tracks, absorptivities, cell, more=None, metal="316L", spot=None):
    cases = [case(t, a, cell, more, metal, spot) for t in tracks for a in absorptivities]
    found = np.array([size(s) for s in melt(cases)]).reshape(len(tracks), len(absorptivities), 3)
    return Surrogate(absorptivities, found)


def rms(values):
    return float(np.sqrt(np.nanmean(np.square(values))))
