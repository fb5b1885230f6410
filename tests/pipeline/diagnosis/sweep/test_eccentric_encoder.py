"""An eccentric encoder at the output: a zero that goes on with the wave generator's angle is no drift."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.causes.kinematic_error import KINEMATIC
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.diagnose import Diagnosis

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_B, K_E = 31_300.0, 44_000.0
COMPLIANCE = ARCSEC_PER_RAD * (1 / K_B + 1 / K_E)
"""arcsec/(N·m)."""
PEAK_Nm, ROWS, ROW_s = 5.0, 90, 0.7
"""Of a cycle."""
GAP_arcsec, NOISE_arcsec = 72.0, 0.35
RATIO = 80
"""Input turns to one of the output."""


def diagnosed(folder: Path, positions_deg: list[int], zeros: np.ndarray, per_h: float) -> Diagnosis:
    """Of one cycle at each position, with its zero [arcsec], and a drift."""
    count = len(positions_deg)
    share = np.tile(np.interp(np.arange(ROWS) / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0]), count)
    torque, cycle = PEAK_Nm * share, np.repeat(np.arange(count), ROWS)
    rng, t = np.random.default_rng(7), ROW_s * np.arange(len(share))
    angle = COMPLIANCE * torque + GAP_arcsec / 2 * np.sign(torque) + zeros[cycle] + per_h * t / 3600
    angle += rng.normal(0, NOISE_arcsec, len(angle))
    rows = zip(cycle, t, np.array(positions_deg)[cycle], torque, angle, strict=True)
    text = "".join(f"{c + 1},{t:.2f},{p},{q:.4f},{a:.3f}\n" for c, t, p, q, a in rows)
    path = folder / "record.csv"
    path.write_text("cycle,time_s,input_angle_deg,torque_Nm,angle_arcsec\n" + text, "utf-8")
    return diagnose_file(DESIGN, path, K_B, K_E)


IN_ORDER = [30 * k for k in range(12)]
ALIASED = [190 * k for k in range(10)]


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    "positions_deg",
    [IN_ORDER, pytest.param([37 * k for k in range(10)], marks=pytest.mark.long), ALIASED],
)
def test_an_eccentric_encoder_is_unknown(positions_deg: list[int], tmp_path: Path) -> None:
    """An error of 120 arcsec once an output turn, over a few input turns."""
    zeros = 120 * np.sin(np.radians(np.array(positions_deg)) / RATIO + 0.4)
    outcome = diagnosed(tmp_path, positions_deg, zeros, 0.0).outcome
    assert outcome.verdict == "unknown"
    assert not {c.id for c in outcome.causes} & {DRIFT, KINEMATIC}
    assert outcome.unexplained[0].channel == "input_angle_deg"


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    ("step_deg", "count"),
    [
        (37, 20),
        (90, 14),
        *(pytest.param(step, 16, marks=pytest.mark.long) for step in (45, 70, 120)),
    ],
)
def test_an_eccentric_encoder_is_unknown_where_a_rig_records_one_turn(
    step_deg: int, count: int, tmp_path: Path
) -> None:
    """Positions from 0 to 360°, over which the zero jumps at the end of each input turn."""
    turned = np.radians(step_deg * np.arange(count))
    zeros = 60 * np.sin(turned / RATIO)
    recorded = [step_deg * k % 360 for k in range(count)]
    outcome = diagnosed(tmp_path, recorded, zeros, 0.0).outcome
    assert outcome.verdict == "unknown"
    assert not {c.id for c in outcome.causes} & {DRIFT, KINEMATIC}


@pytest.mark.parametrize("step_deg", [37, pytest.param(90, marks=pytest.mark.long)])
def test_a_drift_is_one_where_a_rig_records_one_turn(step_deg: int, tmp_path: Path) -> None:
    outcome = diagnosed(
        tmp_path, [step_deg * k % 360 for k in range(14)], np.zeros(14), 40.0
    ).outcome
    assert [c.id for c in outcome.causes] == [DRIFT]
    assert outcome.verdict == "named"


def test_a_drift_is_one_with_positions_in_order(tmp_path: Path) -> None:
    """It goes on within each cycle."""
    outcome = diagnosed(tmp_path, IN_ORDER, np.zeros(12), 40.0).outcome
    assert [c.id for c in outcome.causes] == [DRIFT]
    assert outcome.verdict == "named"


def test_a_kinematic_error_is_one_with_positions_in_order(tmp_path: Path) -> None:
    zeros = 6 * np.cos(2 * np.radians(np.array(IN_ORDER)))
    outcome = diagnosed(tmp_path, IN_ORDER, zeros, 0.0).outcome
    assert [c.id for c in outcome.causes] == [KINEMATIC]
    assert outcome.verdict == "named"
