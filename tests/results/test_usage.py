"""Words of the command line that cannot be read: one line that names the word, exit status 2."""

from __future__ import annotations

from pathlib import Path

import in_process
import pytest

from flexspline.results.cli import app

WRONG = {
    "backlash": "DESIGN.toml",
    "gear cup.toml --jso": "--json",
    "stifness cup.toml": "stifness",
    "--foo": "--foo",
    "init cup --size abc": '"abc"',
    "init cup --size 20mm": '"20mm" must be a number without a unit, such as 25',
    "init cup --size 25 --ratio 1.5": '"1.5"',
    "init cup --size 25 --rated 10Nm": '"10Nm"',
    "studio --port eighty": '"eighty"',
    "export cup.toml --format": "--format",
    "backlash cup.toml more.toml": "more.toml",
    "backlash cup.toml --Kb 30.000,5": '"30.000,5"',
    "diagnose cup.toml sweep.csv --against curve": '--against\': "curve" must be sum or gear;',
}


@pytest.mark.parametrize("line", WRONG)
def test_one_line_names_what_is_wrong(line: str, tmp_path: Path) -> None:
    ended = in_process.flexspline(*line.split(), folder=tmp_path)
    assert ended.status == 2
    assert WRONG[line] in ended.said[0]  # the only one: in_process sees to that
    assert "--help" in ended.said[0]


SWAPPED = {
    "diagnose sweep.csv cup.toml": "diagnose DESIGN.toml MEASURED.csv",
    "predict torque.csv --model m.toml cup.toml": "predict DESIGN.toml --model MODEL.toml TORQUE.csv",
    "predict cup.toml --model torque.csv m.toml": "predict DESIGN.toml --model MODEL.toml TORQUE.csv",
}


@pytest.mark.parametrize("line", SWAPPED)
def test_files_in_another_order(line: str, tmp_path: Path) -> None:
    ended = in_process.flexspline(*line.split(), folder=tmp_path)
    assert ended.status == 2
    assert ended.said[0].endswith(f"the order is flexspline {SWAPPED[line]}")


NAMES = (
    ["gear", ""], ["run", ""], ["study", ""], ["studio", "--no-browser", ""],
    ["diagnose", "cup.toml", ""], ["predict", "cup.toml", "t.csv", "--model", ""],
    ["run", "cup.toml", "--model", ""],
)  # fmt: skip


@pytest.mark.parametrize("words", NAMES)
def test_an_empty_word_is_no_file(words: list[str], tmp_path: Path) -> None:
    ended = in_process.flexspline(*words, folder=tmp_path)
    assert ended.status == 2
    assert '"" must be the name of a file' in ended.said[0]


def test_no_words_at_all_are_answered_with_the_help(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        app([])
    assert "Commands:" in "".join(capfd.readouterr())


def test_what_a_command_does_is_said_in_a_line_of_a_narrow_terminal(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        app(["--help"])
    commands = capfd.readouterr().out.partition("Commands:")[2]
    assert "study" in commands
    assert "..." not in commands
