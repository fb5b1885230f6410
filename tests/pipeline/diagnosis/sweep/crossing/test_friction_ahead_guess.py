"""The first guess of friction ahead of the teeth, on stairs of torque in noise."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.causes.operators import stops
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.sweep.crossing.friction_ahead_guess import first_ahead

ROWS, NOISE_Nm, CYCLES = 100, 0.3, 3
PER_Nm, GAP_ARCSEC, NOISE_ARCSEC = 11.3, 72.0, 0.5
BAND_Nm = 4 * NOISE_Nm
LEVELS_Nm = np.tile([3.0, 9.0, 15.0, 21.0, 27.0, 21.0, 15.0, 9.0, 3.0], CYCLES)
BOTH_WAYS_Nm = (LEVELS_Nm.reshape(CYCLES, 1, -1) * np.array([1, -1])[:, None]).ravel()


def record(friction_Nm: float, seed: int) -> tuple[History, np.ndarray]:
    """Torque read in noise, and the angle of a gear whose teeth carry what friction leaves."""
    rng = np.random.default_rng(seed)
    true = np.repeat(BOTH_WAYS_Nm, ROWS)
    cycle = np.arange(len(true)) * CYCLES // len(true)
    none, time = np.zeros(len(true), int), 0.5 * np.arange(len(true))
    exact = History(true, none, cycle, time, exact=True)
    teeth = true - stops(exact, true, np.array([max(friction_Nm, 1e-9)]), np.zeros(1))[:, 0]
    angle = PER_Nm * teeth + GAP_ARCSEC / 2 * np.sign(teeth)
    read = History(true + NOISE_Nm * rng.normal(size=len(true)), none, cycle, time)
    return read, angle + NOISE_ARCSEC * rng.normal(size=len(true))


@pytest.mark.parametrize("seed", range(4))
def test_a_gear_without_friction_has_none(seed: int) -> None:
    """No row lies between the levels beside the gap, so every place there leaves the same."""
    history, angle = record(0.0, seed)
    assert first_ahead(history, angle, GAP_ARCSEC, BAND_Nm) is None


@pytest.mark.parametrize("seed", range(4))
def test_friction_that_carries_the_gap_past_a_level_is_seen(seed: int) -> None:
    history, angle = record(6.0, seed)
    guess = first_ahead(history, angle, GAP_ARCSEC, BAND_Nm)
    assert guess is not None
    assert deadband_Nm(history) < 1.0
    # the gap is crossed between the levels 3 and 9: no row says where
    assert 3.0 < guess.friction_Nm < 9.0
