"""A diagnosis says what it read, which rows it used, and gap and compliance with their deviation."""

from __future__ import annotations

import hashlib
import json
import re
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from pypdf import PdfReader
from typer.testing import CliRunner

from flexspline.geometry.load import load_design
from flexspline.results.cli import app
from flexspline.results.diagnosis.record import diagnosis_record

CUP = EXAMPLES / "xb1-40.toml"
END_POINTS = EXAMPLES / "measured" / "size-40-end-points.csv"
SWEEP = EXAMPLES / "measured" / "xb1-40-sweep.csv"
COMPLIANCE, GAP = 11.343, 72.2
"""arcsec per N·m and arcsec, of the example with the stiffnesses below."""
SOFTER, WIDER = 0.015, 8.0
"""Within the design's uncertainty, 2 % and 13 arcsec: calibrated, and no finding."""
PER_CYCLE, CYCLES, NOISE = 80, 5, 0.3
PEAK = 2.0
SPIKES = (37, 151, 290)
"""Rows far from zero torque and from every turn."""


def diagnosed(measured: Path, out: Path, *more: str) -> str:
    words = ["diagnose", CUP, measured, "--Kb", 31329, "--Ke", 43339, "--out", out, *more]
    result = CliRunner().invoke(app, [str(w) for w in words])
    assert result.exit_code == 0, result.stderr
    return result.stdout


def triangles(rows: int, per_cycle: int) -> np.ndarray:
    """(rows,) 0 → +2 → −2 → 0 N·m; a turn falls between two rows."""
    i = np.arange(rows)
    return PEAK * (1 - 4 * np.abs(((i + 0.5) / per_cycle + 0.25) % 1 - 0.5))


def written(path: Path, torque: np.ndarray, per_cycle: int, spikes: tuple[int, ...] = ()) -> Path:
    rng = np.random.default_rng(4)
    angle = COMPLIANCE * (1 + SOFTER) * torque + (GAP + WIDER) / 2 * np.sign(torque)
    angle += rng.normal(0, NOISE, len(torque))
    angle[list(spikes)] += 40 * NOISE
    lines = [
        f"{i // per_cycle},{i},{t:.5f},{a:.4f}"
        for i, (t, a) in enumerate(zip(torque, angle, strict=True))
    ]
    path.write_text(
        "cycle,time_s,torque_Nm,angle_arcsec\n" + "\n".join(lines) + "\n", encoding="utf-8"
    )
    return path


Made = tuple[Path, np.ndarray, Path, dict, str]
"""The record, its torques, the diagnosis' folder, what it says as JSON and in words."""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    folder = tmp_path_factory.mktemp("data-used")
    torque = triangles(PER_CYCLE * CYCLES, PER_CYCLE)
    path = written(folder / "rig 7.csv", torque, PER_CYCLE, SPIKES)
    said = json.loads(diagnosed(path, folder / "out", "--json"))
    assert said["verdict"] == "consistent"
    return path, torque, folder / "out", said, diagnosed(path, folder / "out")


def text_of(out: Path) -> str:
    pages = [p.extract_text() for p in PdfReader(out / "diagnosis.pdf").pages]
    return re.sub(r"\s+", " ", " ".join(pages))


def test_the_file_and_its_hash(made: Made) -> None:
    path, _, out, said, words = made
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    assert said["measurement"] == {"file": "rig 7.csv", "sha256": digest}
    assert digest in text_of(out).replace(" ", "")
    assert digest in (out / "diagnosis.html").read_text(encoding="utf-8")
    assert digest in words


def test_rows_are_counted_by_reason(made: Made) -> None:
    _, torque, out, said, words = made
    rows, left = said["rows"], said["rows"]["left_out"]
    note = next(n for n in said["notes"] if "backlash crossing" in n)
    band = float(re.search(r"\|T\| < ([\d.]+)", note)[1])
    assert rows["read"] == len(torque)
    assert left["backlash_crossing"] == (np.abs(torque) <= band).sum()
    # a triangle turns twice a cycle; each turn takes its own row, the second of two alike, and the next
    assert left["torque_reversal"] == 2 * 2 * CYCLES
    # a quarter of a cycle comes before the first turn; a row in the crossing is counted there
    assert left["before_first_reversal"] == (torque[: PER_CYCLE // 4] > band).sum()
    assert left["outlier"] == len(SPIKES)
    assert rows["used"] + sum(left.values()) == rows["read"]
    assert f"Rows used {rows['used']} of {rows['read']}" in text_of(out)
    assert f"{len(SPIKES)} isolated outliers" in text_of(out)
    assert f"{rows['used']} of {rows['read']} rows were used" in words


def test_gap_and_compliance_with_their_deviation(made: Made) -> None:
    _, torque, out, said, words = made
    found = said["calibrated"]
    gap, compliance = found["gap_arcsec"], found["compliance_arcsec_per_Nm"]
    # least squares on zero, torque and side, over all rows beyond the crossing: (XᵀX)⁻¹σ²
    far = np.abs(torque) > 0.1 * PEAK
    columns = np.column_stack([np.ones(far.sum()), torque[far], np.sign(torque[far]) / 2])
    std = NOISE * np.sqrt(np.diag(np.linalg.inv(columns.T @ columns)))
    # some rows are left out, σ is estimated, and noise of the torque is fitted beside: half as much again
    assert std[1] < found["compliance_std_arcsec_per_Nm"] < 1.5 * std[1]
    assert std[2] < found["gap_std_arcsec"] < 1.5 * std[2]
    # three deviations: one draw of 370 lies further off
    assert compliance == pytest.approx(
        COMPLIANCE * (1 + SOFTER), abs=3 * found["compliance_std_arcsec_per_Nm"]
    )
    assert gap == pytest.approx(GAP + WIDER, abs=3 * found["gap_std_arcsec"])
    for said_where in (text_of(out), " ".join(words.split())):
        sentence = said_where.partition("Calibrated on this record: ")[2]
        first, second = re.findall(r"(?:gap|compliance) ([\d.]+) ± ([\d.]+)", sentence)[:2]
        # as many decimals as two digits of the deviation bear
        assert [float(x) for x in first] == pytest.approx([gap, found["gap_std_arcsec"]], abs=6e-4)
        assert [float(x) for x in second] == pytest.approx(
            [compliance, found["compliance_std_arcsec_per_Nm"]], abs=6e-4
        )


@pytest.mark.usefixtures("nothing_drawn")
def test_a_long_record_counts_the_rows_behind_its_means(tmp_path: Path) -> None:
    per_cycle = 4000
    torque = triangles(2 * per_cycle, per_cycle)
    path = written(tmp_path / "long.csv", torque, per_cycle)
    said = json.loads(diagnosed(path, tmp_path / "out", "--json"))
    rows = said["rows"]
    assert rows["read"] == len(torque)
    assert rows["means"] < rows["averaged"] <= rows["read"]
    assert rows["used"] + sum(rows["left_out"].values()) == rows["means"]
    assert "were read and averaged to" in said["notes"][0]
    # those in the crossing are single rows
    assert any("values with |T| <" in note for note in said["notes"])


def test_end_points_give_the_gap_common_to_all_units(tmp_path: Path) -> None:
    said = json.loads(diagnosed(END_POINTS, tmp_path, "--json"))
    found = said["calibrated"]
    assert set(found) == {"gap_arcsec", "gap_std_arcsec"}
    note = next(n for n in said["notes"] if n.startswith("common to all units"))
    off, std = (float(x) for x in re.search(r"([+-][\d.]+) ± ([\d.]+)", note).groups())
    # the note is rounded to 0.1
    assert found["gap_arcsec"] - GAP == pytest.approx(off, abs=0.1)
    assert found["gap_std_arcsec"] == pytest.approx(std, abs=0.06)
    assert f"gap {found['gap_arcsec']:.1f} ± " in text_of(tmp_path)
    assert "rows" not in said


def record_of(measured: Path) -> dict:
    """diagnosis.json without its files."""
    return diagnosis_record(diagnose_file(load_design(CUP), measured, 31329, 43339))


def sizes(said: dict) -> dict[str, float]:
    return {cause["id"]: cause["magnitude"] for cause in said["causes"]}


@pytest.fixture(scope="module")
def right() -> dict[str, float]:
    """Of the sweep as it is."""
    said = record_of(SWEEP)
    assert said["verdict"] == "named"
    return sizes(said)


WRONG_ROWS, READINGS = ((2,), (300,), (300, 301), (575,)), (250.0, 1000.0, -3000.0, 1e6)
FARTHEST = {((300, 301), -3000.0), ((575,), 1e6)}
"""Two beside each other, and the last with the largest reading."""


@pytest.mark.parametrize(
    ("rows", "reading"),
    [
        pytest.param(*pair, marks=[pytest.mark.long] * (pair not in FARTHEST))
        for pair in product(WRONG_ROWS, READINGS)
    ],
)
def test_wrong_readings_of_any_size_change_no_verdict(
    rows: tuple[int, ...], reading: float, right: dict[str, float], tmp_path: Path
) -> None:
    """One or two of 576: the sizes move by less than 2 %, a deviation of either."""
    lines = SWEEP.read_text(encoding="utf-8").splitlines()
    header = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    for row in rows:
        words = lines[header + 1 + row].split(",")
        lines[header + 1 + row] = ",".join([*words[:-1], f"{reading}"])
    path = tmp_path / "wrong.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    said = record_of(path)
    assert said["verdict"] == "named"
    assert sizes(said) == pytest.approx(right, rel=0.02)
    assert said["rows"]["left_out"].get("outlier", 0) >= len(rows) - 1  # a turn may take one
