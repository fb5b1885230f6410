"""One value, two threads that ask for it: it is made once."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event

from flexspline.pipeline.cache import Cache

LATE_S = 0.05
"""The second thread has asked by then, and waits."""


def test_the_second_thread_waits_for_the_value_that_the_first_makes(tmp_path: Path) -> None:
    cache, begun, go_on = Cache(tmp_path), Event(), Event()
    made: list[str] = []

    def slow() -> int:
        begun.set()
        go_on.wait()
        made.append("first")
        return 7

    def quick() -> int:
        made.append("second")
        return 8

    with ThreadPoolExecutor(3) as threads:
        first = threads.submit(cache.get, "torsion", {"part": "shaft"}, slow)
        begun.wait()
        second = threads.submit(cache.get, "torsion", {"part": "shaft"}, quick)
        other = threads.submit(cache.get, "torsion", {"part": "flexspline"}, lambda: 9)
        assert other.result()[0] == 9
        go_on.wait(LATE_S)
        assert not second.done()
        go_on.set()
        assert (first.result()[0], second.result()[0]) == (7, 7)
    assert made == ["first"]


def test_a_value_may_be_made_of_others(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    found, stored = cache.get("lobes", {}, lambda: 1 + cache.get("torsion", {}, lambda: 2)[0])
    assert (found, stored) == (3, False)
