"""A joint that softens beyond a load is no hardening and no stiffer gear that unnamed terms take back."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.diagnose import Diagnosis

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_B, K_E = 31_300.0, 44_000.0
COMPLIANCE = ARCSEC_PER_RAD * (1 / K_B + 1 / K_E)
"""arcsec/(N·m): 56 arcsec at the largest torque."""
FALLING_Nm = (5.0, 10 / 3, 5 / 3, 5 / 6)
SLIDING_Nm, STICKING = 0.18, 8.0
"""A slider of that torque behind a spring so many times as stiff as the gear."""
GAP_arcsec, NOISE_arcsec = 64.0, 0.35


def torques(amplitudes_Nm: Sequence[float]) -> np.ndarray:
    """All amplitudes in turn, twice."""
    share = np.interp(np.arange(240) / 240, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    return np.concatenate([amplitude * share for amplitude in (*amplitudes_Nm, *amplitudes_Nm)])


def with_slider(torque: np.ndarray, sliding_Nm: float) -> np.ndarray:
    """Twist [arcsec] of the gear's spring beside a slider on a spring (Jenkins)."""
    K, found, twist, held = 1 / COMPLIANCE, [], 0.0, 0.0
    for before, now in zip([0.0, *torque], torque, strict=False):
        step = (now - before) / (K * (1 + STICKING))
        tried = held + STICKING * K * step
        if abs(tried) > sliding_Nm:
            held = np.sign(step) * sliding_Nm
            twist = (now - held) / K
        else:
            held, twist = tried, twist + step
        found.append(twist)
    return np.array(found)


def diagnosed(
    path: Path,
    knee_Nm: float,
    softer: float,
    seed: int,
    sliding_Nm: float = SLIDING_Nm,
    amplitudes_Nm: Sequence[float] = FALLING_Nm,
) -> Diagnosis:
    """Of a record whose compliance beyond the knee is so much larger, as a share."""
    rng = np.random.default_rng(seed)
    torque = torques(amplitudes_Nm)
    angle = with_slider(torque, sliding_Nm) + GAP_arcsec / 2 * np.sign(torque)
    angle += softer * COMPLIANCE * np.sign(torque) * np.maximum(np.abs(torque) - knee_Nm, 0)
    angle += rng.normal(0, NOISE_arcsec, len(torque))
    read = torque + rng.normal(0, 0.002, len(torque))
    rows = enumerate(zip(read, angle, strict=True))
    text = "".join(f"{i // 240 + 1},{i},{t:.5f},{a:.3f}\n" for i, (t, a) in rows)
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    return diagnose_file(DESIGN, path, K_B, K_E)


@pytest.mark.parametrize(
    ("knee_Nm", "softer", "seed"),
    [pytest.param(10 / 3, 0.25, 1, marks=pytest.mark.long), (2.5, 0.4, 3)],
)
def test_softening_beside_friction_is_no_hardening(
    knee_Nm: float, softer: float, seed: int, tmp_path: Path
) -> None:
    outcome = diagnosed(tmp_path / "record.csv", knee_Nm, softer, seed).outcome
    named = {cause.id for cause in outcome.causes}
    assert HARDENING not in named
    assert FRICTION in named


@pytest.mark.parametrize(
    ("knee_Nm", "seed"), [(2.5, 5), pytest.param(3.0, 5, marks=pytest.mark.long)]
)
def test_softening_alone_is_no_stiffer_gear(knee_Nm: float, seed: int, tmp_path: Path) -> None:
    """Below the knee it is as simulated, beyond it softer."""
    rising = FALLING_Nm[::-1]
    outcome = diagnosed(tmp_path / "record.csv", knee_Nm, 0.4, seed, 0, rising).outcome
    assert outcome.verdict == "unknown"
    stiffness = [c for c in outcome.causes if c.id in {SERIES, HARDENING}]
    assert all(c.id == SERIES and c.magnitude > 0 for c in stiffness)


def test_hardening_beside_friction_still_is(tmp_path: Path) -> None:
    """The same gear, stiffer beyond the knee by as much."""
    outcome = diagnosed(tmp_path / "record.csv", 10 / 3, -0.25, 4).outcome
    assert {cause.id for cause in outcome.causes} == {HARDENING, FRICTION}
