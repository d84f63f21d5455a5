#!/usr/bin/env python3
"""Tracks on a bare plate from another heat solution than layerloop's, as study folders.

Explicit finite differences for the enthalpy of a half plate (mirror plane under the beam) on a uniform grid of nodes,
in numpy; the liquidus isotherm is found between nodes. What layerloop does differently: cells, super time steps,
treatment of the far field. Properties of 316L are those of the case (one powder, one alloy: the same metal).
  heat.py FOLDER          writes FOLDER/heat_null, heat_flow, heat_latent, heat_conductivity, heat_evaporation,
                          heat_absorptivity
"""
import sys

import numpy as np

import study_folder

AMBIENT, SOLIDUS, LIQUIDUS, BOILING = 300.0, 1675.0, 1708.0, 3090.0
DENSITY, LATENT = 7904.0, 264e3
K = np.array([[298, 13.93], [1000, 24.96], [1675, 27.5], [1708, 28], [2000, 32], [2800, 41]])
C = np.array([[298, 502], [500, 531], [1250, 638], [1300, 590], [1350, 640], [1450, 700], [1675, 714], [1708, 847],
              [2900, 847]])

CASE = """# 316L tracks on a bare plate; absorptivity as a number.
[case]
name = "tracks of another heat solution"
[powder]
material = "316L"
[laser]
power = "80 W"
wavelength = "1070 nm"
spot_diameter = "100 um"
spot_definition = "1/e2"
absorptivity = 0.35
[scan]
kind = "track"
scan_speed = "0.8 m/s"
track_length = "240 um"
[heat]
cell_size = "5 um"
{extra}"""

CALIBRATION = '[[calibration]]\nkey = "laser.absorptivity"\nmean = 0.35\nsd = 0.03\n'
CONDITIONS = [(55, 0.4, 100), (70, 0.4, 100), (70, 0.8, 100), (85, 0.8, 100), (100, 0.8, 100), (90, 1.2, 100),
              (110, 1.2, 100), (45, 0.5, 70), (55, 1.0, 70), (90, 0.4, 130), (120, 0.8, 130)]
HOLDOUT = ("t04", "t07", "t08")


class Metal:
    """Enthalpy over temperature, as a table."""

    def __init__(self, latent=1.0, constant_k=False):
        self.T = np.arange(250.0, 12001.0, 1.0)
        c = np.interp(self.T, C[:, 0], C[:, 1])
        melt = np.clip((self.T - SOLIDUS) / (LIQUIDUS - SOLIDUS), 0, 1)
        self.h = DENSITY * (np.concatenate([[0], np.cumsum(0.5 * (c[1:] + c[:-1]))]) + latent * LATENT * melt)
        self.constant_k = constant_k

        # back to temperatures in even steps of enthalpy, so that looking up is a division
        self.step = 2e6
        self.of_step = np.interp(self.h[0] + self.step * np.arange(int(self.h[-1] / self.step)), self.h, self.T)

    def temperature(self, h):
        at = (h - self.h[0]) / self.step
        below = at.astype(np.int64)
        return self.of_step[below] + (at - below) * (self.of_step[below + 1] - self.of_step[below])

    def conductivity(self, T):
        return np.full_like(T, 27.5) if self.constant_k else np.interp(T, K[:, 0], K[:, 1])


def evaporation_flux(T):
    """Hertz-Knudsen with a sticking share of 0.82 and Clausius-Clapeyron through the boiling point [W/m^2]."""
    L, M, R = 7.41e6, 0.0558, 8.314462618
    p = 101325 * np.exp(np.minimum(L * M / R * (1 / BOILING - 1 / np.maximum(T, 1000)), 20))
    return np.where(T > SOLIDUS, 0.82 * L * p * np.sqrt(M / (2 * np.pi * R * np.maximum(T, 1000))), 0)


def track(power, speed, spot, absorptivity=0.35, flow=0.0, latent=1.0, constant_k=False, evaporates=False, h=5e-6):
    """Width and depth of the liquidus isotherm in the middle of a track [m].

    flow: conductivity of the liquid along the plate grows by this factor for every 1000 K above the liquidus, the form
    that Marangoni flow driven by the difference in temperature has (layerloop's effect is a constant factor)."""
    metal, length, ambient = Metal(latent, constant_k), 240e-6, AMBIENT
    x = np.arange(-110e-6, length + 70e-6, h)
    y, z = np.arange(0, 150e-6, h), np.arange(0, 110e-6, h)
    T = np.full((len(x), len(y), len(z)), ambient)
    H = np.full_like(T, np.interp(ambient, metal.T, metal.h))
    highest = T.copy()
    w, time = 0.5 * spot, 0.0
    half_top = np.full((1, 1, len(z)), h)
    half_top[..., 0] = 0.5 * h  # the top nodes stand for half a cell
    # error function integrates the beam over the cell of a node
    from scipy.special import erf
    share_y = 0.5 * (erf(np.sqrt(2) * (y + h / 2) / w) - erf(np.sqrt(2) * (y - h / 2) / w))
    dt = 0.15 * h * h * DENSITY * 650 / 41.0 / (1 + 0.5 * flow)
    end = length / speed + 30e-6 / speed
    while time < end:
        k = metal.conductivity(T)
        if flow:
            k_xy = k * (1 + flow * np.clip(T - LIQUIDUS, 0, 2000) / 1000)
        else:
            k_xy = k
        q = np.zeros_like(T)
        qx = 0.5 * (k_xy[1:] + k_xy[:-1]) * (T[1:] - T[:-1]) / h
        q[:-1] += qx / h
        q[1:] -= qx / h
        qy = 0.5 * (k_xy[:, 1:] + k_xy[:, :-1]) * (T[:, 1:] - T[:, :-1]) / h
        q[:, :-1] += qy / h
        q[:, 1:] -= qy / h
        q[:, 0] += qy[:, 0] / h  # mirror: the row on the plane stands for half a cell
        qz = 0.5 * (k[..., 1:] + k[..., :-1]) * (T[..., 1:] - T[..., :-1]) / h
        q[..., :-1] += qz / half_top[..., :-1]
        q[..., 1:] -= qz / half_top[..., 1:]
        if time < length / speed:
            at = speed * (time + 0.5 * dt)
            share_x = 0.5 * (erf(np.sqrt(2) * (x - at + h / 2) / w) - erf(np.sqrt(2) * (x - at - h / 2) / w))
            q[..., 0] += absorptivity * power * np.outer(share_x, share_y) / (h * h * 0.5 * h)
        if evaporates:
            q[..., 0] -= evaporation_flux(T[..., 0]) / (0.5 * h)
        q[0] = q[-1] = q[:, -1] = q[..., -1] = 0  # the far field stays cold
        H += dt * q
        T = metal.temperature(H)
        np.maximum(highest, T, out=highest)
        time += dt
    return pool(highest, x, y, z, length) + (highest.max(),)


def crossing(profile, at):
    """Where a falling profile passes the liquidus."""
    i = int(np.argmax(profile < LIQUIDUS))
    if i == 0:
        return 0.0
    return at[i - 1] + (profile[i - 1] - LIQUIDUS) / (profile[i - 1] - profile[i]) * (at[i] - at[i - 1])


def pool(highest, x, y, z, length):
    """Means over sections between a quarter and three quarters of the track."""
    rows = [i for i in range(len(x)) if 0.25 * length <= x[i] <= 0.75 * length]
    width = np.mean([2 * max(crossing(highest[i, :, k], y) for k in range(8)) for i in rows])
    depth = np.mean([crossing(highest[i, 0, :], z) for i in rows])
    return width, depth


def study(folder, name, hidden, extra=""):
    truth = {}
    conditions = []
    for n, (power, speed, spot) in enumerate(CONDITIONS, 1):
        label = f"t{n:02d}"
        conditions.append({"condition_id": label, "laser.power [W]": power, "scan.scan_speed [mm/s]": 1e3 * speed,
                           "laser.spot_diameter [um]": spot})
        width, depth, hottest = track(power, speed, spot * 1e-6, **hidden)
        print(f"{name} {label} {power} W {speed} m/s {spot} um: {1e6 * width:.2f} x {1e6 * depth:.2f} um, "
              f"{hottest:.0f} K", flush=True)
        truth[label, "pool.width"] = (1e6 * width, "um")
        truth[label, "pool.depth"] = (1e6 * depth, "um")
    rows = study_folder.measured(truth, {"pool.width": 0.01, "pool.depth": 0.01},
                                 {"pool.width": 0.7, "pool.depth": 0.5}, 2, HOLDOUT, 7, "finite differences in numpy")
    study_folder.write(f"{folder}/{name}", name, CASE.format(extra=extra), conditions, rows, CALIBRATION)


STUDIES = {
    "heat_null": ({}, ""),
    "heat_flow": ({"flow": 2.0}, ""),
    "heat_latent": ({}, "[effects.latent_heat]\nenabled = false\n"),
    "heat_conductivity": ({}, "[effects.variable_conductivity]\nenabled = false\n"),
    "heat_evaporation": ({"evaporates": True}, ""),
    "heat_absorptivity": ({"absorptivity": 0.43}, ""),
}

if __name__ == "__main__":
    for name, (hidden, extra) in STUDIES.items():
        if len(sys.argv) < 3 or name in sys.argv[2:]:
            study(sys.argv[1], name, hidden, extra)
