"""Creep that comes to rest within a hold: its size, against the chain of Kelvin elements that made it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
from histories import PREDICTION, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

COMPLIANCE, GAP = 10.0, 30.0
"""arcsec per N·m; arcsec: those of PREDICTION."""
RAMP_s, HOLD_s = 10.0, 900.0


def held(step_s: float) -> History:
    """Three loops, then a hold at each of five levels [N·m], each reached by a ramp."""
    levels = (0.0, 2.0, -2.0, 2.0, -2.0, 2.0, -2.0, 0.0)
    torque = [np.linspace(a, b, 40, endpoint=False) for a, b in pairwise(levels)]
    time = [np.full(40, 2 * RAMP_s / 40)] * len(torque)
    before = 0.0
    for level in (2.0, -2.0, 1.0, -1.0, 2.0):
        torque += [
            np.linspace(before, level, 20, endpoint=False),
            np.full(int(HOLD_s / step_s), level),
        ]
        time += [np.full(20, RAMP_s / 20), np.full(int(HOLD_s / step_s), step_s)]
        before = level
    rows = np.concatenate(torque)
    return replace(
        sweep(cycles=1, rows=8),
        torque_Nm=rows,
        cycle=np.zeros(len(rows), int),
        unit=np.zeros(len(rows), int),
        time_s=np.cumsum(np.concatenate(time)),
        temperature_C=None,
        input_angle_deg=None,
    )


def kelvin(history: History, share: float, tau_s: float) -> np.ndarray:
    """Twist [arcsec] of one element, exact for torque that is linear between rows."""
    assert history.time_s is not None
    torque, out, now = history.torque_Nm, np.zeros(len(history)), 0.0
    for i, step in enumerate(np.diff(history.time_s), 1):
        decay, slope = np.exp(-step / tau_s), (torque[i] - torque[i - 1]) / step
        now = now * decay + torque[i - 1] * (1 - decay) + slope * (step - tau_s * (1 - decay))
        out[i] = now
    return share * COMPLIANCE * out


THREE, FOUR, TWO = (20.0, 90.0, 400.0), (10.0, 30.0, 100.0, 300.0), (60.0, 600.0)
"""Time constants [s] of the elements."""


@pytest.mark.parametrize(
    ("taus_s", "step_s"),
    [
        (FOUR, 20.0),
        *(
            pytest.param(taus_s, step_s, marks=pytest.mark.long)
            for taus_s, step_s in product((TWO, THREE, FOUR), (3.0, 20.0))
            if (taus_s, step_s) != (FOUR, 20.0)
        ),
    ],
)
def test_twist_that_comes_to_rest_within_a_hold_has_its_size(
    taus_s: tuple[float, ...], step_s: float
) -> None:
    """The last decade of the hold adds what each element does between 90 and 900 s."""
    history, share = held(step_s), 0.04
    angle = COMPLIANCE * history.torque_Nm + GAP / 2 * np.sign(history.torque_Nm)
    angle += sum(kelvin(history, share, tau) for tau in taus_s)
    angle += np.random.default_rng(7).normal(0, 0.05, len(history))
    found = diagnose_sweep(as_read(history, angle), PREDICTION)[0]
    assert found.verdict == "named"
    (creep,) = (c for c in found.causes if c.id == "creep")
    grown = sum(np.exp(-HOLD_s / 10 / tau) - np.exp(-HOLD_s / tau) for tau in taus_s)
    expected_pct = 100 * share * float(grown)
    assert abs(creep.magnitude - expected_pct) < 2.5 * creep.magnitude_std
    assert creep.magnitude == pytest.approx(expected_pct, rel=0.12)
