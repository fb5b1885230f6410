"""An elastic part that may as well be a reading with a wrong scale."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.summary import summary
from flexspline.results.diagnosis.words import sure_words

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
K_b, K_e = 31_300.0, 44_000.0
LARGEST_Nm, ROWS, CYCLES, NOISE_arcsec = 10.0, 120, 5, 0.4
FOOT_POUND_Nm = 1.3558
"""One foot-pound in N·m, the unit's definition."""


def diagnosed(
    path: Path, softer: float = 1.0, angle_scale: float = 1.0, torque_scale: float = 1.0
) -> Diagnosis:
    """Of a gear as simulated but so many times softer, its readings scaled."""
    prediction = prediction_of(DESIGN, K_b, K_e)
    share = np.interp(np.arange(ROWS) / ROWS, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    torque = LARGEST_Nm * np.tile(share, CYCLES)
    angle = softer * prediction.compliance * torque + prediction.gap_arcsec / 2 * np.sign(torque)
    angle = angle_scale * angle + np.random.default_rng(3).normal(0, NOISE_arcsec, len(torque))
    rows = enumerate(zip(torque * torque_scale, angle, strict=True))
    text = "".join(f"{i // ROWS + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in rows)
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    return diagnose_file(DESIGN, path, K_b, K_e)


def test_gap_and_compliance_off_by_one_factor_may_be_the_angle_s_scale(tmp_path: Path) -> None:
    found = diagnosed(tmp_path / "a.csv", angle_scale=1.12)
    (cause,) = found.causes
    assert cause.id == "series_compliance"
    assert cause.or_scale == "angle"
    assert "or a wrong scale of the angle" in summary(found)
    assert sure_words(cause) == "not decided: elastic part or scale of the angle"
    assert any("gap is 1.12 times and the compliance 1.12 times" in note for note in notes(found))
    assert found.outcome.next_measurement is not None
    assert "known angle" in why(found.outcome.next_measurement, found.kind, found.causes)


def test_a_gap_as_designed_leaves_the_elastic_part(tmp_path: Path) -> None:
    found = diagnosed(tmp_path / "a.csv", softer=1.12)
    (cause,) = found.causes
    assert cause.or_scale is None
    assert sure_words(cause) == "beyond doubt"
    assert any("wrong scale of the torque reading" in note for note in notes(found))


def test_a_unit_s_factor_is_not_beyond_doubt_an_elastic_part(tmp_path: Path) -> None:
    found = diagnosed(tmp_path / "a.csv", torque_scale=1 / FOOT_POUND_Nm)
    (cause,) = found.causes
    assert cause.magnitude == pytest.approx(100 * (FOOT_POUND_Nm - 1), abs=4)  # E: 2 %, two of it
    assert sure_words(cause) == "not decided: elastic part or unit"
