"""Moving Gaussian on a half space with constant properties: Eagar & Tsai, Weld. J. 62 (1983) 346s. SI."""
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar

NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


@dataclass
class Metal:
    """Constant properties; `specific_heat` holds the latent heat too, spread over the rise to `melting`."""
    conductivity: float
    density: float
    specific_heat: float
    melting: float  # isotherm that bounds the pool [K]
    ambient: float = 298.0


STEEL_316L = Metal(24, 7300, 789, 1708)
IN625 = Metal(24, 8000, 789, 1623)


def temperature(metal, absorbed, speed, spot, x, y, depth):
    """At a point beside the beam, which moves along +x; `spot` is the 1/e2 diameter.

    The integral over past times t is taken over phi, with t = sigma^2 tan^2(phi) / (2 a): a bounded, smooth integrand.
    """
    a = metal.conductivity / (metal.density * metal.specific_heat)
    sigma = spot / 4
    phi = np.pi / 4 * (NODES + 1)
    t = sigma**2 * np.tan(phi)**2 / (2 * a)
    spread = 2 * sigma**2 / np.cos(phi)**2
    with np.errstate(divide="ignore"):
        f = np.exp(-((x + speed * t)**2 + y**2) / spread - depth**2 / (4 * a * t))
    integral = np.pi / 4 * (WEIGHTS @ f) * 2 / (sigma * np.sqrt(2 * a))
    return metal.ambient + absorbed * integral / (metal.density * metal.specific_heat * np.sqrt(4 * np.pi**3 * a))


def pool(metal, absorbed, speed, spot):
    """Width, depth and length [m] of the isotherm; zeros when nothing melts."""
    def excess(x, y, depth):
        return temperature(metal, absorbed, speed, spot, x, y, depth) - metal.melting

    hottest = minimize_scalar(lambda x: -excess(x, 0, 0), bounds=(-spot, spot), method="bounded").x
    if excess(hottest, 0, 0) <= 0:
        return 0.0, 0.0, 0.0

    def edge(f, begin, step):
        while f(begin + step) > 0:
            step *= 1.5
        return brentq(f, begin, begin + step, xtol=1e-11)

    front = edge(lambda x: excess(x, 0, 0), hottest, spot / 2)
    tail = edge(lambda x: excess(x, 0, 0), hottest, -spot / 2)

    def reach(f):
        def at(x):
            return edge(lambda s: f(x, s), 0.0, spot / 4) if f(x, 0.0) > 0 else 0.0
        xs = np.linspace(tail, front, 41)[1:-1]
        k = int(np.argmax([at(x) for x in xs]))
        return -minimize_scalar(lambda x: -at(x), bounds=(xs[max(k - 1, 0)], xs[min(k + 1, len(xs) - 1)]), method="bounded",
                                options={"xatol": 1e-9}).fun

    return 2 * reach(lambda x, s: excess(x, s, 0)), reach(lambda x, s: excess(x, 0, s)), front - tail


def normalised_enthalpy(metal, absorbed, speed, spot):
    """A P / (rho h_s sqrt(pi a v s^3)) with s the 1/e2 radius and h_s = cp (T_melting - T_ambient), cp without latent heat
    (650 J/kg K); King et al. 2014 find the keyhole at 30 +- 4 with s = sigma, that is 10.6 +- 1.4 here."""
    cp = 650.0
    a = metal.conductivity / (metal.density * cp)
    h = cp * (metal.melting - metal.ambient)
    return absorbed / (metal.density * h * np.sqrt(np.pi * a * speed * (spot / 2)**3))
