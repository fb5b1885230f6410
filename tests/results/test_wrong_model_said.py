"""Two models of one part that contradict each other: no command trusts either, and each says which two."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from changed_text import changed_text
from example_files import EXAMPLES
from in_process import flexspline
from study_bench import TWO_WALLS, WALL, threads
from typer.testing import CliRunner
from wrong_models import stiffen_solid_model, swap_bodies

from flexspline import FlexsplineError, load_design, stiffness
from flexspline.pipeline.study import run
from flexspline.results.cli import app
from flexspline.results.studio.questions import answer
from flexspline.results.studio.worker import Fault

END = "one of the two solutions is wrong; please report the design file"


@pytest.fixture(scope="module")
def caches(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for each fault: what is solved for a command serves the next, and no other test."""
    return tmp_path_factory.mktemp("caches")


@pytest.fixture
def bodies_swapped(caches: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(caches / "bodies"))
    swap_bodies(monkeypatch)


@pytest.fixture
def solid_stiffened(caches: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(caches / "solid"))
    stiffen_solid_model(monkeypatch)


@pytest.fixture
def design(tmp_path: Path) -> Path:
    """To 2 %: K of the solid model is 5 % off, and one mesh shows it."""
    path = tmp_path / "gear.toml"
    path.write_text(
        changed_text("xb1-40", {"solver.model": '"solid"', "solver.tolerance_pct": "2.0"}),
        encoding="utf-8",
    )
    return path


@pytest.mark.usefixtures("solid_stiffened")
@pytest.mark.parametrize("command", ["stiffness", "backlash"])
def test_a_solid_model_outside_its_enclosure(command: str, design: Path) -> None:
    out = design.parent / "out"
    done = flexspline(command, design, "--out", out, folder=out)
    assert done.word == "failed"
    (line,) = done.said
    assert line.startswith(f"flexspline: {design}: the solid model is at least ")
    assert line.endswith(END)
    assert not done.written


@pytest.mark.usefixtures("bodies_swapped")
@pytest.mark.parametrize("command", ["run", "stiffness", "backlash", "gear"])
def test_two_bodies_of_revolution_the_wrong_way_round(command: str, tmp_path: Path) -> None:
    file = EXAMPLES / "xb1-40.toml"
    done = flexspline(command, file, "--out", tmp_path / "out", folder=tmp_path / "out")
    assert done.word == "failed"
    assert done.said[0].startswith(f"flexspline: {file}: the part with the ring of its holes cut")
    assert done.said[0].endswith(END)
    assert "out/result.json" not in done.written


@pytest.mark.usefixtures("bodies_swapped")
def test_a_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "worker_pool", lambda workers, scheduler: threads())
    monkeypatch.setattr(run, "nominal_holes", lambda *_: None)
    file, out = tmp_path / "walls.toml", tmp_path / "out"
    text = TWO_WALLS.replace("xb1-40.toml", str(EXAMPLES / "xb1-40.toml"))
    file.write_text(f"{text}evaluations = 2\n", encoding="utf-8")
    done = CliRunner().invoke(app, ["study", str(file), "--out", str(out)])
    assert done.exit_code == 1
    last = done.stderr.splitlines()[-1]
    told = f"flexspline: {file}: two models contradict each other in 2 of 2 designs; design 0: "
    assert last.startswith(told)
    assert last.endswith(END)
    assert (out / "report.html").exists()
    with (out / "study.csv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert [float(row[WALL]) for row in rows] == [0.38, 0.42]
    assert all(row["reason"].endswith(END) for row in rows)


@pytest.mark.parametrize("question", ["torsion", "K_b_lobes", "first K_b_lobes"])
def test_the_live_page(question: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where its figures stand the page has the reason, and its worker lives on."""
    swap_bodies(monkeypatch)
    found = answer(question, load_design(EXAMPLES / "xb1-40.toml").tables)
    assert isinstance(found, Fault)
    assert not found.key
    assert found.message.endswith(END)


@pytest.mark.usefixtures("solid_stiffened")
def test_python(design: Path) -> None:
    with pytest.raises(FlexsplineError, match="the solid model is at least"):
        stiffness(load_design(design))
