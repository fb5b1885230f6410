"""Torque readings that did not act on the gear, and pulses that did."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.torque_spikes import torque_spikes

ROWS, LARGEST_Nm, PER_Nm, GAP_ARCSEC = 1800, 30.0, 11.3, 72.0
NOISE_Nm, NOISE_ARCSEC = 0.1, 0.5


def programme() -> np.ndarray:
    turn = np.arange(ROWS) * 3 / ROWS
    return LARGEST_Nm * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * turn))


def pulses(seed: int, rows: int = 1) -> np.ndarray:
    """Twenty, of 5 to 10 N·m, each of so many rows."""
    rng = np.random.default_rng(seed)
    out = np.zeros(ROWS)
    at = 40 + 85 * np.arange(20) + rng.integers(0, 40, 20)
    for row, height in zip(at, rng.choice([-1, 1], 20) * rng.uniform(5, 10, 20), strict=True):
        out[row : row + rows] = height
    return out


def read(felt_Nm: np.ndarray, seed: int) -> np.ndarray:
    """(n,) angle of a gear under a torque."""
    noise = NOISE_ARCSEC * np.random.default_rng(seed).normal(size=ROWS)
    return PER_Nm * felt_Nm + GAP_ARCSEC / 2 * np.sign(felt_Nm) + noise


def with_noise(torque_Nm: np.ndarray, seed: int) -> np.ndarray:
    return torque_Nm + NOISE_Nm * np.random.default_rng(seed + 1).normal(size=ROWS)


@pytest.mark.parametrize("rows", [1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_what_the_angle_does_not_follow_is_found(seed: int, rows: int) -> None:
    spikes = pulses(seed, rows)
    found = torque_spikes(with_noise(programme() + spikes, seed), read(programme(), seed))
    # where the gap lies within two rows, the angle moves as a gear's would: at most 2 of 20
    assert not found[spikes == 0].any()
    assert found[spikes != 0].sum() >= 0.9 * (spikes != 0).sum()


@pytest.mark.parametrize("late", [0, 1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_a_pulse_that_the_gear_felt_stays(seed: int, late: int) -> None:
    """Also where the logger reads the angle a row or two after the torque."""
    real = pulses(seed)
    angle = read(programme() + np.roll(real, late), seed)
    assert not torque_spikes(with_noise(programme() + real, seed), angle).any()


@pytest.mark.parametrize("seed", range(4))
def test_a_pulse_behind_the_angle_s_filter_stays(seed: int) -> None:
    """Of two rows: each goes half of the way to what the gear does."""
    true = read(programme() + pulses(seed), seed)
    angle = true.copy()
    for row in range(1, ROWS):
        angle[row] = (angle[row - 1] + true[row]) / 2
    assert not torque_spikes(with_noise(programme() + pulses(seed), seed), angle).any()


def test_steps_of_a_programme_stay_where_the_angle_is_stuck() -> None:
    stairs = np.repeat(np.linspace(-LARGEST_Nm, LARGEST_Nm, 30), ROWS // 30)
    assert not torque_spikes(stairs, np.zeros(ROWS)).any()
