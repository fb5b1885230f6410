"""Work beside other work: both are done, times are kept apart, and an interruption ends both."""

from __future__ import annotations

import threading
import time
from functools import partial

import pytest

from flexspline.pipeline.progress import Progress, Stopped
from flexspline.pipeline.two_threads import beside


def test_stages_of_two_threads_are_not_inside_each_other() -> None:
    """The outer stage of one thread is open while the other has its own; none is taken off it."""
    progress, opened, closed = Progress(), threading.Event(), threading.Event()

    def work() -> str:
        opened.wait(60)
        with progress.stage("beside"):
            time.sleep(0.1)
        closed.set()
        return "done"

    with beside(progress, [work]) as rest, progress.stage("here"):
        opened.set()
        assert closed.wait(60)
        assert rest() == ["done"]
    assert progress.seconds["beside"] >= 0.1
    assert progress.seconds["here"] >= 0.1


def test_an_interruption_ends_the_work_at_its_next_stage() -> None:
    progress, begun = Progress(), threading.Event()

    ended: list[BaseException] = []

    def endless() -> None:
        try:
            while True:
                with progress.stage("round"):
                    begun.set()
                    time.sleep(0.01)
        except BaseException as why:
            ended.append(why)
            raise

    def interrupted() -> None:
        with beside(progress, [endless]):
            assert begun.wait(60)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()  # would not come back while the work goes on
    assert isinstance(ended[0], Stopped)
    progress.note("the next command's")  # nothing is stopped any more


def test_an_error_of_the_work_is_its_reader_s() -> None:
    def failing() -> None:
        raise ValueError("of the work")

    with pytest.raises(ValueError, match="of the work"), beside(Progress(), [failing]) as rest:
        rest()


def test_both_threads_do_the_tasks_each_once() -> None:
    """Whoever has the first task waits in it until the other has done the last one."""
    last, done = threading.Event(), []

    def task(number: int) -> int:
        if number == 0:
            assert last.wait(60)
        done.append(number)
        if number == 2:
            last.set()
        return 10 * number

    with beside(Progress(), [partial(task, number) for number in range(3)]) as rest:
        assert rest() == [0, 10, 20]
    assert done == [1, 2, 0]


def test_after_an_error_no_task_is_begun() -> None:
    failed, begun = threading.Event(), []

    def failing() -> None:
        failed.set()
        raise ValueError("of the work")

    def task() -> None:
        begun.append(failed.wait(60))

    def both() -> None:
        with beside(Progress(), [failing, *9 * [task]]) as rest:
            failed.wait(60)
            time.sleep(0.2)  # until the thread has said so
            rest()

    with pytest.raises(ValueError, match="of the work"):
        both()
    assert not begun
