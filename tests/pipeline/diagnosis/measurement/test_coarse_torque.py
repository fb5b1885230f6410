"""Torque that a converter reads in coarse steps: the steps are noise, and no stairs of a programme."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm

ROWS, LARGEST_Nm, STEP_Nm = 1500, 30.0, 0.5
SIDE = 2 * np.pi * 3 * np.arange(ROWS) / ROWS
TRIANGLE_Nm = LARGEST_Nm * 2 / np.pi * np.arcsin(np.sin(SIDE))


def read(torque_Nm: np.ndarray) -> History:
    none = np.zeros(len(torque_Nm), int)
    return History(torque_Nm, none, none, 0.1 * np.arange(len(torque_Nm)))


@pytest.mark.parametrize("before_Nm", [0.0, 0.05])
def test_coarse_steps_are_noise(before_Nm: float) -> None:
    """Of a step over √12, the deviation of what is evenly spread over one step."""
    noise = before_Nm * np.random.default_rng(2).normal(size=ROWS)
    rounded = read(STEP_Nm * np.round((TRIANGLE_Nm + noise) / STEP_Nm))
    assert torque_noise_Nm(rounded) == pytest.approx(STEP_Nm / np.sqrt(12))
    off = less_jitter(rounded).torque_Nm - TRIANGLE_Nm
    beside = np.abs(np.abs(TRIANGLE_Nm) - LARGEST_Nm) > 2 * STEP_Nm
    assert np.sqrt(np.mean(off[beside] ** 2)) < 0.25 * STEP_Nm / np.sqrt(12)


def test_stairs_of_a_programme_are_none() -> None:
    levels = LARGEST_Nm * np.round(8 * TRIANGLE_Nm / LARGEST_Nm) / 8
    assert torque_noise_Nm(read(levels)) == 0.0


@pytest.mark.parametrize("decimals", [3, 6])
def test_what_is_written_in_decimals_is_not_coarse(decimals: int) -> None:
    assert torque_noise_Nm(read(TRIANGLE_Nm.round(decimals))) < 1e-3
