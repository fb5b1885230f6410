"""A gain of the angle reading that changes is no wear, though the gap's step changes with it."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read, history_of, simulated, steps

from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

NOISE_ARCSEC = 0.3


@pytest.mark.parametrize(("change", "cycles"), [(0.08, 6), (-0.05, 9)])
def test_a_gain_that_creeps_is_no_wear(change: float, cycles: int) -> None:
    history = history_of(steps(12.0, 40), cycles, row_s=0.5)
    assert history.time_s is not None
    warm = 1 - np.exp(-3 * history.time_s / history.time_s[-1])
    angle = simulated(history) * (1 + change * warm)
    noise = np.random.default_rng(11).normal(0, NOISE_ARCSEC, len(angle))
    outcome, _ = diagnose_sweep(as_read(history, angle + noise), PREDICTION)
    assert outcome.verdict == "unknown"
    assert outcome.causes == ()
    forms = outcome.unexplained[0].structure
    assert isinstance(forms, tuple)
    assert "changing_gain" in {form.kind for form in forms}
