"""What commands share: lines on stderr."""

import subprocess
import sys

import pytest
from typer.testing import CliRunner

from flexspline.results.cli import app

TWO_SPEAKERS = """
from threading import Thread
from flexspline.results.job import tell
speakers = [Thread(target=lambda: [tell("a line") for _ in range(5000)]) for _ in range(2)]
for speaker in speakers:
    speaker.start()
for speaker in speakers:
    speaker.join()
"""


def test_lines_of_two_threads_do_not_mix() -> None:
    done = subprocess.run(
        [sys.executable, "-c", TWO_SPEAKERS], capture_output=True, text=True, check=True
    )
    assert done.stderr.splitlines() == ["a line"] * 10000


@pytest.mark.parametrize(
    ("command", "resumes"),
    [("gear", True), ("study", True), ("diagnose", False), ("predict", False)],
)
def test_only_what_keeps_finished_work_promises_to_resume(
    command: str, resumes: bool, monkeypatch: pytest.MonkeyPatch, tmp_path
) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("flexspline.geometry.load.read_raw", stopped)
    more = {"diagnose": ["sweep.csv"], "predict": ["t.csv", "--model", "m.toml"]}.get(command, [])
    done = CliRunner().invoke(app, [command, "none.toml", *more])
    assert done.exit_code == 130
    assert "interrupted" in done.stderr
    assert ("resume" in done.stderr) == resumes
