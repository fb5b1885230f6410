"""Stops (elastic-perfectly plastic elements) against their definition, row by row."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import sweep

from flexspline.pipeline.diagnosis.causes.operators import stops
from flexspline.pipeline.diagnosis.measurement.history import History

LIMITS = np.array([0.05, 0.3, 1.0, 7.0])
START = np.array([0.0, -1.0, 0.5, 1.0])
STILL = sweep(cycles=2, units=2, rows=40, hold=8)


def shaken(deviation: float) -> History:
    """Torque with noise, which turns at nearly every row."""
    noise = np.random.default_rng(6).normal(0, deviation, len(STILL))
    return replace(STILL, torque_Nm=STILL.torque_Nm + noise)


@pytest.mark.parametrize(
    "history", [STILL, shaken(0.2), STILL.rows(np.arange(1)), STILL.rows(np.full(5, 3))],
    ids=["triangles", "noise", "one row", "no movement"],
)  # fmt: skip
def test_each_state_is_the_last_one_moved_and_clipped(history: History) -> None:
    wanted = np.empty((len(history), len(LIMITS)))
    for rows in history.unit_slices:
        last, state = 0.0, START * LIMITS
        for i in rows:
            state = np.clip(state + history.torque_Nm[i] - last, -LIMITS, LIMITS)
            last, wanted[i] = history.torque_Nm[i], state
    # some hundred roundings of numbers up to 7
    found = stops(history, history.torque_Nm, LIMITS, START)
    np.testing.assert_allclose(found, wanted, atol=1e-12)
