"""What is known of the torque between corners: how far off it is, and what it says of that itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from read_sweep import as_read

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import known_ways
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter

LARGEST_Nm, NOISE_Nm = 40.0, 0.4
Programme = Callable[[np.ndarray], np.ndarray]


def triangle(turn: np.ndarray) -> np.ndarray:
    return 2 / np.pi * np.arcsin(np.sin(2 * np.pi * turn))


def sine(turn: np.ndarray) -> np.ndarray:
    return np.sin(2 * np.pi * turn)


def rests(turn: np.ndarray) -> np.ndarray:
    """Up, rest, down through zero, rest, and back."""
    return np.interp(turn % 1, [0, 0.2, 0.3, 0.7, 0.8, 1], [0, 1, 1, -1, -1, 0])


def read(
    programme: Programme, rows: int, seed: int, noise_Nm: float = NOISE_Nm
) -> tuple[History, np.ndarray]:
    """A record of four cycles, and its true torque (n,)."""
    turn = np.arange(rows) * 4 / rows
    true = LARGEST_Nm * programme(turn)
    noise = noise_Nm * np.random.default_rng(seed).normal(size=rows)
    none = np.zeros(rows, int)
    return History(true + noise, none, turn.astype(int), 0.6 * np.arange(rows)), true


def numbers_off(history: History, true_Nm: np.ndarray) -> list[float]:
    """By how many of its deviations, squared, each number of each way is off the true torque (n,)."""
    found: list[float] = []
    for way in known_ways(history):
        off = history.torque_Nm[way.rows] - way.noise_Nm - true_Nm[way.rows]
        inner = slice(len(way.rows) // 10, -(len(way.rows) // 10))  # beside the corners
        number, *_ = np.linalg.lstsq(way.doubt_Nm[inner], off[inner])
        found += (number**2).tolist()
    return found


@pytest.mark.parametrize("programme", [triangle, sine, rests])
def test_the_torque_is_off_by_as_much_as_its_ways_say(programme: Programme) -> None:
    """Each way's error, along what its numbers may be off by: of one deviation, and independent.

    Of some 150 ways with two or more numbers each, 300 squares: their mean is 1 ± 3·√(2/300) = 0.25. What a
    corner's place is off by, a row or two, adds to it: a third.
    """
    squares: list[float] = []
    for seed in range(20):
        squares += numbers_off(*read(programme, 3000, seed))
    assert len(squares) > 250
    assert np.mean(squares) == pytest.approx(1.0, abs=0.33)


@pytest.mark.parametrize("programme", [triangle, sine, rests])
def test_no_row_is_left_out_and_few_numbers_tell_each_way(programme: Programme) -> None:
    history, true = read(programme, 6000, 1)
    ways = known_ways(history)
    # one way of nine may be refused by chance, and parabolas know its torque to 0.23 of its noise
    assert sum(len(w.rows) for w in ways) >= 0.85 * len(history)
    off = less_jitter(history).torque_Nm - true
    # half a cycle of 750 rows by two numbers: √(2/750) = 0.05 of the noise; of a sine by eight: 0.1
    assert off.std() < 0.13 * NOISE_Nm


@pytest.mark.parametrize("seed", [1, 3, 4, 5])
def test_corners_that_a_drive_rounds_are_not_taken_for_noise(seed: int) -> None:
    """Rests of 80 rows, corners rounded over 25: straight ways would be off by 1 N·m, three deviations.

    A parabola through 20 rows on either side keeps to what is between corners, and is off by half of that.
    """
    rows = 3200
    window = np.hanning(27)
    turn = np.arange(3 * rows) * 4 / rows
    smooth = np.convolve(30 * rests(turn), window / window.sum(), "same")[rows : 2 * rows]
    noise = 0.3 * np.random.default_rng(seed).normal(size=rows)
    none = np.zeros(rows, int)
    history = History(smooth + noise, none, turn[:rows].astype(int), 0.1 * np.arange(rows))
    off = less_jitter(history).torque_Nm - smooth
    assert off.std() < 0.5 * 0.3
    assert not [way for way in known_ways(history) if len(way.rows) > 100]


def test_a_bend_that_was_not_seen_makes_no_known_way() -> None:
    """The rate changes by a fifth within a way: no corner, but more than the noise of one."""
    rows = 3000
    turn = np.arange(rows) / 1500
    bent = np.interp(turn % 1, [0, 0.12, 0.25, 0.75, 1], [0, 0.53, 1, -1, 0])
    noise = 0.01 * np.random.default_rng(2).normal(size=rows)
    none = np.zeros(rows, int)
    history = History(LARGEST_Nm * bent + noise, none, turn.astype(int), 0.6 * np.arange(rows))
    off = less_jitter(history).torque_Nm - LARGEST_Nm * bent
    # a parabola over 20 rows on either side of a bend is off by 3/16 of half its change over these
    bend_Nm = LARGEST_Nm * (0.53 / 0.12 - 0.47 / 0.13) / 1500
    assert np.abs(off).max() < 3 / 16 * bend_Nm / 2 * 20 + 0.01


def test_single_readings_amid_means_count_as_such() -> None:
    """A record of 36 000 rows, averaged but where it crosses zero: its lines are those of all the readings.

    Where torque moves by little more than its noise from row to row, means are all that is kept.
    """
    squares: list[float] = []
    for seed in range(6):
        history, true = read(triangle, 36_000, seed, noise_Nm=0.05)
        assert history.time_s is not None
        short = thinned(as_read(history, np.zeros(len(history)))).history
        assert short.readings is not None
        assert short.time_s is not None
        assert set(np.unique(short.readings)) >= {1, 6}
        squares += numbers_off(short, np.interp(short.time_s, history.time_s, true))
    # some 100 squares of one deviation: 1 ± 3·√(2/80), as chance refuses a way or a record
    assert len(squares) >= 80
    assert np.mean(squares) == pytest.approx(1.0, abs=0.47)


def test_rows_of_one_time_have_no_polynomial_over_time() -> None:
    """A clock of whole minutes, a hundred rows each."""
    history, _ = read(triangle, 3000, 4)
    assert history.time_s is not None
    coarse = replace(history, time_s=np.floor(history.time_s / 60.0) * 60.0)
    assert known_ways(coarse) == []


@pytest.mark.parametrize("seed", range(6))
def test_a_pause_at_a_turn_is_no_way(seed: int) -> None:
    """Rests of a hundred ramps at each turn, not written: no way reaches over one, by however few rows."""
    history, _ = read(triangle, 1600, seed, noise_Nm=0.2)
    half = (np.arange(1600) + 100) // 200
    assert history.time_s is not None
    rested = replace(history, time_s=history.time_s + 300.0 * half)
    found = known_ways(rested)
    assert len(found) >= 6  # of nine; chance refuses 6 in 100
    for way in found:
        assert len(np.unique(half[way.rows])) == 1
        assert (np.linalg.norm(way.doubt_Nm, axis=1) < 0.21).all()
