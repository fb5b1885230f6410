"""Workers of a Dask scheduler that only sleep: `python sleepers.py ADDRESS COUNT`.

They sleep for as long as real designs took. That needs no core, so all of them live in one process, each
with its own connection and one thread, as the scheduler sees a cluster.
"""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import psutil

from flexspline.pipeline.study.evaluate import Outcome, Task, outcome_of

WAIT_S = 60.0
"""For the scheduler and all workers to start."""


@cache
def recorded(path: Path) -> list[Outcome]:
    return [outcome_of(told) for told in json.loads(path.read_text(encoding="utf-8"))]


def slept(path: Path, share: float, task: Task) -> Outcome:
    """One of the recorded outcomes, chosen by the design's values, after that share of its time."""
    known = recorded(path)
    outcome = known[int(1e6 * sum(task.values.values())) % len(known)]
    time.sleep(share * outcome.seconds)
    return outcome


@dataclass(frozen=True)
class Cluster:
    """A scheduler's address, and its process and the workers' one."""

    address: str
    scheduler: psutil.Process
    workers: psutil.Process


@contextmanager
def cluster(count: int, folder: Path) -> Iterator[Cluster]:
    """Dask's scheduler as its users start it, and `count` sleepers."""
    found = folder / "scheduler.json"
    command = [
        sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "tcp://127.0.0.1",
        "--port", "0", "--no-dashboard", "--scheduler-file", str(found),
    ]  # fmt: skip
    with ExitStack() as stack:
        scheduler = stack.enter_context(_running(command))
        _wait_for(found.exists)
        address = json.loads(found.read_text(encoding="utf-8"))["address"]
        workers = stack.enter_context(_running([sys.executable, __file__, address, str(count)]))
        yield Cluster(address, psutil.Process(scheduler.pid), psutil.Process(workers.pid))


@contextmanager
def _running(command: list[str]) -> Iterator[subprocess.Popen[bytes]]:
    here = {
        **os.environ,
        "PYTHONPATH": str(Path(__file__).parent),
    }  # Dask's scheduler loads calls too
    with subprocess.Popen(command, stderr=subprocess.DEVNULL, env=here) as process:
        try:
            yield process
        finally:
            process.kill()


def _wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + WAIT_S
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError("the scheduler did not start")
        time.sleep(0.05)


async def serve(address: str, count: int) -> None:
    from distributed import Worker

    workers = [Worker(address, nthreads=1, name=str(i), memory_limit=0) for i in range(count)]
    await asyncio.gather(*workers)
    await asyncio.gather(*(w.finished() for w in workers))


if __name__ == "__main__":
    asyncio.run(serve(sys.argv[1], int(sys.argv[2])))
