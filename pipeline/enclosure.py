"""K_b of a flexspline with bolt holes, between those of two bodies of revolution.

Less material is never stiffer: K_b of the cut body ≤ K_b of the part ≤ K_b of the whole body, in every load
case (`geometry.nested` says which bodies; docs/theory.md proves it).
"""

from __future__ import annotations

from collections.abc import Callable

from flexspline.fea.types import Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.part import Part


class NestingError(ComputationError):
    """Less material came out stiffer than more: one of the models is wrong.

    Attributes
    ----------
    softer_Nm_per_rad : least K of the body that has less material.
    stiffer_Nm_per_rad : largest K of the one that has more.
    """

    def __init__(self, less: str, softer: float, more: str, stiffer: float) -> None:
        self.softer_Nm_per_rad, self.stiffer_Nm_per_rad = softer, stiffer
        super().__init__(
            f"{less} is at least {softer:.7g} N·m/rad stiff, {more}, which has more material, at most "
            f"{stiffer:.7g}: one of the two solutions is wrong; please report the design file"
        )


def enclosed(part: Part, solve: Callable[[Part], Stiffness]) -> Stiffness:
    """K_b of a part with bolt holes: from the lower end of its cut body's to the upper of its whole body's.

    `solve` is a load case's solution of a body of revolution. The bounds are theorems where
    both of its are.

    Raises
    ------
    NestingError
    ComputationError : of `solve`.
    """
    bodies = nested_bodies(part)
    return between(solve(bodies.cut), solve(bodies.whole))


def between(cut: Stiffness, whole: Stiffness) -> Stiffness:
    """The enclosure by two solved bodies; K is its middle. Raises NestingError."""
    lower, upper = cut.lower_Nm_per_rad, whole.upper_Nm_per_rad
    if lower > upper:
        raise NestingError("the part with the ring of its holes cut out", lower,
                           "the part without holes", upper)  # fmt: skip
    gap = (whole.K_Nm_per_rad - cut.K_Nm_per_rad) / whole.K_Nm_per_rad
    return Stiffness(
        K_Nm_per_rad=(lower + upper) / 2,
        lower_Nm_per_rad=lower,
        upper_Nm_per_rad=upper,
        guaranteed=cut.guaranteed and whole.guaranteed,
        model="axisymmetric",
        symmetry="two bodies of revolution",
        method=(
            "between the part without holes and the part with the ring of its holes cut out (less material "
            f"is never stiffer), {gap:.2%} apart; of both: {whole.method}"
        ),
        levels=whole.levels,
        error_scale=max(cut.error_scale, whole.error_scale),
        shortfall=cut.shortfall or whole.shortfall,
    )
