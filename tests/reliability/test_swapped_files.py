"""A file of another kind than the command asks for: the line says which file it is."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES
from typer.testing import CliRunner

from flexspline.results.cli import app

STUDY, CUP = EXAMPLES / "studies" / "grid.toml", EXAMPLES / "xb1-40.toml"


@pytest.mark.parametrize("command", ["run", "stiffness", "gear"])
def test_a_study_is_no_design(command: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, [command, str(STUDY), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert "is a key of a study file: run `flexspline study` on it" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_design_is_no_study(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["study", str(CUP), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert 'a study names its design file in design = "FILE"' in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_design_is_no_record(tmp_path: Path) -> None:
    narrow = tmp_path / "narrow.toml"  # one cell in each line: a column, as a CSV file
    narrow.write_text("[flexspline]\nlength_mm = 30.0\n", encoding="utf-8")
    for given, what in ((CUP, "a design file"), (narrow, "a design file"), (STUDY, "a TOML file")):
        out = tmp_path / "out"
        words = ["diagnose", str(CUP), str(given), "--Kb", "31329", "--Ke", "43339"]
        done = CliRunner().invoke(app, [*words, "--out", str(out)])
        assert done.exit_code == 2
        expected = f"{given}: is {what}; a measured record (CSV or .xlsx) is expected"
        assert done.stderr == f"flexspline: {expected}\n"
        assert not out.exists()


def test_a_design_is_no_model(tmp_path: Path) -> None:
    torque = tmp_path / "torque.csv"
    torque.write_text("torque_Nm\n1.0\n", encoding="utf-8")
    done = CliRunner().invoke(app, ["predict", str(CUP), "--model", str(CUP), str(torque)])
    assert done.exit_code == 2
    assert f"{CUP}: is a design file, not an extended model; `diagnose` writes" in done.stderr
