"""Tasks in a second process give what they give in one, whatever becomes of it."""

from __future__ import annotations

import os
import signal
import struct
import subprocess
import sys
import time
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
import pytest

from flexspline.pipeline.second_process import results_of, second_process

linux_with_two_processors = pytest.mark.skipif(
    sys.platform != "linux" or len(os.sched_getaffinity(0)) < 2, reason="one process only"
)


def square(number: int) -> tuple[int, np.ndarray]:
    return os.getpid(), np.arange(number) ** 2


@pytest.mark.parametrize("count", [0, 1, 2, 5])
def test_results_come_in_order(count: int) -> None:
    tasks = [partial(square, k) for k in range(count)]
    alone = results_of(tasks)
    with second_process():
        shared = results_of(tasks)
    assert len(alone) == len(shared) == count
    for (_, one), (_, other) in zip(alone, shared, strict=True):
        assert np.array_equal(one, other)


@linux_with_two_processors
def test_every_other_task_runs_elsewhere_where_that_is_allowed() -> None:
    tasks = [partial(square, k) for k in range(4)]
    assert {pid for pid, _ in results_of(tasks)} == {os.getpid()}
    with second_process():
        pids = [pid for pid, _ in results_of(tasks)]
    assert pids[::2] == 2 * [os.getpid()]
    assert os.getpid() not in pids[1::2]


@linux_with_two_processors
@pytest.mark.parametrize("end", ["killed", "raises", "cannot be sent"])
def test_what_fails_elsewhere_is_done_here(end: str) -> None:
    here = os.getpid()

    def task() -> object:
        if os.getpid() != here:
            if end == "killed":
                os.kill(os.getpid(), signal.SIGKILL)
            if end == "raises":
                raise ValueError("not here")
            return lambda: None  # has no pickle
        return "done"

    with second_process():
        assert results_of([task, task, task]) == ["done", "done", "done"]


def test_a_fault_is_raised_as_if_there_were_one_process() -> None:
    def wrong() -> None:
        raise ValueError("both ways")

    for tasks in ([wrong, lambda: None], [lambda: None, wrong]):
        with second_process(), pytest.raises(ValueError, match="both ways"):
            results_of(tasks)


@linux_with_two_processors
def test_ctrl_c_ends_both_without_a_word_of_the_second(tmp_path: Path) -> None:
    program = tmp_path / "two.py"
    program.write_text(
        "import os, sys, time\n"
        "from flexspline.pipeline.second_process import results_of, second_process\n"
        "def task():\n"
        "    os.write(1, b'%d\\n' % os.getpid())\n"
        "    time.sleep(60)\n"
        "with second_process():\n"
        "    try:\n"
        "        results_of([task, task])\n"
        "    except KeyboardInterrupt:\n"
        "        sys.exit(130)\n"
    )
    ran = subprocess.Popen(
        [sys.executable, program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    assert ran.stdout is not None
    pids = [int(ran.stdout.readline()) for _ in range(2)]
    began = time.monotonic()
    os.killpg(ran.pid, signal.SIGINT)
    _, said = ran.communicate(timeout=30)
    assert time.monotonic() - began < 10
    assert ran.returncode == 130
    assert said == ""
    assert not any(Path(f"/proc/{pid}").exists() for pid in pids)


class _Unreadable(ValueError):
    """It can be sent, but not made again."""

    def __init__(self, a: int, b: int) -> None:
        super().__init__(f"{a}{b}")


@pytest.mark.parametrize("fails", ["unreadable", "not started", "no pipe", "cut off"])
def test_whatever_fails_elsewhere_is_done_here(fails: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if fails == "not started":

        def refused(_: object) -> None:
            raise BlockingIOError("Resource temporarily unavailable")

        monkeypatch.setattr("multiprocessing.context.ForkProcess.start", refused)
    if fails == "no pipe":

        def too_many(*_: object, **__: object) -> None:
            raise OSError(24, "Too many open files")

        monkeypatch.setattr("multiprocessing.context.ForkContext.Pipe", too_many)
    if fails == "cut off":

        def killed(to: Connection, _: object) -> None:  # only the second process sends
            os.write(to.fileno(), struct.pack("!i", 1_000_000) + b"x" * 1000)
            os._exit(9)

        monkeypatch.setattr(Connection, "send", killed)
    with second_process():
        first, second = results_of([lambda: 1, lambda: _Unreadable(1, 2)])
    assert first == 1
    assert str(second) == "12"
