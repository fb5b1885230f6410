"""Figures and reports of every kind of measurement and verdict."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES
from PIL import Image
from pypdf import PdfReader
from typer.testing import CliRunner

from flexspline.results.cli import app
from flexspline.results.diagnosis.words import odds_words, plus_minus, title_of

CUP = EXAMPLES / "xb1-40.toml"
END_POINTS = EXAMPLES / "measured" / "size-40-end-points.csv"
COMPLIANCE, GAP = (
    11.343,
    72.2,
)  # arcsec per N·m and arcsec, of the example with the stiffnesses below


def diagnosed(measured: Path, out: Path) -> tuple[dict, str]:
    """The JSON, and the report's text."""
    words = ["diagnose", CUP, measured, "--Kb", 31329, "--Ke", 43339, "--out", out, "--json"]
    result = CliRunner().invoke(app, [str(w) for w in words])
    assert result.exit_code == 0, result.stderr
    for picture in out.glob("*.png"):
        with Image.open(picture) as image:
            data = np.asarray(image.convert("RGB"))
        for edge in (data[0], data[-1], data[:, 0], data[:, -1]):
            assert (edge == 255).all(), picture.name  # nothing is cut off at the edge
    pages = [p.extract_text() for p in PdfReader(out / "diagnosis.pdf").pages]
    return json.loads(result.stdout), re.sub(r"\s+", " ", " ".join(pages))


def sweep_file(path: Path, extra, units: int = 1, cycles: int = 5, noise: float = 0.3) -> Path:
    """Five triangles of 80 rows; `extra(torque, cycle, row, unit)` [arcsec] is added."""
    rng = np.random.default_rng(4)
    lines = ["unit,cycle,time_s,torque_Nm,angle_arcsec"]
    for u in range(units):
        for i in range(80 * cycles):
            torque = 2 * (1 - 4 * abs(((i + 0.5) / 80 + 0.25) % 1 - 0.5))
            angle = COMPLIANCE * torque + GAP / 2 * np.sign(torque) + extra(torque, i // 80, i, u)
            angle += rng.normal(0, noise)
            lines.append(f"u{u},{i // 80},{i},{torque:.5f},{angle:.4f}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_end_points(tmp_path: Path) -> None:
    said, text = diagnosed(END_POINTS, tmp_path / "out")
    assert said["verdict"] == "ambiguous"
    names = {p.name for p in (tmp_path / "out").glob("*.png")}
    assert names == {"envelope.png", "positions.png", "rivals.png"}
    for words in ("angles at both ends", "Units 4", "Unit 3 lies beyond", "What may be missing"):
        assert words in text


def test_specimens(tmp_path: Path) -> None:
    """Eight flexsplines a tenth softer than given, a percent of noise; a wall within its general
    tolerance would do that, so what the verdict should be is not this test's question."""
    rng = np.random.default_rng(1)
    K = 0.9 * 31329 * (1 + 0.01 * rng.normal(size=8))
    path = tmp_path / "specimens.csv"
    rows = [f"S{i},flexspline,30.0,{k:.0f}" for i, k in enumerate(K)]
    path.write_text(
        "specimen,part,flexspline.length_mm,stiffness_Nm_per_rad\n" + "\n".join(rows) + "\n"
    )
    said, text = diagnosed(path, tmp_path / "out")
    assert said["gain"]["unit"] == "%"
    assert said["gain"]["rmse_before"] == pytest.approx(10, abs=2)
    names = {p.name for p in (tmp_path / "out").glob("*.png")}
    assert "stiffness.png" in names
    assert "dimensions.png" not in names  # none varies
    assert "stiffness of several parts" in text
    assert "Specimens 8" in text
    assert "flexspline length" in text


def test_consistent(tmp_path: Path) -> None:
    path = sweep_file(tmp_path / "clean.csv", lambda *_: 0.0)
    said, text = diagnosed(path, tmp_path / "out")
    assert said["verdict"] == "consistent"
    assert said["causes"] == []
    assert "The measurement agrees with the simulation" in text
    assert "missing" not in text.partition("Figure")[0]
    names = {p.name for p in (tmp_path / "out").glob("*.png")}
    assert "causes.png" not in names
    assert "held_out.png" not in names


def test_unknown_says_where_the_structure_lies(tmp_path: Path) -> None:
    """A zero of its own in each cycle: in no vocabulary."""
    jump = (0.0, 9.0, -4.0, 14.0, 3.0)
    path = sweep_file(tmp_path / "jumps.csv", lambda t, cycle, *_: jump[cycle])
    said, text = diagnosed(path, tmp_path / "out")
    assert said["verdict"] == "unknown"
    assert said["unexplained"]
    assert "no known cause explains" in text
    assert (tmp_path / "out" / "causes.png").exists()  # the unnamed structure's course
    assert "explains lies in: " in text


def test_units_are_compared(tmp_path: Path) -> None:
    """A loop of 4 arcsec that turns over within 0.2 N·m, in two units of three."""

    def friction(torque: float, cycle: int, row: int, unit: int) -> float:
        rising = ((row + 0.5) / 80 + 0.25) % 1 < 0.5
        way = (torque + 2) if rising else (2 - torque)
        turned = min(1.0, way / 0.2) * 2 - 1
        return 0.0 if unit == 1 else (-2.0 if rising else 2.0) * turned

    said, text = diagnosed(sweep_file(tmp_path / "fleet.csv", friction, units=3), tmp_path / "out")
    assert said["verdict"] in {"named", "ambiguous"}  # at one rate a lag looks the same
    assert "3 units" in text
    (cause,) = said["causes"]
    assert "friction_hysteresis" in (cause["id"], *cause["alternatives"])
    shows = [entry["unit"] for entry in said["by_unit"] if entry["causes"]]
    assert cause["units"] == shows
    assert len(shows) == 2
    assert said["unit_shown"] in shows
    assert (tmp_path / "out" / "units.png").exists()


@pytest.mark.parametrize(
    ("value", "std", "text"),
    [
        (4.8449, 0.117, "4.84 ± 0.12"),
        (-0.42416, 0.00978, "−0.4242 ± 0.0098"),
        (12345.6, 78.9, "12\N{NARROW NO-BREAK SPACE}346 ± 79"),
        (3.0, 0.0, "3.000 ± 0.000"),
        (0.0, 0.0, "0 ± 0"),
    ],
)
def test_magnitudes_show_what_their_deviation_bears(value: float, std: float, text: str) -> None:
    assert plus_minus(value, std) == text


def test_odds_in_words() -> None:
    assert odds_words(np.log(20)) == "about 20 to 1"
    assert odds_words(np.log(7e4)) == "about 70\N{NARROW NO-BREAK SPACE}000 to 1"
    assert odds_words(100.0) == "more than a million to 1"


def test_titles_of_causes_that_only_specimens_show() -> None:
    wall = title_of("geometry:flexspline.wall_thickness_mm")
    assert wall == "flexspline wall thickness other than drawn"
    assert title_of("youngs_modulus").startswith("material")
