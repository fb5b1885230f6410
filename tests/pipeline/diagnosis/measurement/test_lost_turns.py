"""Turns of torque while a logger paused: where they were, and when nobody can say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_known_ways import LARGEST_Nm, rests, sine, triangle

from flexspline.pipeline.diagnosis.causes.operators import stops
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.lost_rows import losses
from flexspline.pipeline.diagnosis.measurement.lost_turns import turned_unseen
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_rate

ROWS, CYCLES, STEP_s = 1600, 4, 0.1
TURN = 500
"""Row of the first turn down of the second cycle."""
THRESHOLD_Nm = 5.0


def whole(programme: Callable[[np.ndarray], np.ndarray], noise_Nm: float, seed: int = 1) -> History:
    turn = np.arange(ROWS) * CYCLES / ROWS
    noise = noise_Nm * np.random.default_rng(seed).normal(size=ROWS)
    none = np.zeros(ROWS, int)
    return History(
        LARGEST_Nm * programme(turn) + noise, none, turn.astype(int), STEP_s * np.arange(ROWS)
    )


def without(history: History, first: int, last: int) -> History:
    rows = np.arange(len(history))
    return history.rows((rows < first) | (rows > last))


@pytest.mark.parametrize("noise_Nm", [1e-6, 0.02, 0.4])
@pytest.mark.parametrize("seed", range(4))
def test_a_turn_in_a_pause_is_where_the_ways_meet(noise_Nm: float, seed: int) -> None:
    paused = without(whole(triangle, noise_Nm, seed), TURN - 20, TURN + 12)
    found = turned_unseen(paused)
    changed = np.flatnonzero(found != paused.torque_Nm)
    assert changed.tolist() == [TURN - 21]
    # two lines of 60 rows, followed over 20 and 13 rows: each off by 0.5 of the noise there at most
    assert found[TURN - 21] == pytest.approx(LARGEST_Nm, abs=3 * 0.6 * noise_Nm + 1e-6)


def test_friction_remembers_the_turn_that_nobody_wrote() -> None:
    """A stop driven by all rows, against one driven by the rows that are left."""
    history = whole(triangle, 1e-9)
    paused, seen = without(history, TURN - 20, TURN + 12), slice(TURN - 20, TURN + 40)
    limit = np.array([THRESHOLD_Nm])
    true = without(history.rows(np.ones(ROWS, bool)), TURN - 20, TURN + 12)
    kept = np.isin(history.time_s, true.time_s)  # type: ignore[arg-type]
    state = stops(history, history.torque_Nm, limit, np.zeros(1))[kept]
    with_turn = stops(paused, turned_unseen(paused), limit, np.zeros(1))
    without_it = stops(paused, paused.torque_Nm, limit, np.zeros(1))
    assert np.abs(with_turn - state).max() < 1e-6
    assert np.abs(without_it - state)[seen].max() > THRESHOLD_Nm / 2


@pytest.mark.parametrize("programme", [sine, rests])
def test_a_bent_way_and_a_hold_tell_no_turn(programme: Callable[[np.ndarray], np.ndarray]) -> None:
    paused = without(whole(programme, 0.02), TURN - 20, TURN + 12)
    assert (turned_unseen(paused) == paused.torque_Nm).all()


def test_a_pause_on_a_ramp_is_no_turn() -> None:
    paused = without(whole(triangle, 0.02), TURN + 40, TURN + 70)
    assert (turned_unseen(paused) == paused.torque_Nm).all()


def test_a_rig_that_stood_still_at_its_turn_has_not_gone_on() -> None:
    history = whole(triangle, 0.02)
    time = history.time_s + 400.0 * (np.arange(ROWS) >= TURN)  # type: ignore[operator]
    stood = replace(history, time_s=time)
    assert (turned_unseen(stood) == stood.torque_Nm).all()


@pytest.mark.parametrize("rest_s", [0.5, 4.0, 60.0])
def test_a_rig_that_stood_at_a_small_turn_has_not_gone_on(rest_s: float) -> None:
    """Cycles of 30 and 12 N·m; no row is written while torque rests, as by a logger that compresses."""
    turn = np.arange(ROWS) * CYCLES / ROWS
    amplitude = np.where(turn.astype(int) % 2, 0.4, 1.0)
    history = whole(triangle, 0.02)
    rests = rest_s * np.floor(2 * turn + 0.5)
    stood = replace(
        history, torque_Nm=amplitude * history.torque_Nm, time_s=STEP_s * np.arange(ROWS) + rests
    )
    assert len(losses(stood.time_s, stood.torque_Nm)) == 2 * CYCLES  # type: ignore[arg-type]
    assert (turned_unseen(stood) == stood.torque_Nm).all()


def test_a_rest_that_is_lost_with_what_is_about_it_has_not_gone_on() -> None:
    """Of a small cycle's trapezoid: the ways beside it meet above what its other rest says."""
    turn = np.arange(ROWS) * CYCLES / ROWS
    amplitude = np.where(turn.astype(int) % 2, 0.4, 1.0)
    trapezoid = np.clip(1.5 * whole(triangle, 1e-6).torque_Nm, -LARGEST_Nm, LARGEST_Nm)
    history = replace(whole(triangle, 1e-6), torque_Nm=amplitude * trapezoid)
    paused = without(history, TURN - 40, TURN + 55)  # the rest takes 33 rows on either side
    assert (turned_unseen(paused) == paused.torque_Nm).all()


@pytest.mark.parametrize("seed", range(4))
def test_random_times_lose_no_rows(seed: int) -> None:
    t = np.cumsum(np.random.default_rng(seed).exponential(0.1, 2000))
    assert len(losses(t, np.sin(t))) == 0


@pytest.mark.parametrize("seed", range(4))
def test_pauses_say_nothing_of_how_fast_torque_moves(seed: int) -> None:
    history = whole(triangle, 0.4, seed)
    paused = history
    for first in (130, 470, 820, 1290):
        paused = without(paused, first, first + 40)
    # both are the median of rates that stand out of the noise
    assert ramp_rate(paused) == pytest.approx(ramp_rate(history), rel=0.15)


def test_a_logger_that_writes_what_changes_has_lost_nothing() -> None:
    """Rests written every second, and a ramp's ends only."""
    t = np.r_[np.arange(60.0), 70 + np.arange(60.0)]
    torque = np.r_[np.zeros(60), np.full(60, 20.0)]
    assert len(losses(t, torque)) == 0
