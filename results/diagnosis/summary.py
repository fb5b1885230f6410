"""A verdict in one or two sentences; the same for console, record and report."""

from __future__ import annotations

from collections.abc import Sequence

from flexspline.geometry.listed import joined, listed
from flexspline.pipeline.diagnosis.calibration import FAR_DEVIATIONS, FarOff
from flexspline.pipeline.diagnosis.decision import is_significant
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NamedCause
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.shortage_words import shortage_words
from flexspline.results.diagnosis.slope_words import slope_hint_words
from flexspline.results.diagnosis.structure_words import structure_words
from flexspline.results.diagnosis.tolerance_words import only_because
from flexspline.results.diagnosis.words import (
    VERDICTS,
    cause_title,
    magnitude_words,
    plus_minus,
    sure_words,
    title_of,
)
from flexspline.results.numbers import figures_text

AGREES = {
    "sweep": "The measurement agrees",
    "end_points": "Every unit's total agrees",
    "specimens": "The specimens agree",
}
STANDS_OUT = 2.0
"""Times the noise, from which structure without a name is a part of the summary."""
UNUSUAL_DEVIATIONS = 2.0
"""A calibrated quantity that is farther off than one in twenty is said to be."""
FAR_UNITS = {"gap": "arcsec", "compliance": "arcsec per N·m"}


SIZE_ALONE = "The simulated form, but not the simulated size"
"""The heading in place of `consistent`'s own where gap or compliance lies far off."""


def verdict_heading(diagnosis: Diagnosis) -> str:
    """The verdict as a heading."""
    alone = diagnosis.verdict == "consistent" and _far_off(diagnosis)
    return SIZE_ALONE if alone else VERDICTS[diagnosis.verdict]


def summary(diagnosis: Diagnosis) -> str:
    """The verdict in one or two sentences; magnitudes with as many digits as their deviation bears.

    One more says a calibrated gap or compliance that lies far from the simulated one.
    """
    far = _far_off(diagnosis)
    if far and diagnosis.verdict == "consistent":
        text = f"The curve has the simulated form, but the {far}."
    else:
        text = _verdict(diagnosis) + (f" The calibrated {far}." if far else "")
    return text + slope_hint_words(diagnosis)


def _far_off(diagnosis: Diagnosis) -> str:
    """Calibrated quantities more than FAR_DEVIATIONS off, whatever else is named; "" of none.

    Of several units what they have in common, else each one's own.
    """
    common = {} if diagnosis.calibration is None else {"": diagnosis.calibration}
    for calibrations in (common, diagnosis.calibrations):
        far = [
            (f" of unit {name}" if name else "", off)
            for name, calibration in calibrations.items()
            for off in calibration.far_off(diagnosis.prediction)
        ]
        if far:
            return "; the ".join(f"{off.quantity}{of}, {_how_far(off)}" for of, off in far)
    return ""


def _how_far(off: FarOff) -> str:
    value = plus_minus(off.measured.value, off.measured.std)
    return (
        f"{value} {FAR_UNITS[off.quantity]}, differs by {off.deviations:.1f} stated standard deviations from "
        "the simulated value"
    )


def _within(diagnosis: Diagnosis) -> str:
    """What contains all that was calibrated of a consistent record, where it is not `_far_off`."""
    calibration = diagnosis.calibration
    if calibration and calibration.far_off(diagnosis.prediction, UNUSUAL_DEVIATIONS):
        return f"{FAR_DEVIATIONS:g} stated standard deviations"
    return "its stated uncertainty"


def _verdict(diagnosis: Diagnosis) -> str:
    outcome = diagnosis.outcome
    points, specimens = diagnosis.end_points, diagnosis.kind == "specimens"
    match outcome.verdict:
        case "insufficient":
            reason = "" if outcome.too_little is None else shortage_words(outcome.too_little)
            return f"The data are not sufficient: {reason}."
        case "consistent":
            if diagnosis.specimens is not None and (why := only_because(diagnosis.specimens)):
                return f"{AGREES[diagnosis.kind]} with the simulation {why}."
            noise = "" if points else " and the noise"
            return (
                f"{AGREES[diagnosis.kind]} with the simulation within {_within(diagnosis)}{noise}."
            )
        case "named" if specimens:
            return f"The simulation is wrong in at least one point: {_listed(outcome.causes)}."
        case "named":
            return f"{left_out(outcome.causes)}{_left_over(outcome)}"
        case "ambiguous" if points is not None:
            return _ambiguous_end_points(outcome, points)
        case "ambiguous":
            what = "leaves an effect out, and these data do"
            what = "is wrong in at least one point, and these specimens do" if specimens else what
            open_ = f"The simulation {what} not show which: {_rivals(outcome.causes)}."
            return f"{open_}{_beside(outcome.causes)}{_left_over(outcome)}"
        case _ if points is not None:
            return "The totals depend on torque in a way that no known cause explains."
        case _:
            return _unknown(outcome, specimens)


def _left_over(outcome: DiagnosisOutcome) -> str:
    """Beside what is named: the largest structure without a name, where it stands out of the noise."""
    if outcome.gain is None or not outcome.unexplained:
        return ""
    most = max(outcome.unexplained, key=lambda u: u.rms)
    if most.rms < STANDS_OUT * outcome.gain.noise_floor:
        return ""
    channel = channel_words(most.channel)
    rms = f"{figures_text(most.rms, 2)} {most.unit} rms"
    return f" No known cause explains the remaining structure ({channel}): {structure_words(most)}, {rms}."


def left_out(causes: Sequence[NamedCause]) -> str:
    """What the simulation leaves out, and where it is too soft."""
    missing = [c for c in causes if not c.is_surplus]
    surplus = [c for c in causes if c.is_surplus]
    sentences = [f"The simulation leaves out: {_listed(missing)}."] if missing else []
    sentences += [f"The simulation is too soft: {_listed(surplus)}."] if surplus else []
    return " ".join(sentences)


def _listed(causes: Sequence[NamedCause]) -> str:
    """Each with its size; a cause that units have in different sizes is there more than once."""
    ids = [c.id for c in causes]
    return "; ".join(_with_magnitude(c, "only " * (ids.count(c.id) == 1)) for c in causes)


def _with_magnitude(cause: NamedCause, only: str) -> str:
    where = f" ({only}{listed(cause.own_units, 'units')})" if cause.own_units else ""
    return f"{cause_title(cause)}, {magnitude_words(cause)}{where}"


def _rivals(causes: Sequence[NamedCause]) -> str:
    clauses = []
    for place, c in enumerate(causes):
        named = {
            e.id for e in causes[:place] if c.id in e.alternatives and e.own_units == c.own_units
        }
        others = [other for other in c.alternatives if other not in named]
        if others:
            whom = joined(map(title_of, others), "or")
            where = f"unit {listed(c.own_units, 'units')}: " if c.own_units else ""
            clauses.append(f"{where}{cause_title(c)} cannot be distinguished from {whom}")
    clauses += [
        f"{cause_title(c)}, {magnitude_words(c)}, is suspected but not significant"
        for c in causes
        if not is_significant(c) and not c.alternatives
    ]
    return "; ".join(clauses)


def _beside(causes: Sequence[NamedCause]) -> str:
    """Causes without a rival, beside others that have one, each with how sure it is; "" of none."""
    identified = [
        f"{_with_magnitude(c, 'only ')} ({sure_words(c)})"
        for c in causes
        if not c.alternatives and is_significant(c)
    ]
    return f" Also identified: {'; '.join(identified)}." if identified else ""


def _unknown(outcome: DiagnosisOutcome, specimens: bool) -> str:
    sure = [c for c in outcome.causes if not c.alternatives]
    known = f" Also identified: {_listed(sure)}." if sure else ""
    if open_ := [c for c in outcome.causes if c.alternatives]:
        known += f" Besides, {_rivals(open_)}."
    if specimens:
        what = "; ".join(map(structure_words, outcome.unexplained))
        return f"There is structure that no known cause explains: {what}.{known}"
    broken = [structure_words(u) for u in outcome.unexplained if u.limit]
    if broken:
        text = f"No cause is named: {'; '.join(broken)}"
        return text if text.endswith("?") else f"{text}."
    channels = dict.fromkeys(channel_words(u.channel) for u in outcome.unexplained)
    where = ", ".join(channels) or "the data"
    return f"There is structure in {where} that no known cause explains.{known}"


def _ambiguous_end_points(outcome: DiagnosisOutcome, analysis: EndPointAnalysis) -> str:
    first = outcome.causes[0]
    title = cause_title(first)
    others = ", ".join(map(title_of, first.alternatives))
    rival = (
        f"{title} cannot be distinguished from {others}"
        if others
        else f"{title} is suspected but not significant"
    )
    beyond = [u.unit for u in analysis.units if not u.within]
    named = listed(beyond, "units")
    who = f"Unit {named} lies" if len(beyond) == 1 else f"Units {named} lie"
    where = (
        f"{who} beyond the predicted envelope"
        if beyond
        else "The totals differ from the prediction"
    )
    why = "" if analysis.several_torques else ", because each unit was measured at one torque"
    beside = _beside(outcome.causes[1:])
    return f"{where}, and these end points do not show why: {rival}{why}.{beside}"
