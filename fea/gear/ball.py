"""A ball between two races: δ = C F^(2/3), Hertz.

Source: Harris and Kotzalas, Rolling Bearing Analysis, 5th ed., chapter 6 (eqs. 6.25 to 6.43), with the
elliptic integrals themselves instead of fits.
"""

from __future__ import annotations

from math import pi

from scipy.special import ellipe, ellipk

from flexspline.fea.types import Elastic


def point_contact(along: float, across: float, material: Elastic) -> float:
    """C of δ = C F^(2/3) [mm/N^(2/3)] of two bodies of one material.

    `along`, `across`: sums of both bodies' curvatures in the two principal planes [1/mm], convex positive;
    both are above 0.
    """
    total, curvature_difference = along + across, abs(along - across) / (along + across)
    ratio = _ellipticity(curvature_difference)
    m = 1 - ratio**-2
    shape = 2 * ellipk(m) / pi * (pi / (2 * ratio**2 * ellipe(m))) ** (1 / 3)
    soft = 2 / material.plane_strain_MPa
    return float(shape * (3 * soft / (2 * total)) ** (2 / 3) * total / 2)


def _ellipticity(curvature_difference: float) -> float:
    """a/b of the contact ellipse from the difference of curvatures over their sum."""
    from scipy.optimize import brentq  # a tenth of what `flexspline.pipeline.analysis` imports

    def excess(k: float) -> float:
        m = 1 - k**-2
        of_k = ((k * k + 1) * ellipe(m) - 2 * ellipk(m)) / ((k * k - 1) * ellipe(m))
        return float(of_k - curvature_difference)

    # a circle: the formula is 0/0 there, and the shape factor differs from 1 by this difference squared
    if curvature_difference < 1e-6:
        return 1.0
    # from less than that a/b to one that no ball on a race has
    return float(brentq(excess, 1 + 1e-7, 1e4))


def ball_between_races(
    diameter: float, outer_radius: float, conformity: float, material: Elastic
) -> float:
    """C [mm/N^(2/3)] of both contacts of a ball together.

    Parameters
    ----------
    diameter : of the ball [mm].
    outer_radius : of the outer race at its groove's bottom [mm].
    conformity : radius of both grooves over the ball's diameter, above 0.5.
    """
    ball, groove = 2 / diameter, 1 / (conformity * diameter)
    inner_radius = outer_radius - diameter
    return sum(
        point_contact(ball + along, ball - groove, material)
        for along in (1 / inner_radius, -1 / outer_radius)
    )
