"""Work beside other work: both are done, times are kept apart, and an interruption ends both."""

from __future__ import annotations

import threading
import time

import pytest

from flexspline.pipeline.beside import beside
from flexspline.pipeline.progress import Progress, Stopped


def test_stages_of_two_threads_are_not_inside_each_other() -> None:
    """The outer stage of one thread is open while the other has its own; none is taken off it."""
    progress, opened, closed = Progress(), threading.Event(), threading.Event()

    def work() -> str:
        opened.wait(60)
        with progress.stage("beside"):
            time.sleep(0.1)
        closed.set()
        return "done"

    with beside(progress, work) as other, progress.stage("here"):
        opened.set()
        assert closed.wait(60)
        assert other.result(60) == "done"
    assert progress.seconds["beside"] >= 0.1
    assert progress.seconds["here"] >= 0.1


def test_an_interruption_ends_the_work_at_its_next_stage() -> None:
    progress, begun = Progress(), threading.Event()

    def endless() -> None:
        while True:
            with progress.stage("round"):
                begun.set()
                time.sleep(0.01)

    asked = []

    def interrupted() -> None:
        with beside(progress, endless) as other:
            asked.append(other)
            assert begun.wait(60)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert isinstance(asked[0].exception(), Stopped)
    progress.note("the next command's")  # nothing is stopped any more


def test_an_error_of_the_work_is_its_reader_s() -> None:
    def failing() -> None:
        raise ValueError("of the work")

    with pytest.raises(ValueError, match="of the work"), beside(Progress(), failing) as other:
        other.result(60)
