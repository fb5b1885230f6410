"""The next measurement in words: what to do, and what it would settle."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.diagnose import MeasurementKind
from flexspline.pipeline.diagnosis.outcome import NextMeasurement
from flexspline.results.diagnosis.words import channel_words, title_of

CONFIRMS = {
    "youngs_modulus": "a tensile or resonance test of the same bar gives E directly",
    "series_compliance": "clamp a solid dummy in the same fixture: what twists is the fixture",
    "load_zone": "specimens with another ring width, which the lobes feel most",
}
"""What confirms a cause that specimens show."""

SHOWS_STRUCTURE = {
    "torque_Nm": "sweep to a quarter, half and all of the largest torque, each twice without a pause; what "
    "repeats belongs to the gear, and how it grows with the amplitude says what it may be",
    "torque_amplitude": "sweep to a quarter, half and all of the largest torque, each twice",
    "torque_rate": "repeat the sweep ten times slower and ten times faster",
    "temperature_C": "repeat the sweep at three temperatures, soaked, wave generator untouched",
    "input_angle_deg": "repeat the sweep at seven wave generator angles 50° apart, in mixed order",
    "time_s": "hold a constant torque as long as the whole record took, then repeat the first cycle",
    "row": "record time with every row, and repeat the sweep at once and after a pause as long as the "
    "record: the pause changes what comes with time, and leaves what comes with the cycles",
    "cycle": "if the gear was clamped anew between cycles, give each clamp a name in a column unit and "
    "diagnose again; else run twenty further cycles at constant temperature, touching nothing",
    "unit": "measure the units again in another order, each clamped anew",
}
"""What shows structure in a channel, everything else held."""


def why(after: NextMeasurement, kind: MeasurementKind) -> str:
    """What to measure next and why, of the kind of measurement that was diagnosed."""
    if after.aim == "more_data":
        return after.doing
    return {"sweep": _of_sweep, "end_points": _of_end_points, "specimens": _of_specimens}[kind](
        after
    )


def _of_sweep(after: NextMeasurement) -> str:
    if after.aim == "find_structure":
        if after.doing:
            return after.doing
        where = f" ({after.where})" if after.where else ""
        return f"the structure lies in {channel_words(after.vary)}{where}: {_alone(after.vary)}"
    cause = known_causes()[after.causes[0]]
    if after.aim == "confirm":
        return f"to confirm {cause.title}: {after.doing or cause.reveals}"
    titles = _one_from_others(after)
    if not after.doing:
        return f"to tell {titles}: {cause.reveals}"
    apart = f"their predictions then differ by {after.separation:.0f} times the noise"
    return f"{after.doing}: {apart}; it tells {titles}"


def _alone(channel: str) -> str:
    return SHOWS_STRUCTURE.get(channel, "vary it alone, everything else held")


def _of_end_points(after: NextMeasurement) -> str:
    if after.aim == "find_structure":
        return "closed torque sweeps show the whole curve, not its ends"
    titles = ", ".join(map(title_of, after.causes))
    here = f"on unit {after.where}: {after.doing}"
    if after.aim != "separate":
        return f"{here}; it would confirm or clear the suspicion of {titles}"
    apart = (
        "the two of them that are nearest to each other then differ by "
        f"{after.separation:.0f} times the noise"
    )
    if after.same_points is not None:
        apart += f" (end points at the same torques: {after.same_points:.1f})"
    return f"{here}; it tells {titles} apart: {apart}"


def _of_specimens(after: NextMeasurement) -> str:
    if after.aim == "find_structure":
        return f"the structure is {after.where}: repeat those specimens, in another order"
    if after.aim == "confirm":
        test = CONFIRMS.get(after.causes[0])
        return f"to confirm it: {test}" if test else f"measure {after.vary} of the specimens"
    titles = _one_from_others(after)
    if after.dimension_mm is None:
        return f"another fixture, to tell {titles}"
    made, drawn = after.dimension_mm
    return (
        f"a specimen with {after.vary} = {made:g} instead of {drawn:g}: the predicted stiffnesses nearest "
        f"to each other then differ by {after.separation:.1f} times the noise; it tells {titles}"
    )


def _one_from_others(after: NextMeasurement) -> str:
    first, *others = map(title_of, after.causes)
    return f"{first} from {' or '.join(others)}"
