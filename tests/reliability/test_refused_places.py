"""Places that no file can be written to: named in one line, and nothing replaced."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest
from example_files import EXAMPLES
from typer.testing import CliRunner

from flexspline.results.atomic import write_together
from flexspline.results.cli import app
from flexspline.results.figures.diagnosis.captions import CAPTIONS
from flexspline.results.file_names import ONE_RECORD, RUN, of_diagnosis

CUP = EXAMPLES / "xb1-40.toml"


def test_a_name_that_is_too_long_is_a_wrong_word(tmp_path: Path) -> None:
    words = ("backlash", CUP, "--Kb", 31313, "--Ke", 43339, "--out", tmp_path / ("a" * 300))
    done = CliRunner().invoke(app, [str(w) for w in words])
    assert done.exit_code == 2
    assert len(done.stderr.splitlines()) == 1
    assert "--out" in done.stderr


def test_nothing_is_replaced_where_one_place_is_a_folder(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("before")
    (tmp_path / "b.txt").mkdir()
    with pytest.raises(IsADirectoryError, match=r"b\.txt"):
        write_together(tmp_path, {"a.txt": b"after", "b.txt": b"after"})
    assert (tmp_path / "a.txt").read_text() == "before"
    assert {p.name for p in tmp_path.iterdir()} == {"a.txt", "b.txt"}


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="the system has no sticky folders")
def test_nothing_is_replaced_where_one_file_is_another_user_s(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("a.txt", "b.txt"):
        (tmp_path / name).write_text("before")
    tmp_path.chmod(0o1777)
    other = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: other)
    with pytest.raises(PermissionError, match=r"a\.txt"):
        write_together(tmp_path, {"c.txt": b"after", "a.txt": b"after", "b.txt": b"after"})
    assert {p.name: p.read_text() for p in tmp_path.iterdir()} == {
        "a.txt": "before",
        "b.txt": "before",
    }


def test_a_full_disk_is_named_by_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    words = ("backlash", CUP, "--Kb", 31313, "--Ke", 43339, "--out", out)
    done = CliRunner().invoke(app, [str(w) for w in words])
    assert done.exit_code == 1
    assert f"{out / 'result.json'}: No space left on device" in done.stderr
    assert str(CUP) not in done.stderr


STUDY_FILE = CUP.parent / "studies" / "grid.toml"
SWEEP_FILE = CUP.parent / "measured" / "xb1-40-sweep.csv"
GIVEN = ("--Kb", 31313, "--Ke", 43339)
NO_MODEL = "no-such-model.toml"
IN_THE_WAY = {
    "report.html": ("run", CUP), "gear_loads.png": ("run", CUP), "wave_generator.png": ("run", CUP),
    "result.json": ("stiffness", CUP), "gear.json": ("gear", CUP),
    "shaft_torsion.inp": ("export", CUP, "--deck"), "flexspline.msh": ("export", CUP, "--format", "msh"),
    "diagnosis.pdf": ("diagnose", CUP, SWEEP_FILE, *GIVEN),
    "causes.png": ("diagnose", CUP, SWEEP_FILE, *GIVEN),
    "prediction.csv": ("predict", CUP, SWEEP_FILE, "--model", NO_MODEL),
    "best.toml": ("study", STUDY_FILE), "study.db": ("study", STUDY_FILE),
    "sensitivity.json": ("sensitivity", CUP),
}  # fmt: skip


@pytest.mark.parametrize("name", IN_THE_WAY)
def test_a_folder_in_a_file_s_place_is_found_before_the_work(name: str, tmp_path: Path) -> None:
    (tmp_path / name).mkdir()
    words = (*IN_THE_WAY[name], "--out", tmp_path)
    done = CliRunner().invoke(app, [str(w) for w in words])
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()  # no line of progress: nothing had begun
    assert "--out" in line
    assert f"{name} is a folder" in line
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_what_a_run_writes_is_looked_at_before(finished_cup) -> None:
    assert {p.name for p in finished_cup.folder.iterdir()} <= set(RUN)


def test_what_a_diagnosis_writes_is_looked_at_before(finished_sweep) -> None:
    written = {p.name for p in finished_sweep.folder.iterdir()}
    assert written
    assert written <= set(of_diagnosis(CAPTIONS))


def test_what_a_backlash_writes_is_looked_at_before(tmp_path: Path) -> None:
    words = ("backlash", CUP, *GIVEN, "--out", tmp_path)
    done = CliRunner().invoke(app, [str(w) for w in words])
    assert done.exit_code == 0
    written = {p.name for p in tmp_path.iterdir()}
    assert written
    assert written <= set(ONE_RECORD)
