"""Decides whether a peak stress belongs to the part or depends on the excluded zone at sharp edges.

A peak right where the excluded zone ends is no maximum of the part: the stress goes on rising towards
the edge, and another distance would give another figure. What is tested is just that: whether the figure
falls at a distance a fifth longer, and whether the stress beside the peak rises inside the excluded zone.
"""

from __future__ import annotations

from math import inf
from typing import Protocol

from flexspline.fea.types import StressPeak

FARTHER, NEARER, TWICE = 1.2, 0.5, 2.0
"""Of the distance left out. Solid meshes have edges of about that distance at the edges, and show no rise
before half of it."""
FALL_SHARE = 0.015
"""By more than this, of the figure. Of 66 peaks of cups, hats and shafts 30 fall by 1.8 to 5.9 % and rise as
well; two refinements of a mesh may leave 0.5 %."""
RISES = 0.03
"""By more than this, of the figure. On the meridian of 80 cups and hats on the ellipse 34 peaks rise by 3.1
to 20 %, the others by 1.4 % at most. A solid mesh, whose nodes average over edges of half a wall, has
2.2 % where the meridian has 1.2."""


class Largest(Protocol):
    """Returns the largest von Mises stress [MPa] farther than a distance [mm] from sharp and patch edges.

    `within`: of those no farther than this from the peak's place [mm]. None where no point is.
    """

    def __call__(self, distance_mm: float, within_mm: float = inf) -> float | None: ...


def judged(
    mises_MPa: float,
    at_mm: tuple[float, float, float],
    exclusion_mm: float,
    largest: Largest,
    blind: bool = False,
) -> StressPeak:
    """The peak found at `exclusion_mm`, with what another distance would make of it.

    `blind`: the elements there are too long to show whether the stress rises nearer to the edge.
    """
    farther = largest(FARTHER * exclusion_mm)
    nearer = largest(NEARER * exclusion_mm, exclusion_mm)
    falls = farther is None or farther < (1 - FALL_SHARE) * mises_MPa
    rises = nearer is not None and nearer > (1 + RISES) * mises_MPa
    return StressPeak(
        mises_MPa,
        at_mm,
        f"points nearer than {exclusion_mm:g} mm to a sharp edge or a patch edge,"
        " where the linear solution is singular",
        exclusion_mm,
        falls and (rises or blind),
        largest(TWICE * exclusion_mm),
    )
