"""Unexplained structure in words: its form, and the limit that it exceeds."""

from __future__ import annotations

from collections.abc import Mapping
from math import copysign
from typing import assert_never

from flexspline.geometry.listed import joined
from flexspline.geometry.percent import percent
from flexspline.pipeline.diagnosis.absurd_size import slope_words
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.structure import (
    BackwardLoop,
    DraggedCrossing,
    FarSlope,
    FormKind,
    LateAngle,
    MissedLevel,
    NegativeGap,
    Slip,
    Structure,
    Trace,
    UnnamedForm,
)
from flexspline.pipeline.diagnosis.sweep.rig_faults.clamp_slip import LOADED_SHARE
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_forms import BOTH, DELAY, FILTER
from flexspline.results.diagnosis.channels import left_out_words
from flexspline.results.diagnosis.words import title_of
from flexspline.results.numbers import decimals_for, signed

FORMS: Mapping[tuple[FormKind, str], str] = {
    ("smooth", "torque_Nm"): "a smooth function of torque",
    ("smooth", "time_s"): "a smooth function of time",
    ("smooth", "row"): "a smooth function along the record",
    ("even_curve", "torque_Nm"): "a curve of torque, equal for both signs",
    ("bump", "torque_Nm"): "a bump in the curve",
    ("curve_step", "torque_Nm"): "a step in the curve",
    ("ripple", "torque_Nm"): "a ripple over torque",
    ("ripple", "angle_arcsec"): "a ripple over the output angle",
    ("softening", "torque_Nm"): "stiffness that falls with load",
    ("one_sided", "torque_Nm"): "a bend of the curve only at torque of one sign",
    (
        "less_bend",
        "torque_Nm",
    ): "a curve that bends less over torque than the simulated curve of the gear",
    ("uneven_loop", "direction"): "a loop that differs between the two sides",
    ("leading", "direction"): "output leads torque",
    ("gives_way", "torque_amplitude"): "a lock or clamp that slips under torque",
    ("rings", "torque_rate"): "ringing after sudden changes of torque",
    ("wave", "time_s"): "a wave in time",
    ("wave", "row"): "a wave along the record",
    ("step", "time_s"): "a step in time",
    ("step", "row"): "a step along the record",
    ("own_zero", "cycle"): "a separate zero offset in each cycle",
    ("own_zero", "input_angle_deg"): "a separate zero offset at each position",
    ("own_stiffness", "cycle"): "a separate stiffness in each cycle",
    ("own_stiffness", "input_angle_deg"): "a separate stiffness at each position",
    ("own_stiffness", "unit"): "a separate gain",
    ("own_gap", "cycle"): "a separate gap in each cycle",
    ("own_gap", "input_angle_deg"): "a separate gap at each position",
    ("own_gap", "unit"): "a separate gap",
    ("changing_zero", "temperature_C"): "a zero offset that changes with temperature",
    (
        "changing_zero",
        "input_angle_deg",
    ): "a zero offset that changes with the wave generator's angle, as with an "
    "eccentric encoder at the output",
    ("changing_loop", "cycle"): "a friction loop whose width changes from cycle to cycle",
    ("changing_loop", "temperature_C"): "a friction loop whose width changes with temperature",
    ("changing_gain", "time_s"): "a gain of the angle reading that changes with time",
    ("changing_gain", "row"): "a gain of the angle reading that changes along the record",
    ("changing_stiffness", "time_s"): "a stiffness that changes with time",
    ("changing_stiffness", "row"): "a stiffness that changes along the record",
    ("changing_stiffness", "cycle"): "a stiffness that changes from cycle to cycle",
    ("changing_stiffness", "temperature_C"): "a stiffness that changes with temperature",
    ("bent_gap", "temperature_C"): "a gap not linear in temperature",
    ("curve_of_totals", "torque_Nm"): "a curve of the totals over torque",
    ("trend", "specimen_order"): "a trend over the order of specimens",
    ("bend", "specimen_order"): "a bend over the order of specimens",
    ("alternating", "specimen_order"): "specimens that alternate",
    ("half_step", "specimen_order"): "a step half way through the specimens",
}
"""By kind and channel."""
ANYWHERE: Mapping[FormKind, str] = {
    "jumps": "jumps while the torque changes; stick-slip, or friction that the model does not "
    "describe",
    "comes_back": "the same misfit at the same torques in every cycle",
    "remainder": "the best model leaves more than noise; its form is not known",
    "slow_noise": "slow noise, too large for a comparison with the simulation",
}
"""Words that are the same for every channel."""
LATE = (
    "including the step of the gap; a lag of the twist does not delay this step. Drag ahead of the teeth "
    "that grows with the speed, for example from stiff grease, would look the same. If all cycles have one "
    "rate, a second play behind friction, such as a loose key, would also look the same"
)
LATE_ANGLE = {
    FILTER: "it looks as if the angle reading follows the torque through a filter of {0:.2g} ± {1:.1g} s, "
    + LATE,
    DELAY: "it looks as if the angle reading follows the torque {0:.2g} ± {1:.1g} s late, " + LATE,
    BOTH: "it looks as if both readings come through a filter of {0:.2g} ± {1:.1g} s: the step of the gap "
    "begins before the torque reading is zero, and is spread over that time",
}
UNRECORDED = {
    "temperature_C": "a gap that shrinks as the gear warms within each load (temperature)",
    "input_angle_deg": "a wave generator that turns with the load (its angle)",
}
"""What a gear or rig without faults may do that gives backward loops, by the channel that would show it."""


def structure_words(unexplained: Unexplained) -> str:
    """What structure without a name is like; of a broken limit a clause."""
    return words_of(unexplained.structure, unexplained.channel)


def words_of(structure: Structure, channel: str) -> str:
    """The same of the structure of a channel."""
    match structure:
        case tuple():
            return "; ".join(sorted({_form(form, channel) for form in structure}))
        case Trace():
            return f"a small effect like {title_of(structure.cause)}"
        case Slip():
            return (
                f"the output slips: each time torque passes {percent(LOADED_SHARE)} of its largest value and "
                f"comes back, the angle has advanced by {structure.slip_arcsec:.0f} arcsec, "
                f"{structure.times:.0f} times the elastic twist there; a lock, a clamp or a friction joint "
                "slips"
            )
        case FarSlope():
            return slope_words(structure)
        case NegativeGap():
            gap = f"{structure.gap_arcsec:.3g} ± {structure.std_arcsec:.2g} arcsec"
            return f"the best explanation needs a gap of {gap}, which is impossible"
        case MissedLevel():
            return (
                f"the causes found do not predict {left_out_words(structure.held_out)}: fitted to the other "
                f"rows, their error there is {structure.with_causes_arcsec:.3g} arcsec rms; the simulation "
                f"alone {structure.without_arcsec:.3g}"
            )
        case BackwardLoop():
            return _backward(structure)
        case LateAngle():
            return LATE_ANGLE[structure.kind].format(structure.time_s, structure.std_s)
        case DraggedCrossing():
            friction = f"{structure.friction_Nm:.3g} ± {structure.std_Nm:.1g} N·m"
            return (
                f"the gap is crossed against friction of {friction}, and later when the torque changes "
                "faster: drag ahead of the teeth grows with the speed, for example because of stiff grease. "
                "Such drag looks like more friction, hardening, a lag or another gap, so none of these is "
                "named"
            )
        case _:
            assert_never(structure)


def _form(form: UnnamedForm, channel: str) -> str:
    if form.kind == "one_specimen":
        return f"specimen {form.number} alone"
    if form.kind in ("trend", "bend") and (form.kind, channel) not in FORMS:
        return f"a {form.kind} over {channel}"  # a dimension
    if form.kind == "one_sided" and form.at_Nm is not None:
        return _one_sided(form.at_Nm, form.more_arcsec)
    words = ANYWHERE.get(form.kind) or FORMS[form.kind, channel]
    if form.at_Nm is not None:
        place = signed(form.at_Nm, decimals_for(abs(form.at_Nm), 2)) if form.at_Nm else "0"
        return f"{words} near {place} N·m"
    if not form.number:
        return words
    return f"{words} of unit {form.name or form.number}"


def _one_sided(at_Nm: float, more_arcsec: float | None) -> str:
    """On which side, from which torque on, and how much it is at the largest torque."""
    side = "positive" if copysign(1.0, at_Nm) > 0 else "negative"
    words = FORMS["one_sided", "torque_Nm"].replace("torque of one sign", f"{side} torque")
    if at_Nm:
        words += f", from {signed(at_Nm, decimals_for(abs(at_Nm), 2))} N·m on"
    if more_arcsec is None:
        return words
    more = "more" if more_arcsec > 0 else "less"
    return f"{words}: {abs(more_arcsec):.2g} arcsec {more} twist at the largest torque"


def _backward(loop: BackwardLoop) -> str:
    which = "the loops run" if loop.rate_Nm_per_s is None else (
        f"the quickest loops, at {loop.rate_Nm_per_s:.3g} N·m/s, run"
    )  # fmt: skip
    words = (
        f"{which} backwards: in the mean of {loop.loops} the angle is {loop.width_arcsec:.3g} arcsec lower "
        "while torque falls than while it rises. Such a loop would release energy, which a passive gear "
        f"cannot do; most likely {_likely(loop)}"
    )
    others = joined((UNRECORDED[channel] for channel in loop.unrecorded), "and")
    return f"{words}. Other possible causes, not recorded: {others}" if others else words


def _likely(loop: BackwardLoop) -> str:
    if loop.grows is False:
        return "the torque cell itself has hysteresis, because the loops do not grow with the rate"
    late = "by a filter or a delay"
    if loop.delay_s is not None:
        delay, std = loop.delay_s
        late = f"by {delay:.3g} ± {std:.2g} s at all rates, as with a filter or a delay"
    late = f"the torque reading lags the angle reading, {late}, or the two are not read at the same time"
    return late if loop.grows else f"{late}, or the torque cell itself has hysteresis"
