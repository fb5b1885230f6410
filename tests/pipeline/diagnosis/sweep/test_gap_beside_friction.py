"""A gap beyond its stated uncertainty is named beside a smaller friction, whose misfit it cannot be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, backlash
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_B, K_E = 31_300.0, 44_000.0
COMPLIANCE = ARCSEC_PER_RAD * (1 / K_B + 1 / K_E)
"""arcsec/(N·m)."""
STATED = backlash(DESIGN, K_B, K_E)
PEAK_Nm, ROWS = 5.0, 150
"""Of a cycle."""
SLIPS_Nm, WIDTH_arcsec = 0.4, 16.0
"""A loop of that width once torque has come back by twice as much as slips."""


def friction(torque_Nm: np.ndarray) -> np.ndarray:
    """(n,) twist [arcsec] behind a slider that holds SLIPS_Nm (Prandtl)."""
    held, before, twist = 0.0, 0.0, []
    for now in torque_Nm:
        held = float(np.clip(held + now - before, -SLIPS_Nm, SLIPS_Nm))
        before = now
        twist.append(-held / SLIPS_Nm * WIDTH_arcsec / 2)
    return np.array(twist)


def outcome(folder: Path, offset_arcsec: float) -> DiagnosisOutcome:
    """Of a gear whose gap is so much more than simulated."""
    share = np.interp(np.arange(ROWS) / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    torque = np.concatenate([PEAK_Nm * part * share for part in (1, 0.5) * 3])
    gap = STATED.gap_arcsec + offset_arcsec
    angle = COMPLIANCE * torque + gap / 2 * np.sign(torque) + friction(torque)
    angle += np.random.default_rng(3).normal(0, 0.4, len(angle))
    rows = enumerate(zip(torque, angle, strict=True))
    text = "".join(f"{i // ROWS + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in rows)
    path = folder / "record.csv"
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, "utf-8")
    return diagnose_file(DESIGN, path, K_B, K_E).outcome


def test_a_large_gap_is_named_beside_friction(tmp_path: Path) -> None:
    """Five deviations, as in a gear with nothing else."""
    found = outcome(tmp_path, 65.0)
    sizes = {cause.id: cause.magnitude for cause in found.causes}
    assert found.verdict != "unknown"
    assert set(sizes) == {CLEARANCE, FRICTION}
    assert sizes[CLEARANCE] == pytest.approx(65.0, abs=1.0)


def test_a_gap_within_its_uncertainty_is_not(tmp_path: Path) -> None:
    assert {cause.id for cause in outcome(tmp_path, 20.0).causes} == {FRICTION}
