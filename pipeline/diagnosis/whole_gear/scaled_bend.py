"""A gear that is stiffer or softer than simulated all over: its curve bends less or more by the same factor.

A spring in series leaves the bend as it is. Which of the two a record shows is decided before the race, in
which a bend that is scaled wrongly would be a hardening or a softening.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.crossing_band import BAND_SHARE
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.calibrated import ALLOWED_SIGMAS

LOOP_POWERS = (0, 1, 2)
"""Of torque: loops as wide everywhere, wider at large torque, and closed at the largest."""
FEWEST_BEND_ROWS = 24
"""Twice the unknowns of one unit."""


def with_scaled_bend(prediction: Prediction, sweep: Sweep) -> Prediction:
    """The prediction with the bend that the record's curve has; as it was where a spring explains it better.

    Slope on both sides of the gap, zero and drift of each unit, and a loop are fitted by least squares: once
    beside the simulated bend, once with the bend scaled by the slope. Both have as many unknowns. A slope
    within the stated uncertainty is no finding, and moves no bend.
    """
    if prediction.bend is None:
        return prediction
    history = sweep.history
    largest = history.largest_Nm
    rows = np.abs(history.torque_Nm) > BAND_SHARE * largest
    if int(rows.sum()) < FEWEST_BEND_ROWS:
        return prediction
    bend, line = prediction.bend.at(history.torque_Nm), prediction.compliance * history.torque_Nm
    beside = _beside(sweep, largest)[rows]
    angle = sweep.angle_arcsec[rows]
    _, spring = _slope(line[rows], beside, angle - bend[rows])
    scale, scaled = _slope((line + bend)[rows], beside, angle)
    allowed = ALLOWED_SIGMAS * prediction.compliance_std / prediction.compliance
    if scaled >= spring or scale <= 0 or abs(scale - 1) <= allowed:
        return prediction
    return replace(prediction, measured_bend=prediction.bend.scaled(scale))


def _beside(sweep: Sweep, largest: float) -> np.ndarray:
    """(n, k) columns of all that is neither slope nor bend."""
    history = sweep.history
    share, direction = history.torque_Nm / largest, direction_of_loading(history)
    columns = [history.sign, *(direction * np.abs(share) ** p for p in LOOP_POWERS)]
    for unit in history.unit_slices:
        for values in (np.ones(len(unit)), np.linspace(-1, 1, len(unit))):
            own = np.zeros(len(history))
            own[unit] = values
            columns.append(own)
    return np.column_stack(columns)


def _slope(curve: np.ndarray, beside: np.ndarray, angle: np.ndarray) -> tuple[float, float]:
    """By what a curve (n,) is scaled, and the sum of squares that it leaves."""
    columns = np.column_stack([curve, beside])
    found = np.linalg.lstsq(columns, angle, rcond=None)[0]
    left = angle - columns @ found
    return float(found[0]), float(left @ left)
