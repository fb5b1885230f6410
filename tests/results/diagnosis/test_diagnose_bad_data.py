"""Measured data that cannot be: one line, exit 2, no traceback, nothing written."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import Result
from example_files import EXAMPLES
from typer.testing import CliRunner

from flexspline.pipeline.diagnosis.measurement import grid
from flexspline.results.cli import app

CUP = EXAMPLES / "xb1-40.toml"
GIVEN = ("--Kb", "31329", "--Ke", "43339")


def rows(header: str, *lines: str) -> bytes:
    return "\n".join([header, *lines]).encode() + b"\n"


def sweep_of(column: str, values: list) -> bytes:
    """Forty good rows, with one more column."""
    body = [f"{(i % 9 - 4) / 4},{i}.5,{values[i % len(values)]}" for i in range(40)]
    return rows(f"torque_Nm,angle_arcsec,{column}", *body)


GOOD = [f"{(i % 9 - 4) / 4},{10 * (i % 9 - 4)}.5" for i in range(40)]
BAD = {
    "a missing column": (rows("torque_Nm,temperature_C", *GOOD), "angle_arcsec is missing"),
    "no known column": (rows("force_N,place_mm", *GOOD), "is missing"),
    "text in numbers": (rows("torque_Nm,angle_arcsec", *GOOD, "0.5,high"), ':42: angle_arcsec = "high"'),
    "a decimal comma": (rows("torque_Nm,angle_arcsec", *GOOD, '"0,5",3'), ':42: torque_Nm = "0,5"'),
    "NaN": (rows("torque_Nm,angle_arcsec", *["nan,3"] * 4, *GOOD), ":2: 4 of 44 rows lack a reading"),
    "infinity": (rows("torque_Nm,angle_arcsec", *GOOD, *["inf,3"] * 4), "lack a reading (torque_Nm in 4)"),
    "a number beyond doubles": (rows("torque_Nm,angle_arcsec", *GOOD, "1e999,3"), '"1e999"'),
    "a number beyond any rig": (rows("torque_Nm,angle_arcsec", *GOOD, "1,1e300"), "angle_arcsec = 1e+300"),
    "a cycle beyond any rig": (sweep_of("cycle", [10**9]), ":2: cycle = 1e+09 is beyond"),
    "a temperature beyond any gear":
        (sweep_of("temperature_C", [20, 20, 1e8, 20]),
         ":4: temperature_C = 100000000 (the first of 10 such rows): must be from -273.15 to 1000 °C"),
    "a sensor's sign of a fault":
        (sweep_of("temperature_C", [21.5] * 39 + [-999]), ":41: temperature_C = -999: must be from -273.15"),
    "an underscore": (rows("torque_Nm,angle_arcsec", *GOOD, "1_0,3"), '"1_0"'),
    "an empty field": (rows("torque_Nm,angle_arcsec", *GOOD, *[",3"] * 4), ":42: 4 of 44 rows lack"),
    "one row": (rows("torque_Nm,angle_arcsec", "0.5,3"), "1 data rows"),
    "time backwards": (sweep_of("time_s", [5, 4]), ":3: time runs backwards"),
    "cycles backwards": (sweep_of("cycle", [2, 1]), "cycle numbers run backwards"),
    "half a cycle": (sweep_of("cycle", [0.5]), "not a whole number"),
    "the same column twice": (rows("torque_Nm,angle_arcsec,torque_Nm", *GOOD), "torque_Nm appears twice"),
    "mixed units": (rows("torque_Nm,angle_arcsec,torque_Nmm", *GOOD), "as torque_Nm and as torque_Nmm"),
    "a strange unit": (rows("torque_lbf,angle_arcsec", *GOOD), "column torque_lbf: accepted are"),
    "no unit": (rows("torque,angle_arcsec", *GOOD), "column torque: accepted are"),
    "fields missing": (rows("torque_Nm,angle_arcsec", *GOOD, "0.5"), ":42: 1 field where the header has 2"),
    "wrong encoding": (b"torque_Nm,angle_arcsec,\x81\n", "not text in UTF-8, cp1252, "),
    "half of sixteen-bit text": ("torque_Nm,angle_arcsec\n".encode("utf-16")[:-1], "is not; save the file"),
    "a picture": (b"\x89PNG\r\n\x1a\n\0\0", "is a picture (PNG)"),
    "a NUL byte": (rows("torque_Nm,angle_arcsec", "0.5,\0"), "NUL"),
    "an empty file": (b"", "no header line"),
    "only comments": (b"# nothing\n", "no header line"),
    "only a header": (b"torque_Nm,angle_arcsec\n", "no data rows"),
    "spaces": (b"torque_Nm angle_arcsec\n0.5 3\n", "separated by commas, semicolons or tabs"),
    "counts": (rows("torque_Nm,angle_counts", *GOOD), "--counts-per-turn"),
    "an open quote": (rows("torque_Nm,angle_arcsec", *GOOD, '"0.5,3'), "bad.csv"),
    "an empty unit": (sweep_of("unit", [""]), "unit is empty"),
    "negative end points": (
        rows("unit,torque_Nm,angle_plus_arcsec,angle_minus_arcsec", "1,-0.5,3,-3"), "must be from 1e-9",
    ),
    "a part of no gear": (rows("specimen,stiffness_Nm_per_rad,part", "1,100,bolt"), 'part = "bolt"'),
    "a stiffness of zero": (rows("specimen,stiffness_Nm_per_rad", "1,0"), "must be from 1e-12"),
}  # fmt: skip


def diagnose(measured: Path, *more: str) -> Result:
    words = [
        "diagnose",
        str(CUP),
        str(measured),
        *GIVEN,
        "--out",
        str(measured.parent / "out"),
        *more,
    ]
    return CliRunner().invoke(app, words)


def refused(done: Result, needle: str, out: Path) -> None:
    assert done.exit_code == 2
    assert isinstance(done.exception, SystemExit)  # no traceback
    assert done.stdout == ""
    lines = [s for s in done.stderr.splitlines() if not s.startswith("[")]  # stages began
    assert len(lines) == 1, lines
    assert needle in lines[0]
    assert lines[0].startswith("flexspline: ")
    assert not out.exists()


@pytest.mark.parametrize("name", BAD)
def test_bad_data_gets_one_line(name: str, tmp_path: Path) -> None:
    data, needle = BAD[name]
    path = tmp_path / "bad.csv"
    path.write_bytes(data)
    done = diagnose(path)
    refused(done, needle, tmp_path / "out")
    assert "bad.csv" in done.stderr


@pytest.mark.parametrize(
    ("head", "sign", "needle"),
    [
        ("angle_arcsec", -1, "is the sign of angle or torque reversed?"),
        ("angle_deg", 1, "angle_deg is 3"),
    ],
)
def test_an_absurd_size_gets_one_line_too(
    head: str, sign: int, needle: str, tmp_path: Path
) -> None:
    """The cup's own line, 11.3 arcsec per N·m and a gap of 72, turned or in another unit."""
    path = tmp_path / "bad.csv"
    torque = [t / 10 for t in (*range(-10, 11), *range(9, -11, -1))]
    body = [f"{t},{sign * (11.34 * t + 36 * ((t > 0) - (t < 0))):.3f}" for t in torque]
    path.write_bytes(rows(f"torque_Nm,{head}", *body))
    refused(diagnose(path, "--json"), needle, tmp_path / "out")


def test_a_missing_file_and_a_folder(tmp_path: Path) -> None:
    refused(diagnose(tmp_path / "none.csv"), "none.csv: no such file", tmp_path / "out")
    refused(diagnose(tmp_path), "directory", tmp_path / "out")


@pytest.mark.parametrize(
    ("limit", "needle"), [("LARGEST_MEASURED_BYTES", "at most 20 bytes"), ("LARGEST_ROWS", "rows")]
)
def test_a_file_far_too_large(
    limit: str, needle: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(grid, limit, 20)
    path = tmp_path / "bad.csv"
    path.write_bytes(rows("torque_Nm,angle_arcsec", *GOOD))
    refused(diagnose(path), needle, tmp_path / "out")


def test_an_evil_file_name_stays_on_one_line(tmp_path: Path) -> None:
    path = tmp_path / "two\nlines\x1b[31m.csv"
    path.write_bytes(b"")
    done = diagnose(path)
    refused(done, r"two\nlines\x1b", tmp_path / "out")


def test_a_wrong_stiffness_or_design_is_refused_first(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["diagnose", str(CUP), "none.csv", "--Kb", "-1"])
    assert done.exit_code == 2
    assert "--Kb = -1.0" in done.stderr
    done = CliRunner().invoke(app, ["diagnose", str(tmp_path / "none.toml"), "none.csv"])
    assert done.exit_code == 2
    assert "none.toml: no such file" in done.stderr


def test_a_bad_file_is_refused_before_any_solver_starts(tmp_path: Path) -> None:
    path = tmp_path / "bad.csv"
    path.write_bytes(b"torque_Nm\n1\n")
    done = CliRunner().invoke(
        app, ["diagnose", str(CUP), str(path), "--out", str(tmp_path / "out")]
    )
    refused(done, "angle_arcsec is missing", tmp_path / "out")
    assert "mesh" not in done.stderr


@pytest.mark.parametrize("torque", [["0.5"], ["0", "0.001"], ["0"]])
def test_constant_torque_is_too_little_but_no_error(torque: list[str], tmp_path: Path) -> None:
    path = tmp_path / "still.csv"
    body = [f"{torque[i % len(torque)]},{i % 7}" for i in range(60)]
    path.write_bytes(rows("torque_Nm,angle_arcsec", *body))
    done = diagnose(path, "--json")
    assert done.exit_code == 0, done.stderr
    assert '"verdict": "insufficient"' in done.stdout
    out = tmp_path / "out"
    assert {p.name for p in out.iterdir()} == {"diagnosis.json", "diagnosis.pdf", "diagnosis.html"}


def test_a_run_s_report_stays_and_an_earlier_diagnosis_goes(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    for name in ("report.pdf", "report.html", "result.json", "causes.png", "extended_model.toml"):
        (out / name).write_text("earlier")
    path = tmp_path / "still.csv"
    path.write_bytes(rows("torque_Nm,angle_arcsec", *(f"0.5,{i % 7}" for i in range(60))))
    assert diagnose(path).exit_code == 0
    own = {"diagnosis.json", "diagnosis.pdf", "diagnosis.html"}
    assert {p.name for p in out.iterdir()} == own | {"report.pdf", "report.html", "result.json"}
    assert (out / "report.pdf").read_text() == "earlier"


def test_a_text_named_as_a_workbook_is_said_to_be_none(tmp_path: Path) -> None:
    path = tmp_path / "bad.xlsx"
    path.write_bytes(b"hello")
    refused(diagnose(path), "not a workbook in spite of its name", tmp_path / "out")
