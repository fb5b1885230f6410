"""dK/dp of every dimension of one design, found by two methods that share no mesh.

First from the energy with the field held (`fea.axisymmetric.shape_slope`), from one solution. Then from
K solved again on either side, with two step sizes and Richardson's extrapolation. Both by the axisymmetric
model: bolt holes and keyway are left out. They are of the load case "uniform"; the sum's term follows
`solver.load_case`, at lobes by the second way alone.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from flexspline.fea.axisymmetric.shape_slope import moved_stiffness
from flexspline.fea.axisymmetric.twist import Twist, twist
from flexspline.fea.shortfall import missing_because, settled
from flexspline.fea.types import MET, Elastic, Shortfall
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.keys import lengths, with_values
from flexspline.geometry.part import Part
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.revolved import lobes, revolved, torsion
from flexspline.pipeline.study.design_faults import DESIGN_FAULTS
from flexspline.pipeline.study.slope import Slope, Slopes

HELD_STEP = 1e-4
"""Of the dimension: the energy's difference is smooth, so only rounding limits the step."""
WIDER_STEP = 10
"""Times HELD_STEP, where the outline cannot follow so small a step."""
SOLVED_STEP = 0.04
"""Of the dimension: K is known to half of K_WIDTH only, and its difference must stand above that."""
K_WIDTH = 3e-4
"""Distance of the bounds over K: with SOLVED_STEP the slope is then off by 1 to 2 % of K per dimension."""
FIELD_RELATIVE_ERROR = 1e-3
"""Of the field that is held; the slope is a ratio of energies on one mesh and more accurate than they are."""
NARROWER = 0.25
"""Times the step, where a step cannot be built; TRIES of them end at a step of 0.06 %."""
TRIES = 4
"""Steps that are tried, each NARROWER than the last."""


def slopes(design: Design, say: Callable[[str], None]) -> Slopes:
    """Return dK/dp of every length above 0, the strongest first within a part; `say` is told each.

    Raises
    ------
    DesignError, ComputationError
    """
    plain = revolved(design)
    every: list[Slope] = []
    missing: dict[str, Shortfall] = {}

    def changed(values: dict[str, float], name: PartName) -> Part:
        return with_values(plain, values).part(name)

    for part in plain.parts:
        material = Elastic.of(part.material)
        solved = twist(part.meridian, material, part.driven, FIELD_RELATIVE_ERROR)

        def K(v: dict[str, float], name: PartName = part.name) -> float:
            return settled(torsion(changed(v, name), K_WIDTH)).K_Nm_per_rad

        @cache
        def at_lobes(v: tuple[tuple[str, float], ...]) -> float:
            return settled(lobes(changed(dict(v), "flexspline"), True, K_WIDTH)).K_Nm_per_rad

        def K_lobes(v: dict[str, float]) -> float:
            return at_lobes(tuple(v.items()))

        K_0 = K({})
        of_part = []
        for key, p in lengths(part).items():
            say(f"dK/dp of {key}")

            def moved(v: dict[str, float], part: Part = part, solved: Twist = solved) -> float:
                return moved_stiffness(solved, changed(v, part.name).meridian)

            held, why = None, MET
            try:
                held = slope_with_field_held(moved, key, p)
            except DESIGN_FAULTS as fault:
                why = missing_because(fault)
            again, error, no_room = _richardson(K, key, p, K_0)
            if held is None and again is None:
                missing[key] = why
                continue
            best: float | None = held if held is not None else again
            of_sum, no_sum = K_0, MET
            if part.name == "flexspline" and design.solver.sum_at_lobes:
                try:
                    of_sum = K_lobes({})
                    best, _, no_sum = _richardson(K_lobes, key, p, of_sum)
                except DESIGN_FAULTS as fault:
                    best, no_sum = None, missing_because(fault)
            windup = None
            if best is not None:
                windup = -2 * design.load.torque_Nm / of_sum**2 * best * ARCSEC_PER_RAD
            why = why or no_room
            of_part.append(Slope(key, part.name, p, held, again, error, K_0, windup, why, no_sum))
        every += sorted(of_part, key=lambda s: -abs(s.elasticity))
    return Slopes(tuple(every), missing)


def slope_with_field_held(K: Callable[[dict[str, float]], float], key: str, p: float) -> float:
    """Return a difference over so small a step that one side does where the other cannot be built.

    Raises
    ------
    DesignError, ComputationError : neither side can, by a wider step either.
    """
    # a new step in the outline has a least height
    for share in (HELD_STEP, WIDER_STEP * HELD_STEP):
        h, ends = share * p, []
        for side in (h, -h):
            try:
                ends.append((side, K({key: p + side})))
            except DesignError as fault:
                refused = fault
        if ends:
            (far, high), (near, low) = ends[0], ends[1] if len(ends) > 1 else (0.0, K({}))
            return (high - low) / (far - near)
    raise refused


def _central(K: Callable[[dict[str, float]], float], key: str, p: float, share: float) -> float:
    h = share * p
    return (K({key: p + h}) - K({key: p - h})) / (2 * h)


def _richardson(
    K: Callable[[dict[str, float]], float], key: str, p: float, K_0: float
) -> tuple[float | None, float, Shortfall]:
    """Central differences over h and h/2, extrapolated to h = 0; what may be wrong with them, and why
    there are none."""
    share, why = SOLVED_STEP, MET
    for _ in range(TRIES):
        try:
            wide, close = _central(K, key, p, share), _central(K, key, p, share / 2)
        except DESIGN_FAULTS as fault:
            share, why = share * NARROWER, missing_because(fault)
            continue
        noise = 5 / 3 * K_WIDTH * K_0 / (share * p)  # K's doubt on each, times the weights
        return (4 * close - wide) / 3, noise + abs(close - wide) / 3, MET
    return None, 0.0, why
