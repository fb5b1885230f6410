"""A run's pictures are drawn while it goes on, two at a time, and end with it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import failing_drawings
import pytest
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.torque_stress import torque_field
from flexspline.results.drawings import Drawing, of_field
from flexspline.results.pictures import RunDrawings
from flexspline.results.renders.process import DrawingProcess, NotDrawnError
from flexspline.results.renders.scene import load

CUP = EXAMPLES / "xb1-40.toml"


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1] / "helpers"))


@pytest.fixture
def context(tmp_path: Path) -> AnalysisContext:
    cache = Cache(tmp_path / "cache")
    return AnalysisContext(load_design(CUP), cache, Progress())


def charts(count: int) -> Iterator[Drawing]:
    for i in range(count):
        yield Drawing(f"chart {i}", "chart", {}, failing_drawings.good, (i,))


def test_every_picture_comes_back_to_whom_it_belongs(context, tmp_path: Path) -> None:
    with RunDrawings(context) as drawings:
        drawings.add(charts(6))
        drawn = drawings.kept_in(tmp_path)
    assert {n: p.read_text() for n, p in drawn.paths.items()} == {
        f"chart {i}": f"drawn: {i}" for i in range(6)
    }
    assert not drawn.missing


def test_what_crashes_costs_itself_and_its_view_and_an_older_picture_goes(
    context, tmp_path: Path
) -> None:
    noted = tmp_path / "calls"
    for name in ("part.png", "gear_loads.png"):  # the second is not asked for now
        (tmp_path / name).write_bytes(b"an earlier design's")
    with RunDrawings(context) as drawings:
        for kind in ("chart", "view"):
            drawings.add(
                [Drawing("part", kind, {"of": kind}, failing_drawings.crashing, (str(noted),))]
            )
            drawings.kept_in(tmp_path)  # waits for it
        drawings.add(charts(1))
        drawn = drawings.kept_in(tmp_path)
    assert set(drawn.paths) == {"chart 0"}
    assert set(drawn.missing) == {"part"}
    assert "SIGSEGV" in drawn.missing["part"]
    assert {each.name for each in tmp_path.glob("*.png")} == {"chart 0.png"}
    assert noted.read_text() == "called\n"  # what crashed once is not tried again


def test_a_field_of_a_solve_that_was_cut_short_has_its_own_pictures(suite_cache: Path) -> None:
    """The same part and question, another mesh: a picture of the one is not shown for the other."""
    context = AnalysisContext(load_design(CUP), Cache(suite_cache), Progress())
    field = torque_field(context.part("shaft"))
    other = replace(field, peak=field.peak.times(1.1))
    keys = [
        [d.key for d in of_field(context, "shaft_torque", one)] for one in (field, other, field)
    ]
    assert keys[0] == keys[2]
    assert keys[0][0] == keys[1][0]  # of the mesh
    assert keys[0][1:] != keys[1][1:]
    coarser = replace(field.mesh, nodes=field.mesh.nodes * 1.01)
    (mesh, *_), (meshed, *_) = (
        [d.key for d in of_field(context, "shaft_torque", one)]
        for one in (field, replace(field, mesh=coarser))
    )
    assert mesh != meshed


def test_a_stop_ends_the_drawing(context) -> None:
    """One picture hangs, another waits: neither keeps the command, and nothing is kept of them."""
    with RunDrawings(context) as drawings:
        drawings.add([Drawing("endless", "chart", {}, failing_drawings.hanging, ())])
        drawings.add(charts(1))
    assert not list((context.cache.folder / "picture").glob("*.npz"))


def test_the_drawing_library_is_loaded_where_something_is_to_be_drawn(context, monkeypatch) -> None:
    asked: list[object] = []
    monkeypatch.setattr(DrawingProcess, "draw", lambda self, write, *given: asked.append(write))
    with RunDrawings(context) as drawings:
        assert not asked  # no thread yet: this process may still be copied
        drawings.prepare()
    assert asked == [load]


def refuse(*_: object) -> bytes:
    raise NotDrawnError("asked to draw")


def test_what_could_not_be_drawn_is_drawn_by_the_next_run(context, tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as without, RunDrawings(context) as drawings:
        without.setattr(DrawingProcess, "draw", refuse)
        drawings.add(charts(1))
        assert set(drawings.kept_in(tmp_path).missing) == {"chart 0"}
    next_one = replace(context, cache=Cache(context.cache.folder))
    with RunDrawings(next_one) as drawings:
        drawings.add(charts(1))
        drawn = drawings.kept_in(tmp_path)
    assert set(drawn.paths) == {"chart 0"}
    assert not drawn.missing


def test_what_is_kept_needs_no_process(context, tmp_path: Path, monkeypatch) -> None:
    with RunDrawings(context) as drawings:
        drawings.add(charts(1))
        drawings.kept_in(tmp_path)
    monkeypatch.setattr(DrawingProcess, "draw", refuse)
    with RunDrawings(context) as drawings:
        drawings.add(charts(1))
        assert set(drawings.kept_in(tmp_path).paths) == {"chart 0"}
