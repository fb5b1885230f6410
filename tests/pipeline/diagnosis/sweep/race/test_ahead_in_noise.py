"""Friction ahead of the gap that the torque's noise hides is none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hidden.adapter import diagnose
from hidden.cases import draw_case
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.crossing.friction_ahead_guess import AheadGuess
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.race import friction_ahead_race

NOISE_Nm = 0.02
HISTORY = replace(sweep(cycles=5, rows=400, hold=0), temperature_C=None, input_angle_deg=None)


def record(friction_Nm: float) -> Sweep:
    """A gap of 60 arcsec crossed at ± friction; 0.5 arcsec and 0.02 N·m of noise."""
    rng, torque = np.random.default_rng(12), HISTORY.torque_Nm
    state, left, last = 0.0, np.empty(len(torque)), 0.0
    for k, now in enumerate(torque):
        state = float(np.clip(state + now - last, -friction_Nm, friction_Nm))
        last, left[k] = now, now - state
    angle = 10.0 * left + 30.0 * np.sign(left) + rng.normal(0, 0.5, len(torque))
    read = replace(HISTORY, torque_Nm=torque + rng.normal(0, NOISE_Nm, len(torque)))
    return Sweep(
        Path("rig.csv"), read, angle, ("",), (tuple(np.unique(HISTORY.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("friction", "seen"), [pytest.param(0.0, False, marks=pytest.mark.long), (0.3, True)]
)
def test_a_guess_that_ends_within_the_torque_s_noise_is_none(
    friction: float, seen: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However sure the guess was: rows within the noise lie on either side of the gap anyhow."""
    guess = AheadGuess(0.3 if seen else 0.02, nats=100.0)
    monkeypatch.setattr(friction_ahead_race, "first_ahead", lambda *_: guess)
    prepared = prepare(record(friction), PREDICTION)
    assert torque_noise_Nm(prepared.rig.history) == pytest.approx(NOISE_Nm, rel=0.2)
    found = friction_ahead_race.with_friction_ahead(prepared)
    assert (found is not None and found.ahead is not None) == seen


@pytest.mark.long
def test_a_gap_that_swings_with_the_temperature_is_no_friction_ahead() -> None:
    """The first guess was sure of 13 N·m, and the race found 5: what it was sure of was not there."""
    found = diagnose(draw_case(11320001, 203))
    assert [c["id"] for c in found["causes"]] == ["thermal_clearance"]
