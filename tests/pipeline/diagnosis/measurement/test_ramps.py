"""How fast torque moves, against the rate at which a triangle was drawn."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import cycle_rate, ramp_rate


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


@pytest.mark.parametrize("rows", [400, 3000, 20_000])
@pytest.mark.parametrize("noise_Nm", [0.03, 0.1, 0.3])
def test_noise_of_one_hundredth_does_not_make_ramps_faster(rows: int, noise_Nm: float) -> None:
    """A triangle of 30 N·m: the rate's median, of steps that lie eight times the noise apart."""
    turn = np.arange(rows) * 3 / rows
    triangle = np.interp(turn % 1, [0, 0.25, 0.75, 1], [0, 30.0, -30.0, 0])
    read = triangle + noise_Nm * np.random.default_rng(3).normal(size=rows)
    history = History(read, np.zeros(rows, int), turn.astype(int), time_s=60 * turn)
    # of steps of 8 noises a twentieth, below 5.7, does not count: that moves their median by 0.06·√2/8 = 1 %
    assert ramp_rate(history) == pytest.approx(2.0, rel=0.04)
