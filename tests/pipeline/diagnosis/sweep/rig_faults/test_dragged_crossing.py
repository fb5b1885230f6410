"""A gap behind friction that is crossed against drag: no size of a race without drag is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.structure import DraggedCrossing
from flexspline.pipeline.diagnosis.sweep.diagnose import judge
from flexspline.pipeline.diagnosis.sweep.rig_faults.dragged_crossing import spread_sides
from flexspline.pipeline.diagnosis.sweep.verdict import JudgedSweep

FRICTION_Nm, COMPLIANCE, GAP_ARCSEC = 3.0, 11.0, 70.0
"""Compliance in arcsec per N·m."""
DRAG = 0.004
"""N·m per arcsec/s. At 0.5 N·m/s the gap is crossed within √(2·70·0.004·0.5) = 0.53 N·m."""
AMPLITUDES_Nm, ROWS_A_LEG = (10.0, 20.0, 6.0, 15.0), 40
RATES_Nm_PER_s = (0.5, 2.0)
STEPS = 100
"""Of a row, 7.5 to 50 ms: at most the time in which the output settles, DRAG times COMPLIANCE."""
ANGLE_NOISE = 1.0
"""In arcsec."""


def torques() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Torque, time and cycle of the rows: every amplitude at each rate, twice."""
    torque, time, cycle = [0.0], [0.0], [0]
    for rate in RATES_Nm_PER_s:
        for k, most in enumerate(AMPLITUDES_Nm * 2):
            for end in (most, -most, 0.0):
                rows = ROWS_A_LEG if end else ROWS_A_LEG // 2
                leg = np.linspace(torque[-1], end, rows + 1)[1:]
                step = abs(leg[0] - torque[-1]) / rate
                time += list(time[-1] + step * np.arange(1, rows + 1))
                torque += list(leg)
                cycle += [k + len(AMPLITUDES_Nm) * 2 * (rate > 1)] * rows
    return np.array(torque), np.array(time), np.array(cycle)


def output(torque: np.ndarray, time: np.ndarray, drag: float) -> np.ndarray:
    """Angle of an output that moves against friction and drag, its teeth beyond a gap; implicit in time.

    Without drag the output follows at once.
    """
    angle, found = 0.0, [0.0]
    for before, after, step in zip(torque[:-1], torque[1:], np.diff(time), strict=True):
        for share in np.arange(1, STEPS + 1) / STEPS:
            now = before + share * (after - before)
            beyond = angle - np.clip(angle, -GAP_ARCSEC / 2, GAP_ARCSEC / 2)
            left = now - beyond / COMPLIANCE
            drive = np.sign(left) * max(abs(left) - FRICTION_Nm, 0.0)
            stiffness = 1 / COMPLIANCE if beyond else 0.0
            angle += drive / (drag * STEPS / step + stiffness)
        found.append(angle)
    return np.array(found)


def record(drag: float, seed: int) -> Sweep:
    torque, time, cycle = torques()
    n = len(torque)
    angle = output(torque, time, drag) + np.random.default_rng(seed).normal(0, ANGLE_NOISE, n)
    history = History(torque, np.zeros(n, int), cycle, time)
    units = (tuple(np.arange(1.0, cycle.max() + 2)),)
    return Sweep(
        Path("rig.csv"), history, angle, ("",), units, np.arange(n) + 2, cycles_recorded=True
    )


def judged(drag: float, seed: int) -> JudgedSweep:
    found = judge(record(drag, seed), Prediction(COMPLIANCE, 0.3, GAP_ARCSEC, 10.0))
    assert isinstance(found, JudgedSweep)
    return found


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.long)])
def test_with_drag_no_cause_is_named_and_the_friction_is_that_of_the_gear(seed: int) -> None:
    found = judged(DRAG, seed)
    assert found.decision.verdict == "unknown"
    assert not found.decision.causes
    structure = found.decision.unexplained[0].structure
    assert isinstance(structure, DraggedCrossing)
    assert abs(structure.friction_Nm - FRICTION_Nm) < 3 * structure.std_Nm
    assert structure.std_Nm < 0.03 * FRICTION_Nm


def test_with_little_drag_the_friction_is_named() -> None:
    """A four-hundredth of the drag: the gap is crossed within 0.05 N·m, a tenth of a row."""
    found = judged(DRAG / 400, seed=1)
    assert found.decision.verdict == "named"
    (cause,) = found.decision.causes
    assert cause.ahead_Nm == pytest.approx(FRICTION_Nm, abs=3 * cause.ahead_std_Nm)


def test_the_crossing_is_that_of_the_equation_of_motion() -> None:
    """One ramp of 1 N·m/s from −10 N·m: side −1 + 2·(T − F)²/x² of the gap, 1 from T = F + x on."""
    time = np.arange(0.0, 20.01, 0.25)
    torque = time - 10
    none = np.zeros(len(time), int)
    history = History(torque, none, none, time)
    spread = np.array([0.6, 2.0])
    found = spread_sides(history, np.full(2, FRICTION_Nm), spread)
    beyond = np.maximum(torque[:, None] - FRICTION_Nm, 0.0)
    np.testing.assert_allclose(found, np.minimum(2 * beyond**2 / spread**2 - 1, 1.0), atol=1e-9)
