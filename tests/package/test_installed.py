"""The wheel in an empty environment, outside the repository: every command from any folder.

Downloads a gigabyte, so it is a long test; it needs pip to reach a package index.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from example_files import EXAMPLES
from hatchling.builders.wheel import WheelBuilder

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.long

STUDY = """design = "design.toml"
[vary]
"flexspline.wall_thickness_mm" = { values = [0.4, 0.5] }
[run]
method = "grid"
workers = 1
"""


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bin folder of a fresh environment with the wheel and its extras."""
    folder = tmp_path_factory.mktemp("installed")
    wheel = next(WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"]))
    subprocess.run([sys.executable, "-m", "venv", str(folder / "venv")], check=True)
    programs = folder / "venv" / "bin"
    subprocess.run(
        [str(programs / "python"), "-m", "pip", "install", "-q", f"{wheel}[bench]"],
        check=True,
    )
    return programs


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a measured file; designs come from the program itself."""
    folder = tmp_path_factory.mktemp("elsewhere")
    shutil.copy(EXAMPLES / "measured" / "xb1-40-sweep.csv", folder)
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    return folder


def test_every_command_works(programs: Path, desk: Path) -> None:
    env = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    env |= {"FLEXSPLINE_CACHE": str(desk / "cache"), "PATH": f"{programs}:{os.environ['PATH']}"}

    def flexspline(*arguments: str) -> str:
        out = subprocess.run(
            ["flexspline", *arguments],
            cwd=desk, env=env, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert out.returncode == 0, f"{arguments}\n{out.stderr}"
        assert "Traceback" not in out.stderr
        return out.stdout

    (desk / "design.toml").write_text(flexspline("init", "cup"), encoding="utf-8")
    assert '"flexspline"' in flexspline("schema")
    flexspline("run", "design.toml")
    assert (desk / "design.out" / "report.pdf").stat().st_size > 10_000
    assert "K_e_Nm_per_rad" in flexspline("stiffness", "design.toml", "--json")
    flexspline("backlash", "design.toml")
    flexspline("export", "design.toml", "--deck", "--out", "exported")
    flexspline("diagnose", "design.toml", "xb1-40-sweep.csv", "--out", "found")
    model = str(desk / "found" / "extended_model.toml")
    flexspline("predict", "design.toml", "--model", model, "xb1-40-sweep.csv", "--out", "told")
    flexspline("study", "study.toml")
    flexspline("sensitivity", "design.toml")
    flexspline("studio", "--help")


def test_what_is_installed_is_what_runs(programs: Path, desk: Path) -> None:
    code = "import flexspline.results; print(flexspline.results.__file__)"
    for imported in (code, "import ngsolve; print(ngsolve.__file__)"):
        out = subprocess.run(
            [str(programs / "python"), "-I", "-c", imported],
            cwd=desk, capture_output=True, text=True, check=True,
        )  # fmt: skip
        assert str(programs.parent) in out.stdout
