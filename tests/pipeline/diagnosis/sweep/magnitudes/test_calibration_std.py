"""What leaves a calibrated compliance open beside the noise: what friction takes at the ends of its loop."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from read_sweep import as_read

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.magnitudes.magnitudes import magnitudes
from flexspline.pipeline.diagnosis.sweep.race.race import run_race

COMPLIANCE, GAP_ARCSEC, LARGEST_Nm = 10.0, 60.0, 2.0
LOOP_ARCSEC, YIELDS_Nm, NOISE = 4.0, 0.2, 0.3


def angle(torque: np.ndarray) -> np.ndarray:
    """A stiffness, a gap, and one slider behind it that holds the output back by half the loop's width."""
    state, last, held = 0.0, 0.0, []
    for now in torque:
        state = float(np.clip(state + now - last, -YIELDS_Nm, YIELDS_Nm))
        last = now
        held.append(state / YIELDS_Nm)
    twist = COMPLIANCE * torque + GAP_ARCSEC / 2 * np.sign(torque)
    return twist - LOOP_ARCSEC / 2 * np.array(held)


@pytest.mark.parametrize("deviations", [-1.0, 0.0, 1.0])
def test_the_simulation_does_not_decide_what_no_row_tells(deviations: float) -> None:
    """Friction that takes its half loop at ±T, or leaves the chord as it is: a compliance of half/T apart.

    A design that is wrong by its stated deviation makes one of them the likelier.
    """
    leg = np.linspace(0, 1, 61)
    leg = np.concatenate([leg[1:], leg[-2::-1], -leg[1:], -leg[-2::-1]])
    torque = LARGEST_Nm * np.tile(leg, 4)
    n, rng = len(torque), np.random.default_rng(5)
    cycle = np.repeat(np.arange(4), len(leg))
    history = History(torque, np.zeros(n, int), cycle, 1.0 * np.arange(n))
    sweep = as_read(history, angle(torque) + rng.normal(0, NOISE, n))
    stated = 1.0
    prediction = Prediction(COMPLIANCE + deviations * stated, stated, GAP_ARCSEC, 5.0)
    explained = run_race(prepare(sweep, prediction))
    assert explained.identified.named == ("friction_hysteresis",)
    found = calibration_of(explained).compliance
    assert found is not None
    apart = LOOP_ARCSEC / 2 / LARGEST_Nm
    # one of the two, the other `apart` from it and w times as likely by the design: apart·√(w/(1 + w)), with
    # w = exp(−½) where the design is right, exp(−3/2) where it is nearer to the one beyond
    assert 0.42 * apart < found.std <= stated
    assert found.value == pytest.approx(COMPLIANCE, abs=2 * found.std)
    # the noise alone: of n rows, twist c·T with T even from -T to T
    alone = explained.identified.fit.calibration.compliance
    assert alone is not None
    assert alone.std < 3 * NOISE / (LARGEST_Nm * np.sqrt(n / 3))


def beside_sliders(torque: np.ndarray, spring: float, yields_Nm: Sequence[float]) -> np.ndarray:
    """Twist of a spring [N·m per arcsec] with sliders beside it, each on a spring twice as stiff."""
    stiff = 2 * spring
    held, twist, last, found = np.zeros(len(yields_Nm)), 0.0, 0.0, []
    for now in torque:
        for step in np.full(8, (now - last) / 8):  # a slider yields within a row
            free = np.abs(held) < np.array(yields_Nm)
            free |= np.sign(held) != np.sign(step)
            move = step / (spring + stiff * free.sum())
            held = np.where(free, held + stiff * move, held)
            held = np.clip(held, -np.array(yields_Nm), yields_Nm)
            twist += move
        last = now
        found.append(twist)
    return np.array(found)


@pytest.mark.parametrize("softer", [0.2, 0.3])
def test_a_spring_beside_sliders_is_within_what_is_stated(softer: float) -> None:
    """The slope of a slipped branch is the spring's, the chord is stiffer: no row says which is it."""
    spring = 1 / ((1 + softer) * COMPLIANCE)
    leg = np.linspace(0, 1, 46)
    leg = np.concatenate([leg[1:], leg[-2::-1], -leg[1:], -leg[-2::-1]])
    falling = [2.0, 1.5, 1.0, 0.6, 0.3]
    torque = np.concatenate([size * leg for size in falling])
    n, rng = len(torque), np.random.default_rng(9)
    cycle = np.repeat(np.arange(len(falling)), len(leg))
    history = History(torque, np.zeros(n, int), cycle, 1.0 * np.arange(n))
    twist = beside_sliders(torque, spring, [0.02, 0.04, 0.06])
    sweep = as_read(history, twist + GAP_ARCSEC / 2 * np.sign(torque) + rng.normal(0, 0.15, n))
    explained = run_race(prepare(sweep, Prediction(COMPLIANCE, 0.25, GAP_ARCSEC, 5.0)))
    sizes, stds = magnitudes(explained.identified)
    assert "friction_hysteresis" in sizes
    if "series_compliance" in explained.identified.named:
        assert abs(sizes["series_compliance"] - 100 * softer) < 2 * stds["series_compliance"]
        return
    found = calibration_of(explained).compliance
    assert found is not None
    assert abs(found.value - (1 + softer) * COMPLIANCE) < 2 * found.std
