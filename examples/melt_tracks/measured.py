"""The measured tracks, in SI; where they come from: data/README.md."""
import csv
import math
import pathlib
from dataclasses import dataclass

import eagar_tsai

DATA = pathlib.Path(__file__).parent / "data"
KEYHOLE_BEGINS = 26 / 2**1.5  # normalised enthalpy, lower end of King et al.'s 30 +- 4, for the 1/e2 radius as length
FLAT_316L = 0.30  # absorptivity of 316L that does not boil (Trapp et al.: 0.26 to 0.31), to sort tracks by their inputs


@dataclass
class Track:
    name: str
    power: float  # incident [W]
    speed: float  # [m/s]
    spot: float  # 1/e2 diameter [m]
    width: float  # [m]
    depth: float  # below the plate's surface [m]; nan: not measured
    width_u: float = 0.0  # standard uncertainty [m]
    depth_u: float = 0.0
    powder: float = 0.0  # thickness of the layer [m]
    area: float = math.nan  # molten, across the track [m2]
    balling: bool = False
    batch: str = ""
    absorptivity: float = math.nan  # measured on the same track


def rows(name):
    with open(DATA / name) as file:
        return list(csv.DictReader(file))


def hofmann():
    """316L, spot 80 um. `batch`: "fine" where a row has lengths to 0.001 um, "coarse" where to 0.1 um."""
    tracks = []
    for row in rows("hofmann_316l_spot80.csv"):
        lengths = [row[k] for k in ("weld_width_um", "penetration_depth_um", "molten_area_um2")]
        decimals = max(len(text.partition(".")[2]) for text in lengths)
        w, d, a = (float(text) for text in lengths)
        tracks.append(Track(row["index"], float(row["P_laser_W"]), float(row["v_scan_mm_s"]) / 1e3,
                            float(row["d_laser_mm"]) / 1e3, w / 1e6, d / 1e6, powder=float(row["t_powder_um"]) / 1e6,
                            area=a / 1e12, balling=row["balling"] == "1", batch="fine" if decimals > 1 else "coarse"))
    return tracks


def trapp():
    """316L disc, 500 mm/s; absorptivity of the calorimetry, the mean of what was measured within 2 W."""
    heat = [(float(r["power_W"]), float(r["absorptivity"])) for r in rows("trapp2017_absorptivity_digitized.csv")
            if r["surface"] == "316L-disc" and r["speed_mm_s"] == "500"]
    tracks = []
    for row in rows("trapp2017_316l_tracks_digitized.csv"):
        power = float(row["power_W"])
        near = [a for p, a in heat if abs(p - power) <= 2]
        tracks.append(Track(f"{power:.0f} W", power, 0.5, 60e-6, float(row["width_um"]) / 1e6,
                            float(row["depth_um"] or "nan") / 1e6, 3e-6, 3e-6, absorptivity=sum(near) / len(near)))
    return tracks


def ammt():
    """IN625, AM-Bench 2018-02: means over the tracks of a case; u: standard error of the mean over tracks (t intervals
    would be 2 to 4 times that), not below a pixel's 0.5 um."""
    tracks = []
    for case in "ABC":
        of_case = [r for r in rows("lane_in625_ambench2018-02_ammt.csv") if r["case"] == case]

        def mean(key):
            values = [float(r[key]) / 1e6 for r in of_case]
            m = sum(values) / len(values)
            sd = math.sqrt(sum((v - m)**2 for v in values) / (len(values) - 1))
            return m, max(sd / math.sqrt(len(values)), 0.5e-6)

        (w, wu), (d, du) = mean("width_mean_um"), mean("depth_mean_um")
        row = of_case[0]
        tracks.append(Track(case, float(row["power_W"]), float(row["speed_mm_s"]) / 1e3, float(row["d4sigma_um"]) / 1e6,
                            w, d, wu, du))
    return tracks


def ammt_length(case):
    """Mean length of the 1290 C isotherm [m] by the camera's integration time."""
    found = {}
    for r in rows("lane_in625_ambench2018-02_ammt.csv"):
        if r["case"] == case:
            found.setdefault(int(r["integration_time_us"]), []).append(float(r["length_mean_um"]) / 1e6)
    return {time: sum(v) / len(v) for time, v in sorted(found.items())}


def enthalpy(track):
    return eagar_tsai.normalised_enthalpy(eagar_tsai.STEEL_316L, FLAT_316L * track.power, track.speed, track.spot)


def conduction_range(track):
    """Chosen by inputs alone: below the keyhole range by normalised enthalpy."""
    return enthalpy(track) < KEYHOLE_BEGINS
