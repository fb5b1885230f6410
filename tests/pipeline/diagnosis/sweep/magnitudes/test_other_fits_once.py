"""Other explanations of a record are fitted once, whatever asks for them, and no answer changes by that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from read_sweep import as_read, history_of, steps

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.magnitudes.long_lags import long_lags
from flexspline.pipeline.diagnosis.sweep.magnitudes.magnitudes import fits_alike
from flexspline.pipeline.diagnosis.sweep.magnitudes.soft_ends import soft_ends
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, run_race

COMPLIANCE, GAP_ARCSEC, LARGEST_Nm, UNITS = 10.0, 45.0, 40.0, 3


@pytest.fixture(scope="module")
def explained() -> ExplainedSweep:
    """Three units with soft ends of their gaps, over 2 N·m, and twist that lags by 30 rows."""
    one = history_of(steps(LARGEST_Nm, 60), 3)
    torque, cycle, time = (np.tile(x, UNITS) for x in (one.torque_Nm, one.cycle, one.time_s))
    history = History(torque, np.repeat(np.arange(UNITS), len(one)), cycle, time)
    lagged = np.zeros(len(one))
    for i in range(1, len(one)):
        lagged[i] = lagged[i - 1] + (one.torque_Nm[i] - lagged[i - 1]) * (1 - np.exp(-1 / 30))
    gap = GAP_ARCSEC / 2 * np.tanh(one.torque_Nm / 2.0)
    twist = np.tile(COMPLIANCE * one.torque_Nm + lagged + gap, UNITS)
    angle = twist + np.random.default_rng(3).normal(0, 0.15, len(history))
    alone = as_read(one, angle[: len(one)])
    sweep = Sweep(
        alone.path, history, angle, ("A", "B", "C"), alone.cycles * UNITS,
        np.arange(len(history)) + 2, cycles_recorded=True,
    )  # fmt: skip
    return run_race(prepare(sweep, Prediction(COMPLIANCE, 0.3, GAP_ARCSEC, 5.0)))


def test_each_fit_has_its_others_once(explained: ExplainedSweep) -> None:
    identified = explained.identified
    assert soft_ends(identified.fit).fits
    assert long_lags(identified.fit).fits
    assert soft_ends(identified.fit) is soft_ends(identified.fit)
    assert long_lags(identified.fit) is long_lags(identified.fit)
    assert fits_alike(identified) is fits_alike(identified)


@pytest.mark.parametrize("unit", [None, *range(UNITS)])
def test_a_calibration_is_that_of_a_fit_of_which_nothing_is_known(
    unit: int | None, explained: ExplainedSweep
) -> None:
    identified = explained.identified
    fresh = replace(explained, identified=replace(identified, fit=replace(identified.fit)))
    assert not fresh.identified.fit.memo
    assert calibration_of(explained, unit) == calibration_of(fresh, unit)
