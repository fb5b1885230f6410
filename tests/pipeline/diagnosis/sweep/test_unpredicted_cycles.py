"""Causes that, learnt on the other cycles, predict nothing of those between them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.structure import MissedLevel
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.held_out import unpredicted

CYCLE = LeftOut("cycle", (2.0,))


def test_causes_that_predict_nothing_of_a_cycle_between_others_explain_nothing() -> None:
    assert unpredicted(None) is None
    assert unpredicted(Gain(CYCLE, 2.5, 2.7, 2.2, 1.0)) is None
    # near the noise a true small cause gains as little
    assert unpredicted(Gain(CYCLE, 2.5, 2.7, 2.4, 1.8)) is None
    assert unpredicted(Gain(CYCLE, 2.5, 2.7, 2.4, 1.0, stated_std=0.9)) is None
    found = unpredicted(Gain(CYCLE, 2.5, 2.7, 2.4, 1.3))
    assert found is not None
    assert found.channel == "cycle"
    assert found.structure == MissedLevel(CYCLE, 2.4, 2.5)


def test_a_random_walk_of_the_reading_is_no_drift_that_is_named() -> None:
    """Steps of 0.35 arcsec from row to row beside 0.3 of noise: 8.2 arcsec an hour were named."""
    history = replace(sweep(hold=0, rows=160), temperature_C=None, input_angle_deg=None)
    rng = np.random.default_rng(53)
    angle = 10.0 * history.torque_Nm + 30.0 * history.sign
    angle += np.cumsum(rng.normal(0, 0.35, len(angle))) + rng.normal(0, 0.3, len(angle))
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), ((1.0, 2.0, 3.0, 4.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    outcome, _ = diagnose_sweep(record, PREDICTION)
    assert outcome.verdict == "unknown"
    assert isinstance(outcome.unexplained[0].structure, MissedLevel)
