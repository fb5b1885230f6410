"""A bump of the curve at one torque is told as one, and leaves compliance and gap as they are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.results.diagnosis.structure_words import structure_words

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_B, K_E = 31_300.0, 44_000.0
COMPLIANCE = ARCSEC_PER_RAD * (1 / K_B + 1 / K_E)
LARGEST_Nm, NOISE_arcsec = 5.0, 0.3
ROWS, CYCLES = 220, 5


def diagnosed(path: Path, bumps: np.ndarray, seed: int, pointed: bool = False) -> Diagnosis:
    """Of a straight line with the simulated gap and these bumps (k, 3): place, half width, height.

    Raised cosines, or triangles: neither is a Gaussian.
    """
    rng = np.random.default_rng(seed)
    share = np.interp(np.arange(ROWS) / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    torque = LARGEST_Nm * np.tile(share, CYCLES)
    gap = simulated_gap()
    angle = COMPLIANCE * torque + gap / 2 * np.sign(torque)
    for place, half, height in bumps:
        near = np.clip(np.abs(torque - place) / half, 0, 1)
        angle += height * (1 - near if pointed else (1 + np.cos(np.pi * near)) / 2)
    angle += rng.normal(0, NOISE_arcsec, len(torque))
    read = torque + rng.normal(0, 0.003, len(torque))
    rows = enumerate(zip(read, angle, strict=True))
    text = "".join(f"{i // ROWS + 1},{i / 2},{t:.4f},{a:.3f}\n" for i, (t, a) in rows)
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    return diagnose_file(DESIGN, path, K_B, K_E)


def simulated_gap() -> float:
    """The simulated gap [arcsec] of the design."""
    from flexspline.pipeline.diagnosis.prediction import prediction_of

    return prediction_of(DESIGN, K_B, K_E, 0.0).gap_arcsec


@pytest.mark.parametrize(
    "bumps",
    [
        [(-2.3, 0.4, 3.2)],
        [(1.4, 0.55, 4.0)],
        pytest.param([(3.1, 0.6, -2.5), (-1.2, 0.5, 3.0)], marks=pytest.mark.long),
    ],
)
def test_a_bump_is_told_where_it_is(
    bumps: list[tuple[float, float, float]], tmp_path: Path
) -> None:
    diagnosis = diagnosed(tmp_path / "record.csv", np.array(bumps), 7)
    assert diagnosis.verdict == "unknown"
    assert not diagnosis.causes
    (first, *_) = diagnosis.outcome.unexplained
    assert first.channel == "torque_Nm"
    assert isinstance(first.structure, tuple)
    # a place is tried every 0.01 of the largest torque; noise and the other form move the best by a few
    places = [form.at_Nm for form in first.structure if form.at_Nm is not None]
    for place, _, _ in bumps:
        assert min(abs(p - place) for p in places) < 0.03 * LARGEST_Nm
    assert "a bump in the curve near" in structure_words(first)
    calibration = diagnosis.calibration
    assert calibration is not None
    assert calibration.compliance is not None
    # the noise leaves ± 0.1 arcsec of the gap; a bump of another form than Gaussian some more
    assert calibration.gap_arcsec.value == pytest.approx(simulated_gap(), abs=0.5)
    assert calibration.compliance.value == pytest.approx(COMPLIANCE, rel=0.005)


@pytest.mark.parametrize(
    ("bumps", "pointed"),
    [
        ([(1.5, 0.8, 12.0)], False),
        ([(-2.3, 0.5, 12.0)], True),
        ([(-3.5, 1.0, 25.0)], False),
        ([(0.0, 0.5, 8.0)], False),
        ([(0.0, 0.5, 8.0)], True),
        ([(3.0, 0.5, 8.0), (2.0, 0.6, 8.0)], False),
        ([(-2.0, 0.6, 12.0), (-1.5, 0.5, -6.0)], False),
    ],
)
def test_a_large_bump_leaves_nothing_else_to_say(
    bumps: list[tuple[float, float, float]], pointed: bool, tmp_path: Path
) -> None:
    """Nor does one beside the gap, and one on another's flank is told beside it."""
    diagnosis = diagnosed(tmp_path / "record.csv", np.array(bumps), 9, pointed)
    (only, *more) = diagnosis.outcome.unexplained
    assert not more
    assert not diagnosis.causes
    assert isinstance(only.structure, tuple)
    places = [form.at_Nm for form in only.structure if form.at_Nm is not None]
    assert len(places) == len(bumps)
    for place, _, _ in bumps:
        assert min(abs(p - place) for p in places) < 0.03 * LARGEST_Nm
    calibration = diagnosis.calibration
    assert calibration is not None
    assert calibration.compliance is not None
    assert calibration.gap_arcsec.value == pytest.approx(simulated_gap(), abs=0.3)
    assert calibration.compliance.value == pytest.approx(COMPLIANCE, rel=0.003)


def test_a_straight_line_has_no_bump(tmp_path: Path) -> None:
    diagnosis = diagnosed(tmp_path / "record.csv", np.empty((0, 3)), 8)
    assert diagnosis.verdict == "consistent"
