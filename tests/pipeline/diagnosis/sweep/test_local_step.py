"""A step of the curve at one torque is told where it is, and leaves compliance and gap as they are."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read, history_of, simulated, steps

from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.race.race import run_race
from flexspline.results.diagnosis.structure_words import structure_words

LARGEST_Nm, NOISE_ARCSEC = 8.0, 0.3


@pytest.mark.parametrize(
    "at",
    [
        [(3.2, 6.0)],
        [(-4.0, -8.0)],
        [(3.0, 8.0), (-3.0, -8.0)],  # a key that is loose, both ways
    ],
)
def test_a_step_is_told_where_it_is(at: list[tuple[float, float]]) -> None:
    history = history_of(steps(LARGEST_Nm, 55), 5)
    angle = simulated(history) + np.random.default_rng(4).normal(0, NOISE_ARCSEC, len(history))
    for place, height in at:
        beyond = np.sign(place) * (history.torque_Nm - place)
        angle += height * (1 + np.tanh(beyond / 0.05)) / 2
    sweep = as_read(history, angle)
    outcome, _ = diagnose_sweep(sweep, PREDICTION)
    assert outcome.verdict == "unknown"
    assert not outcome.causes
    (only,) = outcome.unexplained
    assert isinstance(only.structure, tuple)
    assert {form.kind for form in only.structure} == {"curve_step"}
    assert "a step in the curve near" in structure_words(only)
    # between two torques, 0.15 N·m apart
    places = [form.at_Nm for form in only.structure if form.at_Nm is not None]
    assert sorted(places) == pytest.approx(sorted(place for place, _ in at), abs=0.15)
    calibration = calibration_of(run_race(prepare(sweep, PREDICTION)))
    assert calibration.compliance is not None
    # noise of 0.3 arcsec in some 1 000 rows, torque of 4.6 N·m rms, and a step beside it: 0.006
    assert calibration.compliance.value == pytest.approx(PREDICTION.compliance, abs=0.03)
    assert calibration.gap_arcsec.value == pytest.approx(PREDICTION.gap_arcsec, abs=0.3)
