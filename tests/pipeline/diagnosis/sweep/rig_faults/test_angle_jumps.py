"""An angle that leaps with the torque is told from one that noise or a spike throws about."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.rig_faults.angle_jumps import leaps_of

ROWS = 30
LOADED = History(np.arange(ROWS) * 0.5, np.zeros(ROWS, int), np.zeros(ROWS, int))
CREEPS = 20.0 * np.arange(ROWS)
"""Arcsec: 20 a row."""


def leaping(*places: int) -> np.ndarray:
    angle = CREEPS.copy()
    for k, place in enumerate(places):
        angle[place:] += 1000.0 + 500.0 * k
    return angle


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_leaps_are_said_with_their_sizes_and_torques(sense: float) -> None:
    loaded = History(sense * LOADED.torque_Nm, LOADED.unit, LOADED.cycle)
    leaps = leaps_of(loaded, sense * leaping(8, 15, 24))
    assert leaps is not None
    assert leaps.count == 3
    # the 20 arcsec of their rows are in them
    assert leaps.sizes_arcsec == pytest.approx((1020.0, 2020.0))
    assert sorted(np.abs(leaps.torques_Nm)) == pytest.approx([4.0, 12.0])
    assert leaps.usual_arcsec == pytest.approx(20.0)


def test_noise_spikes_and_a_single_jolt_are_no_leaps() -> None:
    rng = np.random.default_rng(8)
    assert leaps_of(LOADED, CREEPS + rng.normal(0, 1000.0, ROWS)) is None
    spikes = CREEPS.copy()
    spikes[[6, 14, 22]] += 2000.0
    assert leaps_of(LOADED, spikes) is None
    assert leaps_of(LOADED, leaping(12)) is None
    assert leaps_of(LOADED, CREEPS) is None
