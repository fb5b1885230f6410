"""How fast torque moves, against the rate at which a triangle was drawn."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import cycle_rate


def test_each_cycle_of_a_noisy_triangle_has_the_triangle_s_rate() -> None:
    cycles, rows, period_s, peak_Nm = 5, 700, 9.0, 16.0
    t = np.arange(cycles * rows) / rows * period_s
    phase = (t / period_s) % 1
    triangle = np.interp(phase, [0, 0.25, 0.75, 1], [0, peak_Nm, -peak_Nm, 0])
    noise = np.random.default_rng(7).normal(0, 0.074, len(t))  # 0.8 of a row's step
    cycle = np.repeat(np.arange(cycles), rows)
    history = History(triangle + noise, np.zeros(len(t), int), cycle, time_s=t)
    found = [cycle_rate(history, np.flatnonzero(cycle == c)) for c in range(cycles)]
    # steps of eight times the noise weigh by what passes 5.7 times: those that noise lengthens weigh more,
    # by 2 / (8 - 5.7) of its deviation, 11 % of the step; the median of 88 steps is good to 3 %
    assert found == pytest.approx([1.11 * 4 * peak_Nm / period_s] * cycles, rel=0.1)
