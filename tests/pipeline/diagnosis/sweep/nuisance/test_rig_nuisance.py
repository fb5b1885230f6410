"""What a rig does and no gear: a lock that gives way, ringing, stick-slip; against closed forms."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hidden.adapter import diagnose
from hidden.cases import draw_case
from histories import PREDICTION, sweep
from read_sweep import as_read
from scipy.signal import lsim, lti

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.corners import TorqueCorner, corners_of
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.nuisance.rig_nuisance import YIELDS, giving_way, ringing
from flexspline.pipeline.diagnosis.sweep.race.race import run_race
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_skewness import Jumps, jumps_of

HELD = replace(sweep(cycles=3, rows=400, hold=100), temperature_C=None, input_angle_deg=None)
"""0.02 N·m and 5 s a row: ramps of 100 rows, holds of 100."""
TURNING = replace(sweep(cycles=3, rows=400, hold=0), temperature_C=None, input_angle_deg=None)


def line(torque: np.ndarray) -> np.ndarray:
    return 10.0 * torque + 30.0 * np.sign(torque)


def record(history, angle: np.ndarray) -> Sweep:
    return Sweep(
        Path("rig.csv"), history, angle, ("",), (tuple(np.unique(history.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip


def test_corners_of_holds_and_of_turns() -> None:
    """In shares of the ramps' rate: 1 at a hold's ends, 2 where a triangle turns; within a row."""
    held = corners_of(HELD)
    first = [(c.time_s / 5, c.change) for c in held[:4]]
    # the rows 100 to 199 hold 2 N·m; then 200 rows down, and a hold at −2 N·m
    assert [t for t, _ in first] == pytest.approx([99, 199, 399, 499], abs=1.01)
    assert [c for _, c in first] == pytest.approx([-1, -1, 1, 1], rel=0.01)
    turned = corners_of(TURNING)
    assert [c.time_s / 5 for c in turned[:3]] == pytest.approx([99, 299, 499], abs=1.01)
    assert [c.change for c in turned[:3]] == pytest.approx([-2, 2, -2], rel=0.01)


STEPS = np.array([1, 2, 1, 0, -1, -2, -1, 0.0])
"""Torques [N·m] of a staircase's holds."""


def staircase(row_s: tuple[float, ...]) -> History:
    """A cycle for each spacing of rows: eight steps of two rows, each held for eight more."""
    ramp = np.array([0.5, 1.0])
    level, torque = 0.0, []
    for to in np.tile(STEPS, len(row_s)):
        torque += [*(level + ramp * (to - level)), *np.full(8, to)]
        level = to
    each = len(torque) // len(row_s)
    none = np.zeros(len(torque), int)
    cycle = np.repeat(np.arange(len(row_s)), each)
    return History(np.array(torque), none, cycle, np.cumsum(np.repeat(row_s, each)))


def test_a_short_ramp_between_holds_has_two_corners() -> None:
    """Of two rows: torque moves from the last row of a hold to the second after it, by 0.5 N·m a row."""
    found = corners_of(staircase((1.0,)))
    # the first hold's rows are 1 to 9, of a first ramp whose beginning was not recorded
    assert [c.time_s for c in found[:5]] == pytest.approx([2, 10, 12, 20, 22])
    assert [c.change for c in found[:5]] == pytest.approx([-1, 1, -1, -1, 1])


def test_ringing_of_a_staircase_is_no_rate_dependence() -> None:
    """A mass on the gear's spring, x'' + 2ζω x' + ω²(x − T) = 0, with cycles at three rates."""
    stairs = staircase((0.2, 0.6, 1.8, 0.2, 0.6, 1.8))
    assert stairs.time_s is not None
    fine = np.arange(stairs.time_s[0], stairs.time_s[-1] + 0.02, 0.02)
    omega, damping = 2 * np.pi / 1.2, 0.05  # a period of six rows of the quickest cycles
    drive = np.interp(fine, stairs.time_s, stairs.torque_Nm)
    mass = lti([omega**2], [1, 2 * damping * omega, omega**2])
    swing = np.interp(stairs.time_s, fine, lsim(mass, drive, fine)[1]) - stairs.torque_Nm
    rng = np.random.default_rng(3)
    angle = line(stairs.torque_Nm) + 10.0 * swing + rng.normal(0, 0.5, len(swing))
    outcome, behind = diagnose_sweep(record(stairs, angle), PREDICTION)
    assert outcome.verdict == "unknown"
    assert outcome.unexplained[0].structure == (UnnamedForm("rings"),)
    # the swing itself, to a quarter: a hold's swings of a ramp's two ends overlap
    kept = behind.explained.prepared.kept
    assert outcome.unexplained[0].rms == pytest.approx(10.0 * swing[kept].std(), rel=0.25)
    assert outcome.gain is not None
    assert outcome.gain.noise_floor < outcome.gain.rmse_after


def test_a_sine_has_no_corners() -> None:
    t = np.arange(1200)
    sine = replace(TURNING, torque_Nm=2 * np.sin(2 * np.pi * t / 400))
    assert corners_of(sine) == []


def test_a_ring_after_a_corner_is_among_the_columns() -> None:
    """change·exp(−ζωt)·sin(ωt√(1 − ζ²)), t from the corner: in the span of two columns."""
    damping, corners = 0.05, corners_of(TURNING)
    period = 15.0 * 1.12**6  # three rows of 5 s, and six steps of the grid
    omega = 2 * np.pi / period
    rung = np.zeros(len(TURNING))
    for c in corners:
        t = TURNING.time_s - c.time_s
        wave = np.exp(-damping * omega * t) * np.sin(omega * np.sqrt(1 - damping**2) * t)
        rung += c.change * np.where(t >= 0, wave, 0.0)
    pairs = [columns for _, _, columns in ringing(FitContext(PREDICTION, TURNING))]
    left = min(
        float(np.linalg.norm(rung - p @ np.linalg.lstsq(p, rung, rcond=None)[0])) for p in pairs
    )
    assert left < 1e-9 * np.linalg.norm(rung)
    assert isinstance(corners[0], TorqueCorner)


def test_a_lock_that_follows_beyond_its_capacity_is_among_the_columns() -> None:
    """s = clip(s, T − C, T + C): it moves beyond the capacity C and stays where it is."""
    capacity, at = YIELDS[2] * 2.0, 0.0
    way = np.empty(len(HELD))
    for k, torque in enumerate(HELD.torque_Nm):
        at = min(max(at, torque - capacity), torque + capacity)
        way[k] = at
    columns = [c[:, 0] for _, _, c in giving_way(FitContext(PREDICTION, HELD))]
    assert min(np.abs(c - way).max() for c in columns) < 1e-12


@pytest.mark.usefixtures("causes_only")
def test_a_lock_that_creeps_on_is_no_friction_and_no_creep() -> None:
    """Held at 2 N·m it goes on by 0.04 arcsec a second for 500 s; creep would come back at zero."""
    rng = np.random.default_rng(1)
    T = HELD.torque_Nm
    way = np.cumsum(5.0 * 0.1 * np.sign(T) * np.maximum(np.abs(T) - 1.6, 0.0))
    outcome, _ = diagnose_sweep(
        record(HELD, line(T) + way + rng.normal(0, 0.5, len(T))), PREDICTION
    )
    assert outcome.verdict == "unknown"
    assert outcome.unexplained[0].channel == "torque_amplitude"
    assert outcome.unexplained[0].structure == (UnnamedForm("gives_way"),)


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    ("kind", "number"),
    [
        ("lock_slips", 2),
        pytest.param("lock_yields", 1, marks=pytest.mark.long),
        ("ringing", 1),
        pytest.param("stick_slip", 4, marks=pytest.mark.long),
    ],
)
def test_hidden_in_a_made_up_record_it_has_no_name(kind: str, number: int) -> None:
    assert diagnose(draw_case(71, number, "foreign", kind))["verdict"] == "unknown"


def saw_tooth(sign: float) -> np.ndarray:
    """(n,) 4 arcsec behind the motion, then there at once, at places drawn at random."""
    rng, behind, limit = np.random.default_rng(6), 0.0, 4.0
    out = np.empty(len(TURNING))
    for k, step in enumerate(np.diff(TURNING.torque_Nm, prepend=0.0)):
        behind -= 50.0 * step
        if abs(behind) > limit:
            behind, limit = 0.0, 4.0 * float(np.exp(0.4 * rng.normal()))
        out[k] = sign * behind
    return out


def jumps(added: np.ndarray, step: float = 0.0) -> Jumps | None:
    rng = np.random.default_rng(7)
    angle = line(TURNING.torque_Nm) + added + rng.normal(0, 0.4, len(TURNING))
    angle = np.round(angle / step) * step if step else angle
    explained = run_race(prepare(record(TURNING, angle), PREDICTION))
    return jumps_of(explained.prepared, explained.identified.fit)


def test_random_stick_slip_jumps_with_the_motion() -> None:
    found = jumps(saw_tooth(1.0))
    assert found is not None
    # ramps from 0 to heights h, log-normal about 4 with the log's deviation 0.4: E[h^k] = 4^k e^(0.08 k²)
    mean, square, cube = (4**k * np.exp(0.08 * k * k) for k in (1, 2, 3))
    variance = cube / (3 * mean) - (square / (2 * mean)) ** 2
    # 110 ramps: √(2/110) of the variance, and as much again for their heights; two deviations of the rms
    assert found.rms_arcsec == pytest.approx(np.sqrt(variance), rel=0.2)


def test_jumps_every_few_rows_have_a_size() -> None:
    """They pass for white noise; an rms of 0 beside a p-value of 1e-100 says nothing."""
    once = sweep(cycles=6, rows=240, hold=0)
    history = replace(once, torque_Nm=10 * once.torque_Nm)  # 3.3 arcsec a row
    free, rng, limit = line(history.torque_Nm), np.random.default_rng(0), 10.0
    out, stuck = np.empty_like(free), free[0]
    for k, angle in enumerate(free):
        if abs(angle - stuck) > limit:
            stuck, limit = angle - np.sign(angle - stuck), 8 + 6 * rng.random()
        out[k] = stuck + 0.05 * (angle - stuck)
    out += rng.normal(0, 0.6, len(out))
    explained = run_race(prepare(record(history, out), PREDICTION))
    found = jumps_of(explained.prepared, explained.identified.fit)
    assert found is not None
    # a saw-tooth of 11 arcsec at the mean; a few rows each, so 20 %
    assert found.rms_arcsec == pytest.approx(11 / np.sqrt(12), rel=0.2)


@pytest.mark.parametrize("step", [0.0, 0.8])
def test_noise_and_an_encoder_s_steps_are_no_jumps(step: float) -> None:
    assert jumps(np.zeros(len(TURNING)), step) is None


def test_jumps_against_the_motion_are_none() -> None:
    assert jumps(saw_tooth(-1.0)) is None


@pytest.mark.parametrize("rows_a_second", [10, pytest.param(100, marks=pytest.mark.long)])
def test_corners_by_a_clock_of_whole_seconds(rows_a_second: int) -> None:
    """On both sides of a corner all rows may have one time; LAPACK once ended in a traceback there."""
    history = replace(sweep(cycles=2, rows=240, hold=0), temperature_C=None, input_angle_deg=None)
    coarse = replace(history, time_s=np.floor(np.arange(len(history)) / rows_a_second))
    times = [corner.time_s for corner in corners_of(coarse)]
    assert np.isfinite(times).all()
    angle = line(coarse.torque_Nm) + np.random.default_rng(4).normal(0, 0.3, len(coarse))
    assert diagnose_sweep(as_read(coarse, angle), PREDICTION)[0].verdict == "consistent"
