"""How far a pair of teeth yields along the normal of its flanks [mm/N].

Two straight-sided teeth loaded at the pitch point: bending, shear and compression of the tooth as a beam of
variable section, its root in an elastic half plane (Cornell, J. Mech. Des. 103 (1981) 447-459, plane strain),
and the contact of the flanks (Yang and Sun, J. Mech. Transm. Autom. Des. 107 (1985) 529-535).
"""

from __future__ import annotations

from math import cos, pi, sin, tan

import numpy as np

from flexspline.fea.types import Elastic

SHEAR = 1.2
"""Of a rectangular section: mean square over square mean of the shear stress."""
POINTS = 16
"""Of the Gauss rule up the tooth; the integrands are smooth."""


def tooth(
    lever: float, thickness: float, pressure_angle: float, width: float, material: Elastic
) -> float:
    """Of one tooth [mm/N].

    Parameters
    ----------
    lever : from the root to the point of contact [mm].
    thickness : of the tooth there [mm]; towards the root it grows with both flanks.
    pressure_angle : of the flanks [rad].
    width : of the face [mm].
    """
    c, s = cos(pressure_angle), sin(pressure_angle)
    nu, E = material.poissons_ratio, material.youngs_modulus_MPa
    plane = E / (1 - nu * nu)
    x, w = np.polynomial.legendre.leggauss(POINTS)
    y, w = lever * (x + 1) / 2, lever * w / 2
    t = thickness + 2 * y * tan(pressure_angle)
    moment = c * y - s * thickness / 2
    beam = moment**2 * 12 / (plane * t**3) + SHEAR * c * c / (material.mu * t) + s * s / (plane * t)
    slender = lever / (thickness + 2 * lever * tan(pressure_angle))
    root = (
        16.67 / pi * slender**2
        + 2 * (1 - nu - 2 * nu**2) / (1 - nu**2) * slender
        + 1.534 * (1 + tan(pressure_angle) ** 2 / (2.4 * (1 + nu)))
    )
    return float((beam @ w + c * c * root / plane) / width)


def flank_contact(width: float, material: Elastic) -> float:
    """Of the two flanks on each other [mm/N]: 4(1 − ν²)/(π E b), whatever the load."""
    nu = material.poissons_ratio
    return 4 * (1 - nu * nu) / (pi * material.youngs_modulus_MPa * width)
