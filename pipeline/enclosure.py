"""K of a part lies between the K of two simpler bodies: removing material never makes a part stiffer.

K of the cut body ≤ K of the part ≤ K of the whole body, in every load case (`geometry.nested` says which
bodies; docs/theory.md proves it).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from flexspline.fea.types import MET, Stiffness, StiffnessModel
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.part import Part
from flexspline.geometry.percent import percent
from flexspline.pipeline.errors import NestingError

PARABOLA_SLACK = 1e-4
"""Of K: what parabolas for arcs may do to a solid model, ten times what was measured (`fea.solid.swept`)."""


@dataclass(frozen=True)
class Names:
    """What messages call the two bodies, `less` and `more` material, and how both were solved."""

    less: str
    more: str
    model: StiffnessModel
    symmetry: str


OF_HOLES = Names(
    "the part with the ring of its holes cut out",
    "the part without holes",
    "axisymmetric",
    "two bodies of revolution",
)


@dataclass(frozen=True)
class TwoBodies:
    """K_b of the two bodies of revolution around a part with bolt holes, in one load case."""

    cut: Stiffness
    whole: Stiffness

    def enclosure(self) -> Stiffness:
        """Return K between the cut body's lower and the whole body's upper bound; theorems where both are.

        Raises
        ------
        NestingError
        """
        return between(self.cut, self.whole, OF_HOLES)


def two_bodies(part: Part, solve: Callable[[Part], Stiffness]) -> TwoBodies:
    """Solve both bodies of a part with bolt holes; `solve` solves a load case of a body of revolution.

    Raises
    ------
    ComputationError : of `solve`.
    """
    bodies = nested_bodies(part)
    return TwoBodies(solve(bodies.cut), solve(bodies.whole))


def between(cut: Stiffness, whole: Stiffness, names: Names) -> Stiffness:
    """Return the enclosure by two solved bodies; K is its middle.

    Ends that are estimates may cross where the bodies differ by less than the estimates are wrong by: then
    the bounds go from the one to the other. They may not by more than both half-widths together: then one of
    the two K is wrong by twice its own bounds or more.

    Raises
    ------
    NestingError : ends that are theorems cross, or estimates by more than that.
    """
    lower, upper = cut.lower_Nm_per_rad, whole.upper_Nm_per_rad
    guaranteed = cut.guaranteed and whole.guaranteed
    allowed = 0.0 if guaranteed else (cut.width_Nm_per_rad + whole.width_Nm_per_rad) / 2
    if lower - upper > allowed:
        raise NestingError(names.less, lower, names.more, upper)
    gap = 1 - cut.K_Nm_per_rad / whole.K_Nm_per_rad
    distance = percent(gap) if gap > 0 else "less than the bounds of either"
    return Stiffness(
        K_Nm_per_rad=(lower + upper) / 2,
        lower_Nm_per_rad=min(lower, upper),
        upper_Nm_per_rad=max(lower, upper),
        guaranteed=guaranteed,
        model=names.model,
        symmetry=names.symmetry,
        method=(
            f"from {names.less} to {names.more} (less material is never stiffer; the two K differ by "
            f"{distance}); the bounds of each come from: {whole.method}"
        ),
        levels=whole.levels,
        error_scale=max(cut.error_scale, whole.error_scale),
        shortfall=cut.shortfall or whole.shortfall,
    )


def held_within(solid: Stiffness, enclosure: Stiffness, tolerance: float) -> Stiffness:
    """Hold the solid model's K within its enclosure, where that says more, or less, than its own estimate.

    Where half of the enclosure is within `tolerance`·K, or it is the narrower of the two, its ends are the
    bounds; else each end is the better of both. K is the solid's, or the middle of what both leave where
    that K is outside of the enclosure; the middle of the enclosure where that is known better.

    Raises
    ------
    NestingError : the two have nothing in common.
    """
    check_against(solid, enclosure)
    half = solid.half_width
    narrow = enclosure.half_width <= max(tolerance, half)
    lower = max(solid.lower_Nm_per_rad, enclosure.lower_Nm_per_rad)
    upper = min(solid.upper_Nm_per_rad, enclosure.upper_Nm_per_rad)
    # apart by rounding, or by PARABOLA_SLACK
    lower, upper = min(lower, upper), max(lower, upper)
    if half > enclosure.half_width:
        K = enclosure.K_Nm_per_rad
        how = (
            "K is the middle of the bounds; without these bounds it is known to "
            f"± {percent(half)} ({solid.method})"
        )
    elif enclosure.lower_Nm_per_rad <= solid.K_Nm_per_rad <= enclosure.upper_Nm_per_rad:
        K, how = solid.K_Nm_per_rad, solid.method
    else:
        K = min(max((lower + upper) / 2, enclosure.lower_Nm_per_rad), enclosure.upper_Nm_per_rad)
        how = f"K is the middle of what both bounds have in common: {solid.method}"
    if narrow:
        lower, upper = enclosure.bounds_Nm_per_rad
    return replace(
        solid,
        K_Nm_per_rad=K,
        lower_Nm_per_rad=lower,
        upper_Nm_per_rad=upper,
        guaranteed=narrow and enclosure.guaranteed,
        method=f"{how}; {'bounds' if narrow else 'within'}: {enclosure.method}",
        shortfall=MET if enclosure.half_width <= tolerance else solid.shortfall,
        proven_Nm_per_rad=None if narrow else proven_by(enclosure),
    )


def proven_by(enclosure: Stiffness) -> tuple[float, float] | None:
    """Return the enclosure's bounds if they are theorems."""
    return enclosure.bounds_Nm_per_rad if enclosure.guaranteed else None


def answered_within(
    enclosure: Stiffness, solve: Callable[[], Stiffness], tolerance: float
) -> Stiffness:
    """Return the solid model's K from `solve`, held within the enclosure; the enclosure alone where it fails.

    Raises
    ------
    NestingError
    """
    try:
        solid = solve()
    except (ComputationError, MemoryError) as fault:
        met = enclosure.half_width <= tolerance
        words = f"{enclosure.shortfall}, and the solid model failed: {fault}"
        why = replace(enclosure.shortfall, words=words)
        return replace(enclosure, shortfall=MET if met else why)
    return held_within(solid, enclosure, tolerance)


def check_against(solid: Stiffness, enclosure: Stiffness) -> None:
    """Raise NestingError where the solid model's bounds and the enclosure have nothing in common."""
    if overlap(solid, enclosure):
        return
    if solid.lower_Nm_per_rad > enclosure.upper_Nm_per_rad:
        raise NestingError("the solid model", solid.lower_Nm_per_rad,
                           OF_HOLES.more, enclosure.upper_Nm_per_rad)  # fmt: skip
    raise NestingError(OF_HOLES.less, enclosure.lower_Nm_per_rad,
                       "the solid model", solid.upper_Nm_per_rad)  # fmt: skip


def overlap(solid: Stiffness, enclosure: Stiffness) -> bool:
    """Whether the bounds overlap, so that both may be true."""
    slack = PARABOLA_SLACK * enclosure.K_Nm_per_rad
    return (
        solid.lower_Nm_per_rad <= enclosure.upper_Nm_per_rad + slack
        and solid.upper_Nm_per_rad >= enclosure.lower_Nm_per_rad - slack
    )
