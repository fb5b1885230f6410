"""Two commands and one folder: the second is refused while the first lives, and not a moment longer."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from example_files import EXAMPLES
from typer.testing import CliRunner

from flexspline.results.cli import app
from flexspline.results.folder_lock import held_until_the_end
from flexspline.results.output_folder import folder_of

pytest.importorskip("fcntl", reason="the system has no flock: nothing is locked")
CUP = EXAMPLES / "xb1-40.toml"
HOLDER = """
import sys
from pathlib import Path
from flexspline.results.folder_lock import held_until_the_end
from flexspline.results.output_folder import folder_of
with held_until_the_end():
    folder_of(Path("design.toml"), Path(sys.argv[1]), (), shared=sys.argv[2] == "shared")
    print("mine", flush=True)
    sys.stdin.read()
"""


@contextmanager
def holder(out: Path, how: str = "alone") -> Iterator[subprocess.Popen[str]]:
    words = [sys.executable, "-c", HOLDER, str(out), how]
    with subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stdout.readline() == "mine\n"
        yield process
        process.stdin.close()


def backlash(out: Path) -> tuple[int, list[str]]:
    words = ("backlash", CUP, "--Kb", 31313, "--Ke", 43339, "--out", out)
    done = CliRunner().invoke(app, [str(w) for w in words])
    return done.exit_code, done.stderr.splitlines()


def test_the_second_is_refused_in_one_line(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with holder(out):
        status, said = backlash(out)
        assert status == 2
        assert len(said) == 1
        assert "another flexspline command is writing there" in said[0]
        assert '--out = "' in said[0]
        assert list(out.iterdir()) == []
    assert not out.exists()  # the first wrote nothing
    assert backlash(out)[0] == 0


def test_a_killed_one_leaves_no_lock(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with holder(out) as process:
        process.kill()
        process.wait()
        assert backlash(out)[0] == 0
    assert {p.name for p in out.iterdir()} == {"result.json"}


def test_studies_share_a_folder_and_nobody_else_does(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with holder(out, "shared"):
        with held_until_the_end():
            assert folder_of(tmp_path / "study.toml", out, (), shared=True) == out
        assert backlash(out)[0] == 2


def test_commands_one_after_the_other_and_in_other_folders(tmp_path: Path) -> None:
    assert backlash(tmp_path / "a")[0] == 0
    assert backlash(tmp_path / "a")[0] == 0
    with holder(tmp_path / "b"):
        assert backlash(tmp_path / "a")[0] == 0
