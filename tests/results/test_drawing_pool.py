"""Several pictures at once: each comes back to whom it belongs, and a crash is not tried twice."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import failing_drawings
import pytest

from flexspline.results.renders.pool import DrawingPool
from flexspline.results.renders.process import NotDrawnError


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1] / "helpers"))


def test_every_picture_comes_back_to_whom_it_belongs() -> None:
    names = [f"part {i}" for i in range(6)]
    with ThreadPoolExecutor(4) as threads, DrawingPool(2) as pool:
        asked = [threads.submit(pool.draw, failing_drawings.good, name) for name in names]
        assert [f.result() for f in asked] == [f"drawn: {name}".encode() for name in names]


def test_two_are_drawn_at_the_same_time(tmp_path: Path) -> None:
    """Each waits for the other: one after the other neither would end before its limit."""
    with ThreadPoolExecutor(2) as threads, DrawingPool(2) as pool:
        asked = [
            threads.submit(pool.draw, failing_drawings.meeting, str(tmp_path), mine, other)
            for mine, other in (("a", "b"), ("b", "a"))
        ]
        assert [f.result() for f in asked] == [b"met", b"met"]


def test_what_crashed_in_one_process_is_not_tried_in_another(tmp_path: Path) -> None:
    noted = tmp_path / "calls"
    with DrawingPool(2) as pool:
        for _ in range(4):
            with pytest.raises(NotDrawnError, match="SIGSEGV"):
                pool.draw(failing_drawings.crashing, str(noted))
    assert noted.read_text() == "called\n"


def test_a_stop_ends_the_drawing(tmp_path: Path) -> None:
    """The pool's end comes first; a thread that waits for a picture then ends as well."""
    with ThreadPoolExecutor(1) as threads:
        with DrawingPool(1) as pool:
            asked = threads.submit(pool.draw, failing_drawings.hanging)
            pool_stopped = threads.submit(pool.draw, failing_drawings.good, "late")
        assert asked.exception(timeout=60) is not None
        with pytest.raises(NotDrawnError, match="stopped"):
            pool_stopped.result(timeout=60)
