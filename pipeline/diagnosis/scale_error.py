"""Whether an elastic part may as well be a scale error of a reading: of the angle, or a unit."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    Doing,
    NamedCause,
    NextMeasurement,
    ScaleError,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.slope_hints import slope_hint

SAME_FACTOR_DEVIATIONS = 2.0
"""Standard deviations within which the factors of gap and compliance agree, and beyond which the gap is not
as simulated: 95 % of right pairs agree. The gap's tolerance is not among them: any factors would agree."""


def with_scale_error(
    outcome: DiagnosisOutcome, sweep: Sweep, prediction: Prediction, calibration: Calibration
) -> DiagnosisOutcome:
    """The outcome with an elastic part marked that a scale error explains as well."""
    marked = tuple(
        replace(c, or_scale=_scale_error(c, outcome, sweep, prediction, calibration))
        if c.id == SERIES and not c.own_units and not c.alternatives
        else c
        for c in outcome.causes
    )
    then = outcome.next_measurement
    if (
        any(c.or_scale for c in marked)
        and then
        and (then.aim, then.causes) == ("confirm", (SERIES,))
    ):
        then = NextMeasurement("angle_arcsec", "confirm", (SERIES,), Doing("check_scales"))
    return replace(outcome, causes=marked, next_measurement=then)


def _scale_error(
    series: NamedCause,
    outcome: DiagnosisOutcome,
    sweep: Sweep,
    prediction: Prediction,
    calibration: Calibration,
) -> ScaleError | None:
    hint = slope_hint(sweep, prediction, outcome.causes)
    if hint is not None and hint.units:
        return "unit"
    return "angle" if gap_by_same_factor(series, prediction, calibration) else None


def gap_by_same_factor(
    series: NamedCause, prediction: Prediction, calibration: Calibration
) -> bool:
    """Whether gap and compliance differ from the simulated ones by one factor, which is not 1."""
    if prediction.gap_arcsec <= 0:
        return False
    gap = calibration.gap_arcsec.value / prediction.gap_arcsec
    std = hypot(
        calibration.gap_arcsec.std / prediction.gap_arcsec,
        series.magnitude_std / 100,
        prediction.compliance_std / prediction.compliance,
    )
    allowed = SAME_FACTOR_DEVIATIONS * std
    return abs(gap - 1 - series.magnitude / 100) <= allowed < abs(gap - 1)
