"""Cycles of a file that does not number them, by its torque alone."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history_reading import counted_cycles

PEAKS_NM = (2.0, 1.0, 0.5, 2.0, 0.5, 0.5, 1.0)
NUMBER = np.repeat(np.arange(1.0, 8.0), 100)
TURN = 2 * np.pi * (np.arange(700) + 0.5) / 100


@pytest.mark.parametrize("noise_Nm", [0.0, 0.01])
def test_small_cycles_beside_large_ones_are_counted(noise_Nm: float) -> None:
    """Peaks of a quarter of the largest; noise of 0.5 % of it moves a beginning by a row or two."""
    noise = np.random.default_rng(1).normal(0, noise_Nm, 700) if noise_Nm else 0.0
    torque = np.repeat(PEAKS_NM, 100) * np.sin(TURN) + noise
    wrong = np.flatnonzero(counted_cycles(torque) != NUMBER)
    assert len(wrong) <= (0 if noise_Nm == 0.0 else 2 * len(PEAKS_NM))


def test_noise_about_zero_makes_no_cycle() -> None:
    """A hold at no torque, with noise of 2 % of the largest, between two cycles."""
    rest = np.random.default_rng(2).normal(0, 0.04, 500)
    cycle = 2 * np.sin(TURN[:100])
    assert counted_cycles(np.concatenate([cycle, rest, cycle])).max() == 2.0
