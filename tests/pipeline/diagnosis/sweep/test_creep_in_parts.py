"""A Kelvin element that is quick against the holds is a spring and a lag: no record tells them apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import PREDICTION, sweep
from scipy.signal import lsim, lti

from flexspline.geometry.load import load_design
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


STEPS = (0.25, 0.5, 0.75, 1, 0.75, 0.5, 0.25, 0, -0.25, -0.5, -0.75, -1, -0.75, -0.5, -0.25, 0)
"""Of a cycle, over its largest torque; three tenths of each step's time the torque moves."""
ROW_S, LAG_S, COMPLIANCE, GAP_ARCSEC = 1.32, 0.15, 11.343, 72.2


def staircases() -> tuple[np.ndarray, np.ndarray]:
    """Time [s] and torque [N·m], finely, of seven cycles of three heights and three periods."""
    corners = [(0.0, 0.0)]
    for k in range(7):
        for level in STEPS:
            start, step_s = corners[-1][0], (20.0, 90.0, 45.0)[k % 3] / len(STEPS)
            torque = level * (5.0, 2.5, 3.75)[k % 3]
            corners += [(start + 0.3 * step_s, torque), (start + step_s, torque)]
    time = np.arange(0.0, corners[-1][0], ROW_S / 24)
    return time, np.interp(time, *np.transpose(corners))


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(("softer", "seed"), [(0.12, 5000), (0.3, 1)])
def test_a_spring_and_a_lag_together_are_a_rival_of_creep(
    tmp_path: Path, softer: float, seed: int
) -> None:
    """On a staircase of 250 rows, each longer than the lag, creep was named alone."""
    rng = np.random.default_rng(seed)
    time, torque = staircases()
    _, twist, _ = lsim(lti([COMPLIANCE * (1 + softer)], [LAG_S, 1.0]), torque, time)
    side = np.sign(np.round(torque, 6))
    angle = twist + side * GAP_ARCSEC / 2
    rows = slice(24, None, 24)
    read = torque[rows] + rng.normal(0, 0.0025, len(torque[rows]))
    angle = angle[rows] + rng.normal(0, 0.9, len(read))
    path = tmp_path / "rig.csv"
    body = "".join(
        f"{t:.3f},{m:.5f},{a:.2f}\n" for t, m, a in zip(time[rows], read, angle, strict=True)
    )
    path.write_text("time_s,torque_Nm,angle_arcsec\n" + body)
    outcome = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31313.5, 43275.0).outcome
    mentioned = {c.id for c in outcome.causes} | {a for c in outcome.causes for a in c.alternatives}
    assert outcome.verdict == "ambiguous"
    assert {"series_compliance", "rate_dependence"} <= mentioned
