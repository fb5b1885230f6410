"""What the causes explain by themselves decides whether what is left beside them has a name."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import history_of, read, simulated, steps

from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

LARGEST = 20.0  # N·m


def test_a_bump_under_load_one_way_is_no_hardening() -> None:
    """With holds: most rows lie at the largest torque, where a knee and a polynomial cancel."""
    quarter = 40
    cycle = steps(LARGEST, quarter)
    held = np.insert(cycle, quarter, np.full(60, LARGEST))
    history = history_of(held, 4)
    bump = 9.0 * np.exp(-(((history.torque_Nm - 10.0) / 1.2) ** 2))
    outcome, _ = diagnose_sweep(read(history, simulated(history) + bump, 1), PREDICTION)
    assert outcome.verdict == "unknown"


def test_a_jump_of_the_zero_is_no_drift() -> None:
    history = history_of(steps(LARGEST, 15), 8)
    jump = 12.0 * (np.arange(len(history)) >= 211)
    outcome, _ = diagnose_sweep(read(history, simulated(history) + jump, 6), PREDICTION)
    assert outcome.verdict == "unknown"
    assert not outcome.causes
    assert UnnamedForm("step") in outcome.unexplained[0].structure


def test_a_lag_up_to_a_ramp_is_rate_dependence_where_nothing_is_held() -> None:
    """A first-order lag τ of the elastic twist: its branch lags by τ·compliance for each N·m/s."""
    quarter, row_s = 40, 1.0
    fast = history_of(steps(LARGEST, quarter), 3, row_s)
    slow_rows = np.repeat(row_s * np.array([1.0, 4.0, 1.0]), 4 * quarter)
    time = np.cumsum(slow_rows)
    tau = 0.8 * quarter * row_s
    twist = np.zeros(len(fast))
    for i in range(1, len(twist)):
        reached = 1 - np.exp(-(time[i] - time[i - 1]) / tau)
        twist[i] = twist[i - 1] + (fast.torque_Nm[i] - twist[i - 1]) * reached
    history = type(fast)(fast.torque_Nm, fast.unit, fast.cycle, time)
    angle = simulated(history) + PREDICTION.compliance * (twist - fast.torque_Nm)
    outcome, _ = diagnose_sweep(read(history, angle, 7), PREDICTION)
    assert [c.id for c in outcome.causes] == ["rate_dependence"]
    # torque held over each row above and straight between rows in the cause: half a row of 20 or more
    assert outcome.causes[0].magnitude == pytest.approx(tau * PREDICTION.compliance, rel=0.1)
