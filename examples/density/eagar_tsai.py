"""Pool of a Gaussian beam that moves over a half space with constant properties: Eagar & Tsai, Weld. J. 62 (1983) 346s.
SI throughout."""
from dataclasses import dataclass

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(200)


@dataclass
class Metal:
    """Constant properties; `specific_heat` holds the latent heat too, spread over the rise to `melting`."""
    conductivity: float
    density: float
    specific_heat: float
    melting: float  # isotherm that bounds the pool [K]
    ambient: float = 300.0


ALSI10MG = Metal(110, 2500, 1730, 867)


def temperature(metal, absorbed, speed, spot, x, y, depth):
    """At points beside the beam, which moves along +x; `spot` is the 1/e2 diameter; x, y, depth broadcast.

    The integral over past times t is taken over phi, with t = sigma^2 tan^2(phi) / (2 a): a bounded, smooth integrand.
    """
    a = metal.conductivity / (metal.density * metal.specific_heat)
    sigma = spot / 4
    phi = np.pi / 4 * (NODES + 1)
    t = sigma**2 * np.tan(phi)**2 / (2 * a)
    spread = 2 * sigma**2 / np.cos(phi)**2
    x, y, depth = (np.asarray(v, float)[..., None] for v in (x, y, depth))
    f = np.exp(-((x + speed * t)**2 + y**2) / spread - depth**2 / (4 * a * t))
    integral = np.pi / 4 * (f @ WEIGHTS) * 2 / (sigma * np.sqrt(2 * a))
    return metal.ambient + absorbed * integral / (metal.density * metal.specific_heat * np.sqrt(4 * np.pi**3 * a))


def crossing(hot, beyond):
    """Largest s in [0, beyond] with hot(s), one for each element, where hot(0) and not hot(beyond): by halving."""
    low, high = np.zeros(beyond.shape), beyond
    for _ in range(40):
        middle = 0.5 * (low + high)
        inside = hot(middle)
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return 0.5 * (low + high)


def pool(metal, absorbed, speed, spot):
    """Width, depth and length [m] of the isotherm; zeros when nothing melts."""
    def is_hot(x, y, depth):
        return temperature(metal, absorbed, speed, spot, x, y, depth) > metal.melting

    axis = np.linspace(-1.5, 1, 501) * spot
    hottest = axis[np.argmax(temperature(metal, absorbed, speed, spot, axis, 0, 0))]
    if not is_hot(hottest, 0, 0):
        return 0.0, 0.0, 0.0
    far = spot
    while np.any(is_hot(hottest + np.array([-far, far]), 0, 0)):
        far *= 2
    one = np.array([far])
    front = hottest + crossing(lambda s: is_hot(hottest + s, 0, 0), one)[0]
    tail = hottest - crossing(lambda s: is_hot(hottest - s, 0, 0), one)[0]
    sizes = []
    for place in (lambda x, s: is_hot(x, s, 0), lambda x, s: is_hot(x, 0, s)):
        low, high = tail, front
        for _ in range(3):  # the widest and the deepest place, closer and closer
            x = np.linspace(low, high, 42)[1:-1]
            reach = np.where(is_hot(x, 0, 0), crossing(lambda s: place(x, s), np.full(x.shape, far)), 0)
            k = int(np.argmax(reach))
            low, high = x[max(k - 1, 0)], x[min(k + 1, len(x) - 1)]
        sizes.append(float(reach.max()))
    return 2 * sizes[0], sizes[1], float(front - tail)
