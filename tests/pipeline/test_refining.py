"""Answers that are refined as far as somebody asks."""

from __future__ import annotations

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.refining import Refining


def test_it_refines_no_further_than_asked() -> None:
    made: list[int] = []

    def answers() -> Iterator[int]:
        for k in range(5):
            made.append(k)
            yield k

    refining = Refining(answers())
    assert made == [0]
    assert refining.until(lambda k: k >= 2) == 2
    assert made == [0, 1, 2]
    assert refining.until(lambda k: k >= 1) == 2
    assert refining.last() == 4


def test_a_fault_is_raised_each_time_and_the_answer_before_is_kept() -> None:
    def answers() -> Iterator[int]:
        yield 0
        raise ComputationError("no mesh")

    refining = Refining(answers())
    for _ in range(2):
        with pytest.raises(ComputationError, match="no mesh"):
            refining.last()
    assert refining.newest == 0


def test_threads_that_share_it_wait_for_each_other() -> None:
    def answers() -> Iterator[int]:
        for k in range(4):
            time.sleep(0.02)
            yield k

    refining = Refining(answers())
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda _: refining.last(), range(4))) == [3] * 4
