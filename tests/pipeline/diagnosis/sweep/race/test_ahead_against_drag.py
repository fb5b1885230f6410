"""Friction ahead of a gap that is crossed against drag: later than the friction alone would have it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.race.friction_ahead_race import with_friction_ahead

FRICTION_Nm, COMPLIANCE, GAP_ARCSEC = 0.17, 10.0, 60.0
"""Compliance in arcsec per N·m."""
REACH_ARCSEC = 3.0
"""Of the bearing before it slips: it is a little softer than the gear."""
DRAG = 4.5e-4
"""N·m per arcsec/s. At ROWS_Nm_PER_s the gap is crossed within √(2·60·4.5e-4·0.25) = 0.12 N·m."""
ROWS_Nm_PER_s, ROW_s = 0.25, 0.25
"""The torque's rate; and the time of a row."""
QUARTERS = (40, 80, 160, 40, 80, 160)
"""Of cycles of ±2.5, 5 and 10 N·m; every 1st, 2nd and 4th row is read, 40 in each quarter."""
STEPS = 250
"""Of a row, 1 ms: a third of DRAG over the stiffnesses, the time in which the output settles."""
ANGLE_NOISE, TORQUE_NOISE_Nm = 0.5, 0.005
"""The angle's in arcsec."""


def output(torque: np.ndarray) -> np.ndarray:
    """Angle of an output whose torque is its drag's, its bearing's and the teeth's, by Euler steps.

    The bearing sticks by bristles, dF = (1 − F·sgn dx)/δ·dx; nothing has a mass.
    """
    fine = np.interp(
        np.arange((len(torque) - 1) * STEPS + 1) / STEPS, np.arange(len(torque)), torque
    )
    x, share, found = 0.0, 0.0, []
    for now in fine.tolist():
        teeth = (x - min(max(x, -GAP_ARCSEC / 2), GAP_ARCSEC / 2)) / COMPLIANCE
        move = (now - teeth - FRICTION_Nm * share) / DRAG * ROW_s / STEPS
        x += move
        share += (move - share * abs(move)) / REACH_ARCSEC
        found.append(x)
    return np.array(found[::STEPS])


def record(seed: int) -> Sweep:
    """Rows of all cycles stand at multiples of 1/16 N·m: at 0.25, the gap is half crossed in each."""
    legs = [np.r_[0:q, q:-q:-1, -q:0] for q in QUARTERS]
    torque = ROWS_Nm_PER_s * ROW_s * np.concatenate(legs)
    cycle = np.repeat(np.arange(len(legs)), [len(leg) for leg in legs])
    read = np.concatenate(
        [np.arange(len(leg)) % (q // 40) == 0 for leg, q in zip(legs, QUARTERS, strict=True)]
    )
    angle, rng, time = output(torque), np.random.default_rng(seed), ROW_s * np.arange(len(torque))
    n = int(read.sum())
    none = np.zeros(n, int)
    noisy = torque[read] + rng.normal(0, TORQUE_NOISE_Nm, n)
    history = History(noisy, none, cycle[read], time[read])
    units = (tuple(np.arange(1.0, 1 + len(legs))),)
    rows = angle[read] + rng.normal(0, ANGLE_NOISE, n)
    return Sweep(
        Path("rig.csv"), history, rows, ("",), units, np.arange(n) + 2, cycles_recorded=True
    )


@pytest.mark.parametrize("seed", [2, pytest.param(3, marks=pytest.mark.long)])
def test_rows_in_the_gap_do_not_pin_the_friction(seed: int) -> None:
    """The rows at 0.25 N·m lie in the gap; those on either side are 0.0625 N·m away."""
    prediction = Prediction(COMPLIANCE, 0.3, GAP_ARCSEC, 10.0)
    found = with_friction_ahead(prepare(record(seed), prediction))
    assert found is not None
    assert found.prepared.ahead is not None
    # an eighth of the 0.08 N·m by which the rows in the gap stand beyond it
    assert found.prepared.ahead.amplitudes[0] == pytest.approx(FRICTION_Nm, abs=0.01)
