"""Long records made shorter: what a mean over a block of rows must not take away."""

from __future__ import annotations

import numpy as np
from read_sweep import as_read

from flexspline.pipeline.diagnosis.causes.operators import play
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.thinning import MOST_FIT_ROWS, thinned

LARGEST_Nm, FRICTION_Nm = 2.0, 0.2
ROWS, CYCLES = 120_000, 4


def triangles(begun_turns: float = 0.0) -> History:
    turn = begun_turns + np.arange(ROWS) * CYCLES / ROWS
    torque = LARGEST_Nm * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * turn))
    return History(torque, np.zeros(ROWS, int), turn.astype(int), 0.1 * np.arange(ROWS))


def test_how_far_the_torque_went_stays() -> None:
    """What a play of friction remembers: means of its output are its output for the means of the torque."""
    history = triangles()
    angle = play(history, FRICTION_Nm)
    short = thinned(as_read(history, angle))
    assert len(short) < ROWS / 10
    assert np.ptp(short.history.torque_Nm) == np.ptp(history.torque_Nm)
    # a block moves by 4 · 2 Nm · 4 / 6000 rows; one that holds a turn of the play is off by an eighth of it
    a_block_Nm = 4 * LARGEST_Nm * CYCLES / MOST_FIT_ROWS
    assert np.abs(short.angle_arcsec - play(short.history, FRICTION_Nm)).max() < a_block_Nm / 4


def test_single_rows_are_no_noisier_in_temperature_than_means() -> None:
    """A gap that follows the temperature is read where it is crossed, in rows that stay single."""
    history = triangles()
    noise = np.random.default_rng(3).normal(size=ROWS)
    warm = History(history.torque_Nm, history.unit, history.cycle, history.time_s, 20.0 + noise)
    short = thinned(as_read(warm, np.zeros(ROWS))).history
    assert short.readings is not None
    assert short.temperature_C is not None
    single = short.readings == 1
    assert single.sum() > 100
    # a block has twenty rows, and so has the mean about a single row; four deviations of a deviation of 100
    assert np.std(short.temperature_C[single]) < 1 / np.sqrt(20) * (1 + 4 / np.sqrt(200))


def test_no_mean_is_taken_over_a_turn_in_noise() -> None:
    """Single readings show no corner of 0.001 N·m in 0.005 N·m of noise; means over blocks show its place."""
    history = triangles(begun_turns=0.00008)
    noise = 0.005 * np.random.default_rng(4).normal(size=ROWS)
    noisy = History(history.torque_Nm + noise, history.unit, history.cycle, history.time_s)
    short = thinned(as_read(noisy, np.zeros(ROWS)))
    assert short.went_to is not None
    kept = short.went_to >= 0
    rising = np.diff(history.torque_Nm, prepend=-1.0) > 0
    up, all_rows = (np.bincount(short.went_to[kept], w) for w in (rising[kept], None))
    # a block's noise is a fifth of what it moves by: lines of a few blocks meet some three rows off the turn,
    # of twenty; blocks that take no notice of it hold five rows of either side
    assert np.minimum(up, all_rows - up).sum() <= 3 * 2 * CYCLES


def test_the_last_digit_of_a_torque_is_no_corner() -> None:
    history = triangles()
    written = History(np.round(history.torque_Nm, 3), history.unit, history.cycle, history.time_s)
    exact, short = (thinned(as_read(h, np.zeros(ROWS))) for h in (history, written))
    assert len(short) < 1.01 * len(exact)


def test_no_unit_is_left_out_with_its_cycles() -> None:
    """Fifty units of four cycles each, and one of many cycles beside two of one each."""
    for cycles in ([4] * 50, [300, 1, 1]):
        each = [(unit, cycle) for unit, many in enumerate(cycles) for cycle in range(many)]
        rows = 150
        turn = np.tile(np.arange(rows) / rows, len(each))
        unit, cycle = np.repeat(np.array(each), rows, axis=0).T
        torque = LARGEST_Nm * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * turn))
        history = History(torque, unit, cycle, 0.1 * np.arange(len(torque)))
        short = thinned(as_read(history, np.zeros(len(torque)))).history
        assert len(short) < len(history)
        for number, many in enumerate(cycles):
            kept = short.cycle[short.unit == number]
            assert {0, many - 1} <= {*kept.tolist()}
