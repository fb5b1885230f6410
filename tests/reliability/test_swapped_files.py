"""A design where a study is asked, and the other way round: the line says which file it is."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from flexspline.results.cli import app

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY, CUP = EXAMPLES / "studies" / "grid.toml", EXAMPLES / "xb1-40.toml"


@pytest.mark.parametrize("command", ["run", "stiffness", "gear"])
def test_a_study_is_no_design(command: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, [command, str(STUDY), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert "the file is a study, which `flexspline study` takes" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_design_is_no_study(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["study", str(CUP), "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert 'a study names its design file in design = "FILE"' in done.stderr
    assert list(tmp_path.iterdir()) == []
