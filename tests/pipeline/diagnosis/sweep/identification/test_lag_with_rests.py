"""A lag where torque rests at zero alone: no torque is held, and creep is not what the rests show.

One Kelvin element, in steps of a twentieth of a row; ramps of 50 s to 2 N·m and back, a rest after each two.
"""

from __future__ import annotations

import numpy as np
import pytest
from histories import LARGEST, PREDICTION
from read_sweep import as_read, simulated

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds, loaded_holds
from flexspline.pipeline.diagnosis.model.shape_check import fault_of
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

RAMP_S, ROW_S, FINER = 50.0, 2.0, 20
LAG, CREEP = "rate_dependence", "creep"


def run(rest_s: float, slower: tuple[float, ...], elements: dict[float, float], noise: float):
    """History and twist [arcsec] beyond the simulated one: six cycles, their ramps so many times as long.

    `elements` : share of the elastic twist of each retardation time [s].
    """
    corners, levels, ends = [0.0], [0.0], []
    for k in range(6):
        ramp = RAMP_S * slower[k % len(slower)]
        for peak in (LARGEST, -LARGEST):
            corners += list(corners[-1] + np.array([ramp, 2 * ramp, 2 * ramp + rest_s]))
            levels += [peak, 0.0, 0.0]
        ends.append(corners[-1])
    step = ROW_S / FINER
    time = np.arange(0.0, corners[-1], step)
    torque = np.interp(time, corners, levels)
    twist = np.zeros(len(time))
    for tau, share in elements.items():
        state = np.zeros(len(time))
        for i in range(1, len(time)):  # toward the mean torque of a step
            mean = (torque[i] + torque[i - 1]) / 2
            state[i] = mean + (state[i - 1] - mean) * np.exp(-step / tau)
        twist += share * PREDICTION.compliance * state
    rng = np.random.default_rng(11)
    rows = slice(None, None, FINER)
    cycle = np.searchsorted(ends, time[rows], side="right")
    read = torque[rows] + rng.normal(0, 0.002, len(cycle))
    history = History(read, np.zeros(len(cycle), int), cycle, time[rows])
    return history, twist[rows] + rng.normal(0, noise, len(cycle))


def told(
    rest_s: float, slower: tuple[float, ...], elements: dict[float, float], noise: float
) -> DiagnosisOutcome:
    history, more = run(rest_s, slower, elements, noise)
    assert holds(history)
    assert not loaded_holds(history)
    return diagnose_sweep(as_read(history, simulated(history) + more), PREDICTION)[0]


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("tau_s", [25.0, 40.0, 100.0, 250.0])
@pytest.mark.parametrize("rest_s", [20.0, 60.0])
def test_at_one_rate_a_lag_is_never_surely_creep(tau_s: float, rest_s: float) -> None:
    """Of half a ramp to five ramps, as long as or longer than the rests."""
    found = told(rest_s, (1.0,), {tau_s: 0.1}, 0.05)
    (cause,) = found.causes
    if cause.id == LAG:
        assert abs(cause.magnitude - 0.1 * PREDICTION.compliance * tau_s) < 3 * cause.magnitude_std
        return
    assert LAG in cause.alternatives
    assert found.verdict == "ambiguous"
    then = found.next_measurement
    assert then is not None
    assert {cause.id, LAG} <= set(then.causes)
    assert then.vary in ("hold", "torque_rate")


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("tau_s", [25.0, 40.0, 100.0])
def test_at_two_rates_a_lag_is_named_and_has_its_size(tau_s: float) -> None:
    found = told(20.0, (1.0, 3.0), {tau_s: 0.1}, 0.05)
    (cause,) = found.causes
    assert (found.verdict, cause.id) == ("named", LAG)
    assert abs(cause.magnitude - 0.1 * PREDICTION.compliance * tau_s) < 3 * cause.magnitude_std
    assert cause.magnitude_std < 0.1 * cause.magnitude


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(("rest_s", "slower"), [(20.0, (1.0,)), (60.0, (1.0, 3.0))])
def test_creep_over_many_decades_is_still_named(rest_s: float, slower: tuple[float, ...]) -> None:
    """3 % of the twist in each decade, from 0.3 s to 3000 s; no lags of several times stand for it."""
    per_decade = 4
    times = np.geomspace(0.3, 3000.0, 4 * per_decade + 1)
    found = told(rest_s, slower, dict.fromkeys(times.tolist(), 0.03 / per_decade), 0.05)
    assert (found.verdict, [c.id for c in found.causes]) == ("named", [CREEP])


@pytest.mark.parametrize("cause", [LAG, CREEP])
def test_their_shapes_are_read_from_a_model_file(cause: str) -> None:
    known = known_causes()[cause]
    rested, _ = run(20.0, (1.0,), {}, 0.05)
    shapes = known.shapes(FitContext(PREDICTION, rested))
    assert shapes
    assert [fault_of(known, shape, 1) for shape in shapes] == [None] * len(shapes)
