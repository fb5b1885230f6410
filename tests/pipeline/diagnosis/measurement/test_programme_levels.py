"""Stairs of torque in noise: their steps, their rests, and the levels that come again."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import known_ways, programme_edges
from flexspline.pipeline.diagnosis.measurement.programme_levels import levelled_torque_Nm
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm

ROWS, NOISE_Nm, CYCLES = 60, 0.3, 3
LEVELS_Nm = np.tile([5.0, 15.0, 25.0, 15.0, 5.0, -5.0, -15.0, -25.0, -15.0, -5.0], CYCLES)


def stairs(levels_Nm: np.ndarray, seed: int) -> History:
    torque = np.repeat(levels_Nm, ROWS)
    noise = NOISE_Nm * np.random.default_rng(seed).normal(size=len(torque))
    none = np.zeros(len(torque), int)
    cycle = np.arange(len(torque)) * CYCLES // len(torque)
    return History(torque + noise, none, cycle, 0.5 * np.arange(len(torque)))


@pytest.mark.parametrize("seed", range(6))
def test_a_step_from_one_row_to_the_next_is_one_edge(seed: int) -> None:
    (edges,) = programme_edges(stairs(LEVELS_Nm, seed))
    assert edges.tolist() == list(range(0, len(LEVELS_Nm) * ROWS + 1, ROWS))


@pytest.mark.parametrize("seed", range(6))
def test_every_rest_is_known_where_chance_alone_refuses_some(seed: int) -> None:
    """An end that stands out by 2.5 deviations is refused only where many do."""
    found = known_ways(stairs(LEVELS_Nm, seed))
    # one number each; at three deviations a second one is seen in 1 of 40
    assert sum(way.held for way in found) >= len(LEVELS_Nm) - 4
    assert sum(len(way.rows) for way in found) == len(LEVELS_Nm) * ROWS


@pytest.mark.parametrize("seed", range(6))
def test_rests_at_one_level_have_one_torque(seed: int) -> None:
    history = stairs(LEVELS_Nm, seed)
    torque = levelled_torque_Nm(history)
    true = np.repeat(LEVELS_Nm, ROWS)
    held = np.concatenate([way.rows for way in known_ways(history) if way.held])
    for level in np.unique(LEVELS_Nm):
        rows = held[true[held] == level]
        assert np.ptp(torque[rows]) == 0
        # six rests of 60 rows, three at the ends of the range
        assert torque[rows[0]] == pytest.approx(level, abs=4 * NOISE_Nm / np.sqrt(3 * ROWS))


@pytest.mark.parametrize("seed", range(3))
def test_a_programme_of_a_hundred_close_levels_keeps_them(seed: int) -> None:
    """A hundredth of the noise apart: no two neighbours differ, but the first and the last do."""
    close = np.linspace(-15.0, 15.0, 400)
    history = stairs(close, seed)
    true = np.repeat(close, ROWS)
    assert np.std(levelled_torque_Nm(history) - true) < NOISE_Nm / np.sqrt(ROWS) * 1.3


@pytest.mark.parametrize("seed", range(4))
def test_weights_that_are_read_once_each_scatter_about_their_levels(seed: int) -> None:
    """Three weights and a tray, put on and taken off three times: no reading repeats the one before."""
    way = np.array([1.0, 5.0, 10.0, 15.0, 10.0, 5.0, 1.0])
    true = np.tile(np.r_[way, -way], 3)
    read = true + 0.02 * np.random.default_rng(seed).normal(size=len(true))
    none, cycle = np.zeros(len(true), int), np.arange(len(true)) // 14
    history = History(read, none, cycle, 20.0 * np.arange(len(true)))
    # 34 degrees of freedom: to 12 % each, three deviations
    assert torque_noise_Nm(history) == pytest.approx(0.02, rel=0.36)


def test_stairs_read_without_noise_have_none() -> None:
    true = np.tile([5.0, 10.0, 5.0, -5.0, -10.0, -5.0], 4)
    none = np.zeros(len(true), int)
    assert torque_noise_Nm(History(true, none, none)) == 0


@pytest.mark.parametrize("step_Nm", [0.01, 0.02])
def test_the_digits_of_a_long_record_are_no_levels(step_Nm: float) -> None:
    """50 000 rows written to a hundredth: each number comes again and again, and scatters by nothing."""
    turn = 4 * np.arange(50_000) / 50_000
    triangle = 20 * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * turn))
    read = triangle + 0.1 * np.random.default_rng(2).normal(size=len(turn))
    history = History(
        step_Nm * np.round(read / step_Nm), np.zeros(len(turn), int), turn.astype(int), 60 * turn
    )
    assert torque_noise_Nm(history) == pytest.approx(0.1, rel=0.05)


def test_ways_without_noise_beside_noisy_ones_are_left_as_they_are() -> None:
    """Holds read to the last digit in one cycle, in noise in the next."""
    noisy = stairs(LEVELS_Nm, 1)
    torque = np.where(noisy.cycle == 0, np.repeat(LEVELS_Nm, ROWS), noisy.torque_Nm)
    mixed = History(torque, noisy.unit, noisy.cycle, noisy.time_s)
    assert all(len(way.rows) for way in known_ways(mixed))
    assert np.isfinite(levelled_torque_Nm(mixed)).all()
