"""A viscous element of a low power is not friction beside a lag, nor is that such an element."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, sweep
from read_sweep import as_read
from scipy.integrate import solve_ivp

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_rate, ramp_s
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.identification.dashpot import dashpot_torque_Nm

NOISE_ARCSEC = 0.2
CYCLES, ROWS = 4, 240
FASTER = np.array([0.5, 1.0, 2.0, 4.0])


def rig() -> History:
    """Triangles of four rates, without temperature and positions."""
    steady = sweep(cycles=CYCLES, rows=ROWS, hold=0)
    assert steady.time_s is not None
    steps = np.diff(steady.time_s, prepend=steady.time_s[0])
    time = np.cumsum(steps / FASTER[steady.cycle])
    return replace(steady, time_s=time, temperature_C=None, input_angle_deg=None)


def carried(history: History, most_Nm: float, power: float) -> np.ndarray:
    """(n,) torque of a dashpot η·|dq/dt|^p beside a spring, `most_Nm` at the usual rate; adaptive in time."""
    time, torque = history.time_s, history.torque_Nm
    assert time is not None
    rate = float(np.median(np.abs(np.diff(torque) / np.diff(time))))
    slope, ends = np.diff(torque) / np.diff(time), time[:-1]

    def move(t: float, e: np.ndarray) -> np.ndarray:
        now = slope[np.clip(np.searchsorted(ends, t, side="right") - 1, 0, len(slope) - 1)]
        return np.asarray(now - rate * np.sign(e) * np.abs(e / most_Nm) ** (1 / power))

    found = solve_ivp(
        move, (time[0], time[-1]), [0.0], "LSODA", time, rtol=1e-7, atol=1e-9,
        max_step=float(np.diff(time).min()),
    )  # fmt: skip
    return np.asarray(found.y[0])


@pytest.mark.parametrize(("power", "course"), [(1.0, lambda x: 1 - np.exp(-x)), (0.5, np.tanh)])
def test_a_ramp_builds_it_up_as_in_closed_form(power: float, course: np.ufunc) -> None:
    """dx/dt = 1 − x is 1 − e^(−t), dx/dt = 1 − x² the hyperbolic tangent; of a fine ramp."""
    rows, share = 4000, 0.3
    torque = np.linspace(0, LARGEST, rows)
    none = np.zeros(rows, int)
    history = History(torque, none, none, np.linspace(0, 10.0, rows), exact=True)
    most = ramp_rate(history) * share * ramp_s(history)
    found = dashpot_torque_Nm(history, np.array([power]), np.array([share]))[:, 0] / most
    past = torque / (share * LARGEST)
    # backward differences: off by half a step's change of the rate, 3.3 / 4000 / 2 of E at the most
    assert found == pytest.approx(course(past), abs=1e-3)


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("power", [0.5, pytest.param(0.6, marks=pytest.mark.long)])
def test_a_dashpot_of_a_low_power_may_be_friction_beside_a_lag_or_a_lag(power: float) -> None:
    history = rig()
    lag = carried(history, 0.08 * LARGEST, power)
    angle = PREDICTION.angle_arcsec(history) - PREDICTION.compliance * 4 * lag
    noise = np.random.default_rng(3).normal(0, NOISE_ARCSEC, len(angle))
    outcome, _ = diagnose_sweep(as_read(history, angle + noise), PREDICTION)
    sure = {c.id for c in outcome.causes if not c.alternatives}
    assert "friction_hysteresis" not in sure
    told = {name for c in outcome.causes for name in (c.id, *c.alternatives)}
    assert "rate_dependence" in told


def test_friction_beside_a_lag_is_named() -> None:
    history = rig()
    lag = carried(history, 0.08 * LARGEST, 1.0)
    state, last, slip = 0.0, 0.0, np.empty(len(history))
    for row, torque in enumerate(history.torque_Nm.tolist()):
        state = float(np.clip(state + torque - last, -0.3, 0.3))
        last, slip[row] = torque, state
    angle = PREDICTION.angle_arcsec(history) - PREDICTION.compliance * (2 * lag + slip)
    noise = np.random.default_rng(3).normal(0, NOISE_ARCSEC, len(angle))
    outcome, _ = diagnose_sweep(as_read(history, angle + noise), PREDICTION)
    assert outcome.verdict == "named"
    assert {c.id for c in outcome.causes} == {"friction_hysteresis", "rate_dependence"}
