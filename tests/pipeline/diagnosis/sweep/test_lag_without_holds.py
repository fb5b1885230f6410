"""A lag where torque is never held: its size against the Kelvin element that made it; creep is never sure."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from histories import LARGEST, PREDICTION
from read_sweep import as_read, simulated

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import hold_s, holds
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.named_causes import named_causes
from flexspline.pipeline.diagnosis.sweep.race.race import run_race

ROWS = 160
"""Of a cycle."""
SHARE = 0.08
"""Of the elastic twist, that one Kelvin element adds when it has come to rest."""
NOISE, TORQUE_NOISE = 0.1, 0.001
"""Arcsec, 0.5 % of the twist; N·m."""

Wave = Callable[[np.ndarray], np.ndarray]
"""Torque over the largest, of turns."""


def triangle(turns: np.ndarray) -> np.ndarray:
    return np.interp(turns % 1, [0, 0.25, 0.75, 1], [0, 1, -1, 0])


def sine(turns: np.ndarray) -> np.ndarray:
    return np.asarray(np.sin(2 * np.pi * turns))


def held(turns: np.ndarray) -> np.ndarray:
    """Ramps, and a fiftieth of a cycle at either end."""
    return np.interp(turns % 1, [0, 0.24, 0.26, 0.74, 0.76, 1], [0, 1, 1, -1, -1, 0])


def run(wave: Wave, periods_s: tuple[float, ...], cycles: int, rows: int = ROWS) -> History:
    """So many cycles of each period [s], with the reading's noise."""
    count = cycles * len(periods_s)
    cycle = np.repeat(np.arange(count), rows)
    steps = np.repeat(np.array(periods_s) / rows, cycles * rows)
    turns = np.arange(count * rows) / rows
    noise = np.random.default_rng(5).normal(0, TORQUE_NOISE, len(turns))
    time_s = np.concatenate([[0.0], np.cumsum(steps)[:-1]])
    return History(LARGEST * wave(turns) + noise, np.zeros(len(turns), int), cycle, time_s)


def kelvin(history: History, wave: Wave, tau_s: float, rows: int = ROWS) -> np.ndarray:
    """Twist [arcsec] of one element under the torque itself, exact where that is linear between rows."""
    assert history.time_s is not None
    torque = LARGEST * wave(np.arange(len(history)) / rows)
    out, now = np.zeros(len(history)), 0.0
    for i, step in enumerate(np.diff(history.time_s), 1):
        decay, slope = np.exp(-step / tau_s), (torque[i] - torque[i - 1]) / step
        now = now * decay + torque[i - 1] * (1 - decay) + slope * (step - tau_s * (1 - decay))
        out[i] = now
    return SHARE * PREDICTION.compliance * out


def told(history: History, added_arcsec: np.ndarray) -> DiagnosisOutcome:
    noise = np.random.default_rng(6).normal(0, NOISE, len(history))
    sweep = as_read(history, simulated(history) + added_arcsec + noise)
    return diagnose_sweep(sweep, PREDICTION)[0]


@pytest.mark.parametrize("periods_s", [(60.0, 240.0, 960.0), (100.0, 400.0), (200.0,)])
@pytest.mark.parametrize("rows", [80, 160, 400])
def test_the_crest_of_a_sine_is_no_hold(periods_s: tuple[float, ...], rows: int) -> None:
    """Slow crests beside quick cycles, and few rows of one."""
    history = run(sine, periods_s, 2, rows)
    assert holds(history) == []
    assert hold_s(history) == 0


@pytest.mark.parametrize("rows", [160, 230, 400])
def test_a_short_hold_is_one(rows: int) -> None:
    """A fiftieth of a cycle, of three rows and more: each end of each cycle."""
    history = run(held, (200.0,), 3, rows)
    assert len(holds(history)) == 2 * len(history.cycle_slices)


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("wave", [sine, triangle])
@pytest.mark.parametrize(
    ("periods_s", "tau_s"),
    [((60.0, 240.0, 960.0), 6.0), ((60.0, 240.0, 960.0), 60.0), ((100.0, 400.0), 10.0)],
)
def test_at_several_rates_a_lag_has_its_size(
    wave: Wave, periods_s: tuple[float, ...], tau_s: float
) -> None:
    """c·lag(T) is c·T − c·τ·q: a lag of c·τ, and a spring of c, which the calibration may take.

    Within three deviations, one of which the shapes' own doubt is: 0.8 %.
    """
    history = run(wave, periods_s, 2)
    found = told(history, kelvin(history, wave, tau_s))
    lag = next(c for c in found.causes if c.id == "rate_dependence")
    assert {c.id for c in found.causes} <= {"rate_dependence", "series_compliance"}
    size = SHARE * PREDICTION.compliance * tau_s
    assert abs(lag.magnitude - size) < 3 * lag.magnitude_std
    assert lag.magnitude == pytest.approx(size, rel=0.1)


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("tau_s", [15.0, 25.0, 50.0])
def test_of_ramps_at_one_rate_a_lag_is_not_surely_friction(tau_s: float) -> None:
    """Triangles of 200 s: a loop of friction with thresholds of some spread is the lag's too."""
    history = run(triangle, (200.0,), 6)
    found = told(history, kelvin(history, triangle, tau_s))
    loops = {"friction_hysteresis", "rate_dependence"}
    loop = next(c for c in found.causes if c.id in loops)
    assert loops <= {loop.id, *loop.alternatives}
    assert found.verdict == "ambiguous"


@pytest.mark.usefixtures("causes_only")
def test_of_a_sine_at_one_rate_a_long_lag_has_its_size() -> None:
    """τ is two thirds of a ramp: of a shorter one, the loop would be as wide with two thirds of c·τ."""
    history, tau_s = run(sine, (200.0,), 6), 25.0
    found = told(history, kelvin(history, sine, tau_s))
    lag = next(c for c in found.causes if c.id == "rate_dependence")
    assert abs(lag.magnitude - SHARE * PREDICTION.compliance * tau_s) < 3 * lag.magnitude_std
    assert "friction_hysteresis" not in {c.id for c in found.causes}


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("wave", [sine, triangle])
def test_creep_without_holds_is_not_surely_a_lag(wave: Wave) -> None:
    """3 % of the twist in each decade, from 0.3 s to 3000 s."""
    history = run(wave, (60.0, 240.0, 960.0), 2)
    per_decade = 6
    times = np.geomspace(0.3, 3000.0, 4 * per_decade + 1)
    twist = sum(kelvin(history, wave, tau) for tau in times) * 0.03 / SHARE / per_decade
    found = told(history, np.asarray(twist))
    lag = next(c for c in found.causes if c.id == "rate_dependence")
    assert "creep" in lag.alternatives
    assert found.verdict == "ambiguous"


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize("tau_s", [200.0, 400.0])
def test_of_a_lag_of_a_cycle_and_more_size_and_compliance_are_within_what_is_stated(
    tau_s: float,
) -> None:
    """At one rate the record shows the twist c·T/τ that goes by: c and τ are known by the start alone."""
    history = run(sine, (200.0,), 6)
    noise = np.random.default_rng(6).normal(0, NOISE, len(history))
    added = kelvin(history, sine, tau_s)
    explained = run_race(prepare(as_read(history, simulated(history) + added + noise), PREDICTION))
    lag = next(c for c in named_causes(explained) if c.id == "rate_dependence")
    true = SHARE * PREDICTION.compliance
    assert abs(lag.magnitude - true * tau_s) < 3 * lag.magnitude_std
    found = calibration_of(explained).compliance
    assert found is not None
    assert abs(found.value - PREDICTION.compliance - true) < 3 * found.std
