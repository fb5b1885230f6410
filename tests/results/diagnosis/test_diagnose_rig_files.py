"""A file as a rig writes it, from the command line to diagnosis.json, report and prediction."""

from __future__ import annotations

import csv
import json
import unicodedata
from pathlib import Path

import numpy as np
import pytest
from bases import head
from click.testing import Result
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from pypdf import PdfReader
from typer.testing import CliRunner

from flexspline.geometry.load import load_design
from flexspline.results.cli import app
from flexspline.results.diagnosis.record import diagnosis_record

CUP = EXAMPLES / "xb1-40.toml"
SWEEP = EXAMPLES / "measured" / "xb1-40-sweep.csv"
ARCSEC_PER_COUNT = 0.05
"""A fortieth of the reading's noise: rounding to counts is not seen."""


def flexspline(*words: object) -> Result:
    return CliRunner().invoke(app, [str(w) for w in words])


def diagnosed(path: Path, *more: object) -> dict:
    words = ("--Kb", 31329, "--Ke", 43339, "--out", path.parent / "out", "--json")
    done = flexspline("diagnose", CUP, path, *words, *more)
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def rows() -> list[dict[str, str]]:
    lines = SWEEP.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(s for s in lines if not s.startswith("#")))


def german(value: float, digits: int = 6) -> str:
    return f"{value:.{digits}f}".replace(".", ",")


@pytest.fixture(scope="module")
def excel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's record by German Excel: mN·m, arc minutes, notes above, units below the header."""
    path = tmp_path_factory.mktemp("excel") / "Messung.csv"
    head = [["Prüfstand 7"], ["Zyklus-Nr.", "Zeit", "Drehmoment", "Winkel", "Temperatur", "Notiz"]]
    units = ["", "min", "mNm", "arcmin", "K", ""]
    body = [
        [
            r["cycle"], german(float(r["time_s"]) / 60, 9), german(1e3 * float(r["torque_Nm"])),
            german(float(r["angle_arcsec"]) / 60, 8), german(float(r["temperature_C"]) + 273.15), "gut",
        ]
        for r in rows()
    ]  # fmt: skip
    text = "\r\n".join(";".join(cells) for cells in [*head, units, *body]) + "\r\n"
    path.write_bytes(text.encode("cp1252"))
    return path


@pytest.fixture(scope="module")
def read(excel: Path) -> dict:
    """Its diagnosis; the files are in `out` beside it."""
    return diagnosed(excel)


def test_the_same_record_gives_the_same_causes(read: dict, tmp_path: Path) -> None:
    copy = tmp_path / SWEEP.name
    copy.write_bytes(SWEEP.read_bytes())
    plain, said = diagnosis_record(diagnose_file(load_design(CUP), copy, 31329, 43339)), read
    assert [c["id"] for c in said["causes"]] == [c["id"] for c in plain["causes"]]
    for one, other in zip(said["causes"], plain["causes"], strict=True):
        # six to nine decimals were written
        assert one["magnitude"] == pytest.approx(other["magnitude"], rel=1e-3)
    assert not any(note.startswith("columns read") for note in plain["notes"])


def test_how_it_was_read_is_said(excel: Path, read: dict) -> None:
    said = read
    columns = said["read_as"]
    assert {head: c["as"] for head, c in columns.items()} == {
        "Zyklus-Nr.": "cycle", "Zeit": "time_s", "Drehmoment": "torque_Nm", "Winkel": "angle_arcsec",
        "Temperatur": "temperature_C",
    }  # fmt: skip
    assert columns["Drehmoment"] == {"as": "torque_Nm", "unit": "mNm", "factor": 0.001}
    assert columns["Winkel"] == {"as": "angle_arcsec", "unit": "arcmin", "factor": 60.0}
    assert columns["Temperatur"] == {
        "as": "temperature_C",
        "unit": "K",
        "factor": 1.0,
        "shift": -273.15,
    }
    assert said["file_format"] == {
        "encoding": "cp1252", "separator": "semicolon", "decimal_mark": "comma", "header_line": 2,
    }  # fmt: skip
    report = " ".join(
        " ".join(
            p.extract_text() for p in PdfReader(excel.parent / "out" / "diagnosis.pdf").pages
        ).split()
    )
    assert "cp1252, columns separated by semicolon, decimal comma, header in line 2" in report
    assert '"Drehmoment" as torque_Nm, in mNm (1 mNm = 0.001 Nm)' in " ".join(said["notes"])
    assert "columns not used: Notiz" in said["notes"]


@pytest.mark.usefixtures("read")
def test_a_prediction_keeps_the_file_s_form(excel: Path) -> None:
    out = excel.parent / "out"
    model = out / "extended_model.toml"
    done = flexspline("predict", CUP, "--model", model, excel, "--out", out, "--json")
    assert done.exit_code == 0, done.stderr
    lines = (out / "prediction.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].endswith("Notiz;angle_predicted_arcsec;angle_std_arcsec")
    assert lines[1].endswith(";arcsec;arcsec")
    written = [[float(t.replace(",", ".")) for t in s.split(";")[-2:]] for s in lines[2:]]
    said = json.loads(done.stdout)
    for i, name in enumerate(("angle_arcsec", "angle_std_arcsec")):
        np.testing.assert_allclose([w[i] for w in written], said[name], atol=1e-6)
    again = out / "prediction.csv"  # what is written can be read
    done = flexspline("predict", CUP, "--model", model, again, "--out", out)
    assert done.exit_code == 0, done.stderr


@pytest.mark.usefixtures("nothing_drawn")
def test_counts_of_an_encoder(tmp_path: Path) -> None:
    path = tmp_path / "counts.csv"
    body = [
        f"{r['cycle']},{r['time_s']},{r['torque_Nm']},{r['temperature_C']},"
        f"{round(float(r['angle_arcsec']) / ARCSEC_PER_COUNT)}"
        for r in rows()
    ]
    head = "cycle,time_s,torque_Nm,temperature_C,Encoder [counts]"
    path.write_text("\n".join([head, *body]) + "\n", encoding="utf-8")
    said = diagnosed(path, "--counts-per-turn", 1_296_000 / ARCSEC_PER_COUNT)
    column = said["read_as"]["Encoder [counts]"]
    assert column["factor"] == pytest.approx(ARCSEC_PER_COUNT, rel=1e-12)
    assert {c["id"] for c in said["causes"]} == {"friction_hysteresis", "thermal_clearance"}
    done = flexspline("diagnose", CUP, path, "--out", tmp_path / "none")
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert "--counts-per-turn N" in done.stderr


@pytest.mark.usefixtures("nothing_drawn")
def test_control_characters_of_a_head_are_written_as_escapes(tmp_path: Path) -> None:
    text = head("xb1-40-sweep").decode().replace("torque_Nm", "\x16torque_Nm", 1)
    odd = tmp_path / "odd.csv"
    odd.write_text(text.replace("cycle", "cyc\x1ble", 1), encoding="utf-8")
    words = ("--Kb", 31329, "--Ke", 43339, "--out", tmp_path / "out")
    done = flexspline("diagnose", CUP, odd, *words)
    assert done.exit_code == 0, done.stderr
    assert not [c for c in done.output if unicodedata.category(c) == "Cc" and c != "\n"]
    assert "\\x16" in done.output
    assert "\\x1b" in done.output
