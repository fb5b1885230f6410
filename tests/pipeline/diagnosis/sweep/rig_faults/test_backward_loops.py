"""A loop that runs backwards is no gear's: the torque reading comes late."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, triangle
from histories import sweep as swept
from read_sweep import as_read

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.structure import BackwardLoop
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.rig_faults.backward_loops import backward_loop
from flexspline.pipeline.diagnosis.sweep.rig_faults.half_cycles import HalfCycles
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.structure_words import structure_words

pytestmark = pytest.mark.usefixtures("causes_only")

FINE = 2000
"""Rows of a cycle of the true course: a delay is followed to a tenth of a row that is read."""
EVERY = 10
"""Of them is read: 200 rows a cycle."""
NOISE, TORQUE_NOISE = 0.2, 0.002
"""Arcsec, N·m."""


def read_late(
    periods_s: tuple[float, ...],
    delay_s: float,
    filtered: bool,
    friction_arcsec: float = 0.0,
    every: int = EVERY,
) -> tuple[History, np.ndarray]:
    """What a rig reads of an elastic gear with a gap of 60 arcsec, its torque channel late.

    By a delay, T(t − τ), or by a first-order filter, R' = (T − R)/τ, which on a ramp is as late. With a
    Coulomb element, `friction_arcsec` wide, that slips within 0.05 N·m.
    """
    one = triangle(FINE, 0)
    torque = np.concatenate([[0.0], np.tile(one, len(periods_s))])
    time = np.concatenate([[0.0], np.cumsum(np.repeat(np.array(periods_s) / FINE, FINE))])
    if filtered:
        read = np.zeros(len(torque))
        for i in range(1, len(torque)):
            step = (time[i] - time[i - 1]) / delay_s
            middle = (torque[i] + torque[i - 1]) / 2
            read[i] = read[i - 1] + (1 - np.exp(-step)) * (middle - read[i - 1])
    else:
        read = np.interp(time - delay_s, time, torque)
    state, stuck = 0.0, np.zeros(len(torque))
    for i, step in enumerate(np.diff(torque, prepend=0.0)):
        state = min(max(state + step / 0.05, -1.0), 1.0)
        stuck[i] = state
    rng = np.random.default_rng(17)
    angle = 10.0 * torque + 30.0 * np.sign(torque) - friction_arcsec / 2 * stuck
    rows = np.arange(1, len(torque), every)
    none = np.zeros(len(rows), int)
    history = History(
        read[rows] + rng.normal(0, TORQUE_NOISE, len(rows)), none, (rows - 1) // FINE, time[rows]
    )
    return history, angle[rows] + rng.normal(0, NOISE, len(rows))


def said_of(history: History, angle: np.ndarray) -> DiagnosisOutcome:
    return diagnose_sweep(as_read(history, angle), PREDICTION)[0]


DELAY_S = 0.4
"""At 0.16 N·m/s, LARGEST in a quarter of 50 s, 0.064 N·m late: the gap is crossed within the 0.07 N·m that
decide nothing, and the two ways are 2·10·0.064 = 1.28 arcsec apart, six times the noise."""


@pytest.mark.parametrize("filtered", [False, True])
def test_a_late_torque_reading_is_said_with_its_delay(filtered: bool) -> None:
    outcome = said_of(*read_late((100.0, 50.0, 200.0, 100.0), DELAY_S, filtered))
    assert (outcome.verdict, outcome.causes) == ("unknown", ())
    (left,) = outcome.unexplained
    assert isinstance(left.structure, BackwardLoop)
    assert left.limit
    assert "torque reading lags the angle reading" in structure_words(left)
    # torque noise of 0.02 arcsec and 0.2 arcsec of 800 rows; the turns take a filter's delay off the ramps'
    assert left.structure.delay_s is not None
    delay, _ = left.structure.delay_s
    assert delay == pytest.approx(DELAY_S, rel=0.1)
    assert outcome.next_measurement is not None
    assert outcome.next_measurement.vary == "torque_rate"
    assert "the same time" in why(outcome.next_measurement, "sweep")


@pytest.mark.parametrize(
    "periods_s", [pytest.param((240.0, 60.0) * 3, marks=pytest.mark.long), (60.0,) * 4]
)
def test_a_gap_crossed_outside_its_band_is_no_noise(periods_s: tuple[float, ...]) -> None:
    """1 s late at 0.13 N·m/s, 100 rows a cycle: in every quick load the step of 60 arcsec is read where local
    polynomials over 8 rows look for noise."""
    outcome = said_of(*read_late(periods_s, 1.0, False, every=2 * EVERY))
    assert (outcome.verdict, outcome.causes) == ("unknown", ())
    (left,) = outcome.unexplained
    assert isinstance(left.structure, BackwardLoop)


def test_at_one_rate_or_without_time_no_delay_is_said() -> None:
    history, angle = read_late((50.0,) * 4, DELAY_S, False)
    for course in (history, replace(history, time_s=None)):
        outcome = said_of(course, angle)
        assert (outcome.verdict, outcome.causes) == ("unknown", ())
        (left,) = outcome.unexplained
        assert isinstance(left.structure, BackwardLoop)
        # half of the two ways' distance off their middle, less what the turns take, 3 % of a way
        assert left.rms == pytest.approx(0.64, rel=0.1)
        assert left.structure.delay_s is None


@pytest.mark.parametrize(
    ("periods_s", "likely"),
    [((100.0, 50.0, 200.0, 100.0), False), ((50.0,) * 4, True)],
)
def test_a_torque_cell_s_own_hysteresis_is_no_delay(
    periods_s: tuple[float, ...], likely: bool
) -> None:
    """Read 0.06 N·m lower while torque rises, at every rate; at one rate it may be late as well."""
    history, angle = read_late(periods_s, 1e-3, False)
    rising = np.gradient(history.torque_Nm) > 0
    read = replace(history, torque_Nm=history.torque_Nm - np.where(rising, 0.06, 0.0))
    outcome = said_of(read, angle)
    (left,) = outcome.unexplained
    assert isinstance(left.structure, BackwardLoop)
    assert "torque cell itself has hysteresis" in structure_words(left)
    assert ("lags" in structure_words(left)) == likely
    assert outcome.next_measurement is not None
    assert ("weights" in why(outcome.next_measurement, "sweep")) != likely


def test_friction_wider_than_what_a_late_reading_takes_runs_forwards() -> None:
    """10 arcsec of friction, of which the delay takes 1.28: the loops take energy."""
    outcome = said_of(*read_late((50.0,) * 4, DELAY_S, False, friction_arcsec=10.0))
    assert not any(isinstance(u.structure, BackwardLoop) for u in outcome.unexplained)


def test_only_the_quickest_loops_may_run_backwards() -> None:
    """2 arcsec of friction; 0.4 s late are 3.2 arcsec at 0.4 N·m/s, and 0.64 at a fifth of the rate."""
    outcome = said_of(*read_late((20.0,) * 3 + (100.0,) * 3, DELAY_S, False, friction_arcsec=2.0))
    assert (outcome.verdict, outcome.causes) == ("unknown", ())
    (left,) = outcome.unexplained
    assert isinstance(left.structure, BackwardLoop)
    assert left.structure.rate_Nm_per_s == pytest.approx(0.4, rel=0.05)  # of steps between rows
    assert left.structure.delay_s is not None
    delay, std = left.structure.delay_s
    assert abs(delay - DELAY_S) < std
    # neither temperature nor the wave generator's angle was recorded
    assert "gap that shrinks as the gear warms" in structure_words(left)


def test_a_cycle_without_a_loop_is_not_against_the_others() -> None:
    """Three of four ellipses run backwards, one is 0.02 arcsec wide forwards: a fraction of its deviation."""
    turn = np.linspace(0, 8 * np.pi, 800, endpoint=False)
    cycle = (turn // (2 * np.pi)).astype(int)
    history = History(LARGEST * np.sin(turn), np.zeros(800, int), cycle, turn)
    angle = PREDICTION.angle_arcsec(history)
    angle += np.where(cycle == 2, -0.01, 2.0) * np.cos(turn)
    found = backward_loop(history, angle, 0.1, Noise(NOISE**2, 0.0, 0.5))
    assert found is not None
    assert found.loops == 4


def test_loads_that_never_come_back_are_no_loops() -> None:
    """Two rates, torque that only rises in each cycle."""
    torque = np.tile(np.linspace(0.2, LARGEST, 50), 2)
    cycle = np.repeat([0, 1], 50)
    time = np.cumsum(np.repeat([1.0, 4.0], 50))
    history = History(torque, np.zeros(100, int), cycle, time)
    angle = PREDICTION.angle_arcsec(history)
    assert backward_loop(history, angle, 0.1, Noise(NOISE**2, 0.0, 0.5)) is None


def test_a_drift_runs_no_loop_backwards() -> None:
    """It is lower on the way down on one side of the gap only."""
    history, angle = read_late((50.0,) * 4, 1e-3, False)
    assert history.time_s is not None
    for rate in (-0.1, 0.1):  # 20 arcsec over the record
        outcome = said_of(history, angle + rate * history.time_s)
        assert outcome.verdict == "named"
        assert [c.id for c in outcome.causes] == ["sensor_drift"]


def test_loops_of_one_twist_take_or_give_by_the_sense_they_are_run() -> None:
    """An ellipse run one way is a lag's, and run the other way nobody's."""
    turn = np.linspace(0, 8 * np.pi, 800, endpoint=False)
    none = np.zeros(800, int)
    history = History(LARGEST * np.sin(turn), none, (turn // (2 * np.pi)).astype(int), turn)
    for sense, backward in ((-1.0, False), (1.0, True)):
        angle = PREDICTION.angle_arcsec(history) + sense * 2.0 * np.cos(turn)
        angle = angle + np.random.default_rng(2).normal(0, NOISE, 800)
        left = said_of(history, angle).unexplained
        assert any(isinstance(u.structure, BackwardLoop) for u in left) == backward


def test_a_record_without_noise_has_no_loop_of_rounding() -> None:
    history, _ = read_late((100.0, 50.0) * 3, 1e-9, False)
    torque = np.round(history.torque_Nm, 3)
    angle = 10.0 * torque + 30.0 * np.sign(torque)
    exact = replace(history, torque_Nm=torque)
    for rounding in (-1e-9, 0.0, 1e-9):  # of the loop's width
        tilted = angle + rounding * np.gradient(torque)
        assert backward_loop(exact, tilted, 0.07, Noise(0.04, 0.0, 0.5)) is None


def test_units_measured_in_turns_have_each_its_own_loads() -> None:
    """Every torque is set on three gears one after the other: rows of a unit are three apart."""
    history = swept(cycles=3)
    apart = np.repeat(np.arange(len(history)), 3)
    unit = np.tile(np.arange(3), len(history))
    of_three = replace(history.rows(apart), unit=unit)
    alone, each = HalfCycles.of(history, 0.1), HalfCycles.of(of_three, 0.1)
    assert len(alone) > 0
    assert [(of_three.unit[rows[0]], len(rows)) for rows in each.rows] == [
        (u, len(rows)) for u in range(3) for rows in alone.rows
    ]
    assert np.array_equal(each.side, np.tile(alone.side, 3))
