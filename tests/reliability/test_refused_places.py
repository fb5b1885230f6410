"""Places that no file can be written to: named in one line, and nothing replaced."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from flexspline.results.atomic import write_together
from flexspline.results.cli import app

CUP = Path(__file__).parents[2] / "examples" / "xb1-40.toml"


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
