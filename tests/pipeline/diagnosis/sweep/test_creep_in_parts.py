"""A Kelvin element that is quick against the holds is a spring and a lag: no record tells them apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from histories import PREDICTION, sweep
from scipy.signal import lsim, lti

from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

HELD = replace(sweep(cycles=8, rows=40, hold=10), temperature_C=None, input_angle_deg=None)
TAU = 12.0
"""s: two to three of the rows 5 s apart, a quarter of a ramp of 50 s."""


def test_creep_is_a_rival_of_a_spring_and_a_lag_together() -> None:
    torque, time = HELD.torque_Nm, HELD.time_s
    # 1.5 arcsec per N·m more, by dx/dt = (1.5 T − x)/τ
    _, grown, _ = lsim(lti([1.5], [TAU, 1.0]), torque, time)
    angle = 10.0 * torque + 30.0 * np.sign(torque) + grown
    angle += np.random.default_rng(3).normal(0, 0.3, len(angle))
    record = Sweep(
        Path("rig.csv"), HELD, angle, ("",), (tuple(np.unique(HELD.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    outcome, _ = diagnose_sweep(record, PREDICTION)
    mentioned = {c.id for c in outcome.causes} | {a for c in outcome.causes for a in c.alternatives}
    assert "creep" in mentioned
