"""Tasks in a second process give what they give in one, whatever becomes of it."""

from __future__ import annotations

import io
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

from flexspline.fea.errors import MesherError
from flexspline.fea.solid.alone import LARGE, alone
from flexspline.pipeline.cache import Cache
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


def wait_and_say(_: int) -> int:
    time.sleep(0.2)
    return os.getpid()


@linux_with_two_processors
def test_two_processes_share_the_tasks_where_that_is_allowed() -> None:
    tasks = [partial(wait_and_say, k) for k in range(6)]
    assert {*results_of(tasks)} == {os.getpid()}
    with second_process():
        pids = results_of(tasks)
    assert len({*pids}) == 2
    assert os.getpid() in pids


def test_words_kept_in_memory_have_one_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a copy says there, nobody reads."""
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with second_process():
        assert {*results_of([partial(wait_and_say, k) for k in range(3)])} == {os.getpid()}


@linux_with_two_processors
def test_what_the_other_process_found_is_told_as_it_comes() -> None:
    told: list[tuple[int, int]] = []
    with second_process():
        pids = results_of(
            [partial(wait_and_say, k) for k in range(6)],
            on_result=lambda number, pid: told.append((number, pid)),
        )
    assert sorted(told) == [*enumerate(pids)]  # each once, with its own result
    ours = [pid == os.getpid() for _, pid in told]
    assert ours.index(False) < len(ours) - 1 - ours[::-1].index(True)


@linux_with_two_processors
def test_a_fault_of_the_listener_is_raised() -> None:
    def listener(number: int, pid: int) -> None:
        if pid != os.getpid():
            raise ValueError("not wanted")

    with second_process(), pytest.raises(ValueError, match="not wanted"):
        results_of([partial(wait_and_say, k) for k in range(4)], on_result=listener)


def test_all_is_told_where_there_is_one_process_and_where_the_other_fails() -> None:
    here, told = os.getpid(), []

    def task(number: int) -> int:
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(0.05)
        return number

    tasks = [partial(task, k) for k in range(4)]
    results_of(tasks, on_result=lambda number, result: told.append((number, result)))
    with second_process():
        results_of(tasks, on_result=lambda number, result: told.append((number, result)))
    assert sorted(told) == sorted(2 * [(k, k) for k in range(4)])


@linux_with_two_processors
def test_who_is_done_takes_the_next_task() -> None:
    """A long one and five short ones: the other process does all the short ones."""

    def task(number: int) -> int:
        time.sleep(1.0 if number == 0 else 0.01)
        return os.getpid()

    with second_process():
        long, *short = results_of([partial(task, k) for k in range(6)])
    assert len({*short}) == 1
    assert long not in short


@linux_with_two_processors
def test_a_turn_ends_with_the_process_that_had_it() -> None:
    """A large model's turn is shared, and nobody waits for a process that the system has killed."""
    here, times = os.getpid(), 2

    def task(number: int) -> float:
        began = time.monotonic()
        with alone(LARGE):
            if os.getpid() != here and number == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            time.sleep(1.0)
        return time.monotonic() - began

    with second_process():
        both = results_of([partial(task, k) for k in range(1, 1 + times)])
        assert max(both) > 1.5  # one waited for the other
        assert len(results_of([partial(task, 0) for _ in range(times)])) == times


@linux_with_two_processors
@pytest.mark.parametrize("end", ["killed", "raises", "cannot be sent"])
def test_what_fails_elsewhere_is_done_here(end: str) -> None:
    """The first process waits in its first task until the copy has begun another."""
    here = os.getpid()
    theirs, ours = os.pipe()

    def task() -> object:
        if os.getpid() == here:
            os.read(theirs, 1)  # until the copy has begun one
        else:
            os.write(ours, b"...")
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


@linux_with_two_processors
def test_one_value_is_made_once_by_both(tmp_path: Path) -> None:
    """The second to ask for it waits, and reads what the first has stored."""
    cache = Cache(tmp_path / "cache")

    def make() -> str:
        time.sleep(1.0)
        with (tmp_path / "made").open("a") as file:
            file.write("once\n")
        return "value"

    def task() -> tuple[str, int]:
        return cache.get("stage", {"of": "both"}, make)[0], os.getpid()

    with second_process():
        found = results_of([task, task])
    assert {value for value, _ in found} == {"value"}
    assert len({process for _, process in found}) == 2
    assert (tmp_path / "made").read_text() == "once\n"


@linux_with_two_processors
def test_a_copy_ends_with_the_process_that_made_it(tmp_path: Path) -> None:
    program = tmp_path / "two.py"
    program.write_text(
        "import os, time\n"
        "from flexspline.pipeline.second_process import results_of, second_process\n"
        "def task():\n"
        "    os.write(1, b'%d\\n' % os.getpid())\n"
        "    time.sleep(60)\n"
        "with second_process():\n"
        "    results_of([task, task])\n"
    )
    with subprocess.Popen([sys.executable, program], stdout=subprocess.PIPE, text=True) as ran:
        assert ran.stdout is not None
        copy = ({int(ran.stdout.readline()) for _ in range(2)} - {ran.pid}).pop()
        ran.kill()
    deadline = time.monotonic() + 10
    while Path(f"/proc/{copy}/exe").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not Path(f"/proc/{copy}/exe").exists()


@linux_with_two_processors
@pytest.mark.parametrize("fails", [True, False])
def test_what_is_not_for_the_disk_is_made_once_by_both(fails: bool, tmp_path: Path) -> None:
    cache = Cache(tmp_path / "cache")

    def make() -> str:
        time.sleep(1.0)
        with (tmp_path / "made").open("a") as file:
            file.write("once\n")
        if fails:
            raise MesherError("it hung", "try again")
        return "passing"

    def task() -> str:
        try:
            return cache.get("stage", {"of": "both"}, make, lambda _: False)[0]
        except MesherError as fault:
            return fault.advice

    with second_process():
        assert results_of([task, task]) == 2 * ["try again" if fails else "passing"]
    assert (tmp_path / "made").read_text() == "once\n"


@linux_with_two_processors
def test_both_say_once_that_nothing_can_be_stored(
    tmp_path: Path, capfd: pytest.CaptureFixture
) -> None:
    (tmp_path / "file").touch()
    cache = Cache(tmp_path / "file", lambda line: print(line, flush=True))

    def task(number: int) -> int:
        time.sleep(0.5)
        return cache.get("stage", {"of": number}, lambda: number)[0]

    with second_process():
        assert results_of([partial(task, k) for k in range(4)]) == [0, 1, 2, 3]
    assert capfd.readouterr().out.count("could not store") == 1


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
    here, (theirs, ours) = os.getpid(), os.pipe()

    def task(number: int) -> object:
        if fails in ("unreadable", "cut off"):  # else there is no copy
            if os.getpid() == here:
                os.read(theirs, 1)
            else:
                os.write(ours, b"..")
        return _Unreadable(1, 2) if number else 1

    with second_process():
        first, second = results_of([partial(task, 0), partial(task, 1)])
    assert first == 1
    assert str(second) == "12"
