"""Nuisance terms are what they say, and nothing that the calibration is already."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.nuisance.nuisance_terms import NEW_SHARE, nuisance_terms
from flexspline.pipeline.diagnosis.sweep.row_selection import settling


def left_of(column: np.ndarray, of: np.ndarray) -> float:
    """Share of a column's variation that a combination of others is not."""
    rest = column - of @ np.linalg.lstsq(of, column, rcond=None)[0]
    return float(rest.std() / column.std())


def calibration(history: History) -> np.ndarray:
    """(n, k) a zero of each unit, torque, and side of the gap."""
    zeros = history.unit[:, None] == np.arange(len(history.unit_slices))
    return np.column_stack([zeros, history.torque_Nm, history.sign])


@pytest.mark.parametrize("cycles", [1.25, 2.0, 3.4])
def test_an_even_curve_is_even(cycles: float) -> None:
    """With the calibration it is T², though in a record of part of a cycle T² and lags go together."""
    time = np.linspace(0.0, cycles, 400)
    torque = 2.0 * np.sin(2 * np.pi * time)
    zero = np.zeros(len(time), int)
    history = History(torque, zero, time.astype(int), 20.0 * time)
    (even,) = [
        t.columns
        for t in nuisance_terms(FitContext(PREDICTION, history))
        if t.form.kind == "even_curve"
    ]
    # torque without its noise is that of parabolas through 15 rows, of some 100 of a wave: to 1e-4
    assert left_of(torque**2, np.hstack([even, calibration(history)])) < 1e-3


def test_no_step_in_time_is_a_unit_s_zero_in_the_rows_that_count() -> None:
    """A step before a unit's rows begin to count is its zero: less the lags it would be but them."""
    history = replace(sweep(cycles=2, units=3, rows=240, hold=0), temperature_C=None)
    counted = ~settling(history)
    assert 0 < counted.sum() < len(history)
    steps = [
        t.columns for t in nuisance_terms(FitContext(PREDICTION, history)) if t.form.kind == "step"
    ]
    assert len(steps) > 30
    fixed = calibration(history)[counted]
    for columns in steps:
        share = left_of(columns[counted, 0], fixed)
        # the terms come less two lags beside the calibration, which take some of the rest
        assert share > NEW_SHARE / 2
