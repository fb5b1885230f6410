"""An output that sticks stays where it is in a hold; vibration, slow noise and the torque's noise do not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.torque_program import holds
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.jumps import Jumps, encoder_step, undithered
from flexspline.pipeline.diagnosis.sweep.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.race import run_race
from flexspline.pipeline.diagnosis.sweep.stuck import stuck_of

HELD = replace(sweep(cycles=8, rows=100, hold=25), temperature_C=None, input_angle_deg=None)
"""Sixteen holds of 25 rows, ramps of 25 rows from zero to 2 N·m."""
NOISE, TOOTH = 0.4, 4.0
"""Deviation of a reading, and a tooth's usual height [arcsec]."""


def record(angle: np.ndarray, history: History = HELD) -> Sweep:
    return Sweep(
        Path("rig.csv"), history, angle, ("",), (tuple(np.unique(history.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip


def line(torque: np.ndarray) -> np.ndarray:
    return 10.0 * torque + 30.0 * np.sign(torque)


def sticks(seed: int) -> np.ndarray:
    """(n,) teeth of about 4 arcsec, two rows long: too short for their jumps to be told from noise."""
    rng, behind, limit = np.random.default_rng(seed), 0.0, TOOTH
    out = np.empty(len(HELD))
    for k, step in enumerate(np.diff(HELD.torque_Nm, prepend=0.0)):
        behind -= 25.0 * step
        while abs(behind) > limit:
            behind = float(np.sign(behind)) * (abs(behind) - limit)
            limit = TOOTH * float(np.exp(0.4 * rng.normal()))
        out[k] = behind
    return out


def noise(seed: int, deviation: np.ndarray | float = NOISE) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=len(HELD)) * deviation


def stuck(angle: np.ndarray, history: History = HELD) -> Jumps | None:
    explained = run_race(prepare(record(line(HELD.torque_Nm) + angle, history), PREDICTION))
    return stuck_of(explained.prepared, explained.identified.fit)


def test_what_sticks_is_seen_by_where_the_holds_are() -> None:
    """Whatever friction's mean width is, they lie about it as they truly do."""
    way = sticks(5)
    each = np.array([way[rows].mean() for rows in holds(HELD)])
    side = np.sign([HELD.torque_Nm[rows].mean() for rows in holds(HELD)])
    true = np.sqrt(((each - side * (each * side).mean()) ** 2).sum() / (len(each) - 1))
    found = stuck(way + noise(2))
    assert found is not None
    # a hold's mean is known to NOISE/√25 = 0.08 of 1.1 arcsec, and zero and width are of 16 holds: 7 and 3 %
    assert found.rms_arcsec == pytest.approx(true, rel=0.1)


def test_a_record_that_sticks_is_unknown() -> None:
    assert diagnose_sweep(record(line(HELD.torque_Nm) + sticks(1) + noise(2)), PREDICTION)[
        0
    ].verdict == "unknown"  # fmt: skip


def test_vibration_of_a_drive_that_moves_is_nothing_stuck() -> None:
    moving = np.diff(HELD.torque_Nm, prepend=0.0) != 0
    assert stuck(noise(3, np.where(moving, 4 * NOISE, NOISE))) is None


def test_noise_slower_than_a_hold_is_nothing_stuck() -> None:
    """White noise through a lag of 50 rows, two holds long."""
    slow, out = noise(4, 1.0), np.zeros(len(HELD))
    for k in range(1, len(out)):
        out[k] = out[k - 1] * np.exp(-1 / 50) + slow[k] * NOISE
    assert stuck(out + noise(5)) is None


def test_noise_of_the_torque_reading_is_nothing_stuck() -> None:
    """0.04 N·m are 0.4 arcsec, and 0.08 in the mean of a hold."""
    read = replace(HELD, torque_Nm=HELD.torque_Nm + noise(6, 0.04))
    assert stuck(noise(7, 0.1), read) is None


@pytest.mark.parametrize("share", [0.0, 0.1, 0.2, 0.3, 0.5])
def test_of_a_dithered_encoder_little_follows_the_angle(share: float) -> None:
    """The mean of the rounding over noise of `share` steps, at angles all over a step."""
    step, rng = 0.5, np.random.default_rng(8)
    angle = step * (np.arange(50) + 0.5) / 50
    read = angle + share * step * rng.normal(size=(4000, 1))
    rounded = np.round(read / step) * step
    follows = np.var((rounded - angle).mean(axis=0))
    variance = float((rounded - angle).var())
    # the first harmonic has 61 % of the variance without noise, and nearly all with it
    assert 0.9 * follows <= undithered(variance, step) + step**2 * 1e-4
    assert undithered(variance, step) <= follows / 0.55 + step**2 * 1e-3


def test_the_encoder_s_step_is_the_least_difference() -> None:
    assert encoder_step(np.round(noise(9) / 0.25) * 0.25) == pytest.approx(0.25)
