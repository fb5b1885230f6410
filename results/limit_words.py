"""Limits in words: limits that a peak stress exceeds, and the torque limit of the linear model."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, assert_never

from flexspline.geometry.listed import joined
from flexspline.pipeline.linear_limit import LinearLimit, ReachedStress, ToothTwist
from flexspline.results.peaks import BORDER
from flexspline.results.quantities import quantity

if TYPE_CHECKING:
    from flexspline.geometry.design import Design
    from flexspline.pipeline.stress_limits import PassedLimit

NOT_SOLVED = (
    "without the peak stress at notches; `flexspline run` includes it and may lower the limit"
)


def stiffness_notes(design: Design) -> dict[str, str]:
    """What must be said beside a stiffness, by its key of result.json."""
    from flexspline.pipeline.first_face import is_too_large, why_too_large

    return {"K_e_Nm_per_rad": why_too_large(design)} if is_too_large(design) else {}


def beside_figure(passed: PassedLimit) -> str:
    """What is passed, where the peak's figure stands already."""
    if passed.key:
        return f"above the fatigue limit of {passed.limit_MPa:g} MPa"
    return (
        f"above {passed.limit_MPa:g} MPa, where no metal used in gears is elastic: the linear model is not "
        "valid"
    )


def passed_line(passed: PassedLimit) -> str:
    """On its own, as a warning."""
    stress = quantity(f"{passed.name}_mises_MPa")
    figure = f"{stress.name}: {stress.with_unit(passed.peak.mises_MPa)}"
    if passed.peak.at_excluded_border:
        far = passed.peak.exclusion_mm
        place = "at" if far is None else f"at the border of what is left out, {far:.3g} mm from"
        figure += f" ({place} an edge; the stress still rises towards this edge)"
    where = f" ({passed.key})" if passed.key else ""
    return f"{figure} is {beside_figure(passed)}{where}"


def reason(limit: LinearLimit) -> str:
    """Why the linear model is not valid beyond the limit, a clause."""
    why = limit.why
    match why:
        case ToothTwist(teeth):
            text = f"the twist reaches one tooth pitch, 360°/{teeth}"
        case ReachedStress():
            text = f"{_place(why)} under torque alone reaches {_stress(why)}"
        case _:
            assert_never(why)
    if not limit.peaks_solved:
        return f"{text} ({NOT_SOLVED})"
    parts = joined((f"the {part}'s peak" for part in limit.not_counted), "and")
    return f"{text} (not counted: {parts}, {BORDER})" if parts else text


def load_beyond(limit: LinearLimit, design: Design) -> Iterator[str]:
    """A line where the load torque is beyond the limit."""
    if design.load.torque_Nm > limit.torque_Nm:
        yield (
            f"load.torque_Nm = {design.load.torque_Nm:g} exceeds {limit.torque_Nm:.3g} N·m, the torque limit "
            f"of the linear model: there {reason(limit)}"
        )


def _place(why: ReachedStress) -> str:
    match why.place:
        case "tube":
            return f"the stress of the {why.part}'s tube"
        case "diaphragm":
            return f"the stress of the diaphragm at r = {why.size_mm:g} mm"
        case "shaft":
            return f"the stress of the shaft of {why.size_mm:g} mm"
        case "peak":
            return f"the {why.part}'s peak stress"
        case _:
            assert_never(why.place)


def _stress(why: ReachedStress) -> str:
    if why.is_fatigue_limit:
        return f"the fatigue limit of {why.limit_MPa:g} MPa"
    return f"{why.limit_MPa:g} MPa, above the strength of any metal used in gears"
