"""What sticks is the same until torque moves on; noise of time, vibration, a lag and a misfit are not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, joined

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.race.race import run_race
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_skewness import Jumps
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_travel import scatter_along_travel

pytestmark = pytest.mark.usefixtures("causes_only")

ROWS, CYCLES = 150, 12
NOISE = 0.35
"""Deviation of a reading [arcsec]."""
TOOTH = 0.12
"""N·m: 6 % of the torque, a row and a half where a sine is steepest."""


def sine() -> History:
    turn = 2 * np.pi * np.arange(ROWS * CYCLES) / ROWS
    n = len(turn)
    cycle = np.repeat(np.arange(CYCLES), ROWS)
    one = History(2 * np.sin(turn), np.zeros(n, int), cycle, 1.0 * np.arange(n))
    return replace(joined([replace(one, temperature_C=turn, input_angle_deg=turn)]),
                   temperature_C=None, input_angle_deg=None)  # fmt: skip


SINE = sine()


def sticks(seed: int, torque: np.ndarray = SINE.torque_Nm, arcsec: float = 12.0) -> np.ndarray:
    """(n,) an output that falls behind by `arcsec` for each N·m and breaks away to nothing, at random."""
    rng, behind, limit = np.random.default_rng(seed), 0.0, TOOTH
    fine = np.concatenate([[0.0], np.interp(
        np.arange(0, len(torque) - 1 + 1e-9, 0.1), np.arange(len(torque)), torque)])  # fmt: skip
    out = np.empty(len(fine))
    for k, step in enumerate(np.diff(fine, prepend=0.0)):
        behind -= step
        if abs(behind) > limit:
            behind, limit = 0.0, TOOTH * float(rng.uniform(0.5, 1.5))
        out[k] = behind
    return arcsec * out[1::10]


def noise(seed: int, deviation: np.ndarray | float = NOISE) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=len(SINE)) * deviation


def record(added: np.ndarray) -> Sweep:
    angle = 10.0 * SINE.torque_Nm + 30.0 * np.sign(SINE.torque_Nm) + added
    return Sweep(
        Path("rig.csv"), SINE, angle, ("",), (tuple(np.arange(CYCLES) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip


def seen(added: np.ndarray) -> Jumps | None:
    explained = run_race(prepare(record(added), PREDICTION))
    return scatter_along_travel(explained.prepared, explained.identified.fit)


def test_teeth_as_short_as_a_row_are_seen_where_torque_turns() -> None:
    way = sticks(3)
    found = seen(way + noise(1))
    # about its mean each way; 24 turns, each with a state of its own: a variance good to √(2/24) = 29 %, and
    # a tooth's own course is no exponential
    rising = np.gradient(SINE.torque_Nm) > 0
    true = np.hypot(way[rising].std(), way[~rising].std()) / 2**0.5
    assert found is not None
    assert found.rms_arcsec == pytest.approx(true, rel=0.35)


def test_the_record_is_unknown() -> None:
    outcome, _ = diagnose_sweep(record(sticks(4, arcsec=20.0) + noise(2)), PREDICTION)
    assert outcome.verdict == "unknown"


def test_vibration_as_the_drive_moves_is_another_in_each_row() -> None:
    speed = np.abs(np.gradient(SINE.torque_Nm))
    assert seen(noise(5, NOISE + 3 * NOISE * speed / speed.max())) is None


def test_slow_noise_knows_time_alone() -> None:
    """White noise through a lag of six rows."""
    white, out = noise(6, 1.0), np.zeros(len(SINE))
    for k in range(1, len(out)):
        out[k] = out[k - 1] * np.exp(-1 / 6) + NOISE * white[k]
    assert seen(out + noise(7)) is None


def test_smooth_friction_leaves_nothing_that_sticks() -> None:
    """Dahl's law, none of the shapes tried in closed form: Euler steps of it with an exponent of 1.3."""
    fine = np.interp(np.arange(0, len(SINE), 0.02), np.arange(len(SINE)), SINE.torque_Nm)
    z, out = 0.0, np.empty(len(fine))
    for k, step in enumerate(np.diff(fine, prepend=0.0)):
        z += step / 0.3 * max(1 - z * np.sign(step), 0.0) ** 1.3
        out[k] = z
    assert seen(-4.0 * out[::50][: len(SINE)] + noise(8)) is None
