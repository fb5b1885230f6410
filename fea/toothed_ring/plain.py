"""A plain ring's stiffnesses in closed form, per ring, and the thickness that gives a stiffness.

a and b are the inner and outer radius [mm]. All hold in plane strain, E' = E/(1 − ν²).
"""

from __future__ import annotations

from collections.abc import Callable
from math import log1p, sinh

from flexspline.geometry.tube import polar_moment_mm4


def bending(a: float, b: float) -> float:
    """Return the moment per relative turn of the sections per angle, over E' [mm³].

    M = E' S δ/θ with S = ((b² − a²)² − 4 a² b² L²) / (8 (b² − a²)), L = ln(b/a), which is
    ab (sinh²L − L²) / (4 sinh L); t³/(12 R) for a thin ring. Golovin's curved bar: Timoshenko and
    Goodier, Theory of Elasticity, 3rd ed., art. 29.
    """
    ratio = log1p((b - a) / a)
    rise = sinh(ratio)
    return a * b * _sinh_less(ratio) * (rise + ratio) / (4 * rise)


def _sinh_less(x: float) -> float:
    """sinh x − x for x > 0; the series keeps its digits where x is small."""
    if x > 1:
        return sinh(x) - x
    term = total = x**3 / 6
    for k in (20, 42, 72, 110, 156, 210):  # the next is below 1e-17 of the first
        term *= x * x / k
        total += term
    return total


def membrane(a: float, b: float, poissons_ratio: float) -> float:
    """Return the pressure per radial displacement of the inner surface, over E' [1/mm]: Lamé's cylinder.

    u(a) = p a ((1 − 2ν) a² + b²) (1 + ν) / (E (b² − a²)); t/a² for a thin ring.
    """
    nu = poissons_ratio
    return (1 - nu) * (b * b - a * a) / (a * ((1 - 2 * nu) * a * a + b * b))


def torsion(a: float, b: float) -> float:
    """Return J [mm⁴] of the whole tube."""
    return polar_moment_mm4(b, a)


def thickness(stiffness: Callable[[float, float], float], inner: float, wanted: float) -> float:
    """Return the thickness [mm] of the ring on `inner` [mm] whose `stiffness(a, b)` is `wanted` > 0."""
    from scipy.optimize import brentq

    def excess(t: float) -> float:
        return stiffness(inner, inner + t) - wanted if t else -wanted

    high = inner
    while excess(high) < 0:
        high *= 2
    return float(brentq(excess, 0.0, high, xtol=1e-15 * inner))  # a few roundings
