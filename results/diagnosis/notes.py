"""Notes on the use of a record, one line each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.causes.wear import WEAR
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.measurement.dropped_out import constant_lines
from flexspline.pipeline.diagnosis.measurement.record import EndPoints, Sweep
from flexspline.pipeline.diagnosis.measurement.repeated import copied_rows
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.diagnose import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.magnitudes.cancelling_terms import terms_cancel
from flexspline.pipeline.diagnosis.sweep.magnitudes.growth import Growth, growth_of
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual.rounding import (
    rounding_of_angle,
    rounding_of_torque,
)
from flexspline.results.diagnosis.data_used import row_notes
from flexspline.results.diagnosis.end_point_notes import end_point_notes
from flexspline.results.diagnosis.gap_notes import gap_notes
from flexspline.results.diagnosis.gear_inputs import gear_inputs_notes
from flexspline.results.diagnosis.position_notes import position_notes
from flexspline.results.diagnosis.reading import heads, lost_note, reading_notes, wrong_notes
from flexspline.results.diagnosis.specimen_notes import specimen_notes
from flexspline.results.diagnosis.temperature_notes import drift_notes, lag_notes, zero_notes
from flexspline.results.diagnosis.unit_notes import unit_notes
from flexspline.results.diagnosis.unseen import unseen_notes
from flexspline.results.diagnosis.words import ratio_words, title_of
from flexspline.results.numbers import figures_text, grouped

LONG_MEMORY, SLOW_RATIO = 0.8, 3.0
"""Of noise from one row to the next, and slow noise's rms over the other's, from which a reader is told."""
NOTHING_SHARE = 0.01
"""Of the simulated bend: a record that has less of it has none."""
GROWTH: Mapping[Growth, str] = {
    "levels_off": "levels off",
    "slows_down": "slows down",
    "accelerates": "accelerates",
}
NOT_SOUGHT = (
    "no input of the gear was fitted to the difference: this needs one unit that was loaded and unloaded in "
    "both directions, at three torques or more"
)


def notes(diagnosis: Diagnosis) -> tuple[str, ...]:
    """How the file was read, and notes for this kind of measurement."""
    bend = diagnosis.prediction.bend
    against = () if bend is None else (
        "compared with the simulated curve of the whole gear, which deviates from its chord by up to "
        f"{max(map(abs, bend.angle_arcsec)):.3g} arcsec" + _scaled(diagnosis.prediction, diagnosis.causes),
    )  # fmt: skip
    gear_inputs = diagnosis.gear_inputs
    if gear_inputs is not None:
        inputs = gear_inputs_notes(gear_inputs)
    elif bend is not None and diagnosis.sweep is not None:
        inputs = (NOT_SOUGHT,)
    else:
        inputs = ()
    return (
        *_wrong_readings(diagnosis),
        *_ratios(diagnosis.causes),
        *_mean_rates(diagnosis.sweep, diagnosis.causes),
        *reading_notes(diagnosis.measurement.read_as),
        *against,
        *inputs,
        *_of_kind(diagnosis),
    )


def _scaled(prediction: Prediction, causes: Iterable[NamedCause]) -> str:
    """That the curve of the record bends less or more, as its slope is; "" where it bends as simulated."""
    if prediction.bend is None or prediction.measured_bend is None:
        return ""
    most = max(map(abs, prediction.measured_bend.angle_arcsec))
    whole = max(map(abs, prediction.bend.angle_arcsec))
    if prediction.lost_bend is None:
        return (
            f"; in this record by up to {most:.3g} arcsec, scaled by the same factor as its slope"
        )
    part = "nothing" if most < NOTHING_SHARE * whole else f"up to {most:.3g} arcsec"
    text = f"; this record contains {part} of this deviation"
    if HARDENING in (c.id for c in causes):
        text += f". Other curvature is counted as {title_of(HARDENING)}"
    return text


def _wrong_readings(diagnosis: Diagnosis) -> list[str]:
    """Readings taken as wrong: column, numbers and lines in the file."""
    measured = diagnosis.measurement
    if not isinstance(measured, Sweep):
        return []
    lost = [] if measured.lost is None else [lost_note(measured.lost)]
    return [*lost, *wrong_notes(measured.wrong), *_held_rows(measured.held_rows)]


def _held_rows(count: int) -> list[str]:
    """That the angle's channel is slower than the rows."""
    if not count:
        return []
    return [
        f"the angle is read more slowly than rows are recorded: {count} rows that repeat the previous "
        "angle are left out, because the torque has changed since that reading"
    ]


def _ratios(causes: Iterable[NamedCause]) -> list[str]:
    """Of what the sizes in % are shares."""
    return [
        f"size of {title_of(c.id, c.magnitude)}: {ratio}"
        for c in causes
        if (ratio := ratio_words(c))
    ]


def _mean_rates(analysis: SweepAnalysis | None, causes: Iterable[NamedCause]) -> list[str]:
    """Of what grows at another rate later, that its size is the mean over the record."""
    if analysis is None:
        return []
    fit = analysis.explained.identified.fit
    return [
        f"size of {title_of(c.id)}: mean over the record; the growth {GROWTH[growth]}"
        for c in causes
        if c.id in (WEAR, DRIFT) and (growth := growth_of(fit, c.id)) is not None
    ]


def _of_kind(diagnosis: Diagnosis) -> tuple[str, ...]:
    if diagnosis.sweep is not None:
        measured = diagnosis.measurement
        of_record = record_notes(measured) if isinstance(measured, Sweep) else []
        return (
            *unit_notes(diagnosis.sweep),
            *_sweep_notes(diagnosis.sweep.explained, diagnosis.causes),
            *gap_notes(diagnosis.sweep, diagnosis.outcome.unexplained),
            *zero_notes(diagnosis.sweep.explained, diagnosis.outcome.unexplained),
            *position_notes(diagnosis.sweep.explained, diagnosis.outcome.unexplained),
            *_scale_notes(diagnosis.causes, diagnosis.calibration, diagnosis.prediction),
            *of_record,
        )
    if diagnosis.end_points is not None and isinstance(diagnosis.measurement, EndPoints):
        of_race = _race_notes(diagnosis.end_points, diagnosis.measurement)
        return (*end_point_notes(diagnosis.end_points), *of_race)
    if diagnosis.specimens is not None:
        return (*specimen_notes(diagnosis.specimens),)
    return ()


def record_notes(sweep: Sweep) -> list[str]:
    """Channels of the file that stand still, and rows that it has twice."""
    remarks = []
    if sweep.history.time_s is None and sweep.read_as.column("time_s") is not None:
        remarks.append("time is the same in all rows: taken as not recorded")
    if lines := constant_lines(sweep):
        remarks.append(
            f"torque and angle are exactly constant from line {lines[0]} to line {lines[1]}: if the channels "
            "dropped out, remove these rows; they are used as measured"
        )
    if copies := copied_rows(sweep):
        remarks.append(
            f"the last {grouped(copies, 0)} rows repeat earlier rows to the last digit: if the file was "
            "appended to itself, remove these rows; they are used as new measurements, which makes the "
            "standard deviations too small"
        )
    return remarks


def _sweep_notes(explained: ExplainedSweep, causes: Sequence[NamedCause]) -> list[str]:
    prepared = explained.prepared
    lines = row_notes(prepared)
    lines += unseen_notes(prepared.sweep.history, prepared.band_Nm, causes)
    lines += _rounding_notes(explained)
    lines += _noise_notes(explained)
    lines += _cancelling_notes(explained)
    lines += lag_notes(explained.identified)
    lines += drift_notes(causes)
    if prepared.sweep.read_as.ignored:
        lines.append(f"columns not used: {heads(prepared.sweep.read_as.ignored)}")
    return lines


def _noise_notes(explained: ExplainedSweep) -> list[str]:
    """That most of the noise is slow, where it is: an effect without a form may pass for such."""
    noise = explained.identified.search.evidence.noise
    if noise.memory < LONG_MEMORY or noise.coloured < SLOW_RATIO**2 * noise.white:
        return []
    return [
        f"the noise is {noise.std_arcsec:.2g} arcsec rms, and most of it is slow: it keeps its sign over "
        f"about {1 / (1 - noise.memory):.0f} rows; an effect that follows neither torque nor time nor "
        "position would look the same"
    ]


def _cancelling_notes(explained: ExplainedSweep) -> list[str]:
    """That terms without a name cancel, and how much they are together."""
    identified = explained.identified
    if not terms_cancel(identified):
        return []
    return [
        "the unnamed effects cancel each other in part: their sum is "
        f"{figures_text(identified.unnamed_rms(()))} arcsec rms; do not rely on the form and size of a "
        "single one; compliance and gap are calibrated without them"
    ]


def _rounding_notes(explained: ExplainedSweep) -> list[str]:
    """That a reading is coarse, where its rounding is more than the noise."""
    lines = []
    angle = rounding_of_angle(explained.prepared, explained.identified.fit)
    if angle.is_seen:
        lines.append(
            f"the angle is read in steps of {angle.step:.3g} arcsec: the rounding error, "
            f"{angle.left_arcsec:.2g} arcsec rms, cannot be distinguished from an effect of the angle; "
            "more noise, or a finer encoder, would reduce it"
        )
    torque = rounding_of_torque(explained.prepared, explained.identified.fit)
    if torque.is_seen:
        lines.append(
            f"the torque is read in steps of {torque.step:.3g} N·m: the rounding error, "
            f"{torque.left_arcsec:.2g} arcsec rms, cannot be distinguished from an effect of the torque"
        )
    return lines


def _scale_notes(
    causes: Iterable[NamedCause], calibration: Calibration | None, prediction: Prediction
) -> list[str]:
    """What looks like an elastic part: of an angle's wrong scale, that the gap has its factor too."""
    lines = []
    for c in causes:
        if c.id != SERIES or calibration is None:
            continue
        title = title_of(c.id, c.magnitude)
        if c.or_scale == "angle":
            gap = calibration.gap_arcsec.value / prediction.gap_arcsec
            slope = 1 + c.magnitude / 100
            lines.append(
                f"{title}: the gap is {gap:.3g} times and the compliance {slope:.3g} times the simulated "
                "one, as if the angle were read with a wrong scale"
            )
        else:
            material = "softer" if c.magnitude > 0 else "stiffer"
            lines.append(
                f"{title}: a wrong scale of the torque reading or a {material} material looks the same"
            )
    return lines


def _race_notes(analysis: EndPointAnalysis, points: EndPoints) -> list[str]:
    """How many rows the hypotheses were compared on, where not all."""
    if analysis.race_rows == len(points.unit):
        return []
    some, every = grouped(analysis.race_rows, 0), grouped(len(points.unit), 0)
    return [
        f"{some} of {every} rows were used to compare causes; every unit was compared with the envelope"
    ]
