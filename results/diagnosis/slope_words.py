"""Possible reasons for the slope of a sweep other than the gear, in words."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.absurd_size import given_words
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.slope_hints import NEAR_FACTOR, SlopeRatio, slope_hint
from flexspline.pipeline.diagnosis.structure import FarSlope, NegativeGap


def slope_hint_words(diagnosis: Diagnosis) -> str:
    """What the slope of a sweep may come from besides the gear, as a sentence of its own; "" of nothing."""
    sweep = diagnosis.measurement
    if not isinstance(sweep, Sweep):
        return ""
    limits = [u.structure for u in diagnosis.outcome.unexplained if u.limit]
    if any(isinstance(limit, FarSlope) for limit in limits):  # it asks for units itself
        return given_words(diagnosis.given)
    at_fault = not all(isinstance(limit, NegativeGap) for limit in limits)  # a rig, not the slope
    hint = slope_hint(sweep, diagnosis.prediction, diagnosis.outcome.causes, bool(limits))
    if hint is None or (at_fault and not hint.interchanged):
        return ""
    times = slope_times(hint.slope)
    if hint.interchanged and not hint.slope.far:
        return (
            " The angle steps back where torque changes its sign, as with torque and angle interchanged:"
            " check the columns."
        )
    if hint.interchanged:
        return (
            f" The slope is {times} than simulated; with torque and angle interchanged it would be close to"
            " the simulated one: check the columns."
        )
    if hint.units:
        units = " or ".join(f"{u.head} in {u.other}, not {u.unit}" for u in hint.units)
        near = f"to within about {100 * NEAR_FACTOR:g} %"
        return f" The slope is {times} than simulated, {near} as with {units}: check the units."
    if hint.whole_gear:
        return (
            f" The slope is {times} than flexspline and shaft in series. If a complete gear was measured, its"
            " teeth and bearing are elastic too: use --against gear."
        )
    return f" The slope is {times} than simulated: check the units, and that the record is of this design."


def slope_times(slope: SlopeRatio) -> str:
    """ "1.36 times softer"; both ends of a slope that is known roughly."""
    soft = slope.ratio > 1
    ends = (slope.low, slope.high) if soft else (1 / slope.high, 1 / slope.low)
    size = slope.ratio if soft else 1 / slope.ratio
    named = f"{size:.3g}" if slope.sharp or slope.low <= 0 else f"{ends[0]:.2g} to {ends[1]:.2g}"
    return f"{named} times {'softer' if soft else 'stiffer'}"
