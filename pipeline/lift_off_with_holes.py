"""Lift-off of a part with bolt holes whose two enclosing bodies differ too much.

Lift-off has no solid model. But what it leaves of K, K resting over K held, is nearly the same of both bodies
however far their K are apart, for it is a matter of the rim. The solid model knows K held of the part itself,
so K is that times the ratio of the two. No theorem says that the part's ratio lies between theirs: the bounds
are estimates (docs/decisions.md has the parts on which they were compared with drawn holes).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from flexspline.fea.types import MET, Stiffness
from flexspline.geometry.errors import plain_number
from flexspline.pipeline.enclosed_part import TOO_FAR, enclosure_of
from flexspline.pipeline.enclosure import TwoBodies, answered_within
from flexspline.pipeline.parts import PartModel

RATIO_SPREAD = 0.25
"""Of the distance of the two ratios, by which the part's may lie beyond either. On the parts compared it lay
between them, or 0.02 of their distance beyond."""


def resting_with_holes(
    model: PartModel,
    resting: TwoBodies,
    held: TwoBodies,
    held_of_part: Callable[[], Stiffness],
) -> Stiffness:
    """Return K_b with a rim that may lift off, of a part that `has_enclosure`: its enclosure, or better.

    `resting` and `held` are its bodies of revolution, `held_of_part` solves the part with its seat held; it
    is asked where the enclosure is wider than the tolerance only.

    Raises
    ------
    NestingError
    """
    enclosure = enclosure_of(model, resting)
    if enclosure.half_width <= model.tolerance:
        return enclosure
    ratios = [
        (
            rim.lower_Nm_per_rad / rim_held.lower_Nm_per_rad,
            rim.upper_Nm_per_rad / rim_held.upper_Nm_per_rad,
        )
        for rim, rim_held in ((resting.cut, held.cut), (resting.whole, held.whole))
    ]

    def of_part() -> Stiffness:
        return _judged(by_ratio(held_of_part(), ratios), model.tolerance)

    return answered_within(enclosure, of_part, model.tolerance)


def by_ratio(held: Stiffness, ratios: list[tuple[float, float]]) -> Stiffness:
    """Return K held times the ratio that lift-off leaves, from the two bodies' bounds; an estimate."""
    middles = [(low + high) / 2 for low, high in ratios]
    spread = RATIO_SPREAD * (max(middles) - min(middles))
    low, high = min(r[0] for r in ratios) - spread, max(r[1] for r in ratios) + spread
    lower, upper = held.lower_Nm_per_rad * low, held.upper_Nm_per_rad * high
    return replace(
        held.times((low + high) / 2),
        lower_Nm_per_rad=lower,
        upper_Nm_per_rad=upper,
        guaranteed=False,
        method=(
            f"K with the seat held, {plain_number(held.K_Nm_per_rad, 5)} N·m/rad, times {low:.4f} to "
            f"{high:.4f}, what lift-off leaves of it on two bodies of revolution"
        ),
    )


def _judged(K: Stiffness, tolerance: float) -> Stiffness:
    if K.half_width <= tolerance:
        return replace(K, shortfall=MET)
    held = f"; with the seat held: {K.shortfall}" if K.shortfall else ""
    return replace(K, shortfall=replace(K.shortfall, words=f"{TOO_FAR}{held}"))
