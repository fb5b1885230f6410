"""Processes that have the solvers loaded and answer one question at a time.

A question that takes too long ends its process, and a new one takes its place: no design that a slider
can reach may block the page.
"""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Mapping
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

SLOWEST_S = 60.0
"""Far above what any sensible design takes; a slider at its end may ask for millions of triangles."""
_ONE_THREAD = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@dataclass(frozen=True)
class Fault:
    """Why there is no answer: the design key it hangs on ("" for none) and one line."""

    key: str
    message: str


ENDED = Fault("", "the process of the fast model ended; move a slider to try again")


class Worker:
    """One process; questions queue in the order in which they are asked.

    If the process is killed during a question, for example for lack of memory, the question is asked again.

    `niceness` lowers its priority, so that a slow question does not slow the quick ones.
    """

    def __init__(self, name: str, niceness: int = 0) -> None:
        self.name, self.niceness = name, niceness
        self._turn = asyncio.Lock()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None

    def start(self) -> None:
        """Begin loading; `ask` waits for it."""
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(
            target=serve, args=(theirs, self.niceness), name=self.name, daemon=True
        )
        before = {key: os.environ.get(key) for key in _ONE_THREAD}
        os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))  # several workers share few cores
        heard = signal.signal(
            signal.SIGINT, signal.SIG_IGN
        )  # Ctrl-C is for the server, which ends them
        try:
            process.start()
        finally:
            signal.signal(signal.SIGINT, heard)
            for key, value in before.items():
                if value is None:
                    os.environ.pop(key)
                else:
                    os.environ[key] = value
        theirs.close()
        self._process, self._pipe = process, ours

    async def ask(self, question: str, tables: Mapping[str, Any]) -> Any:
        """The answer to a question of `results.studio.questions`, or a Fault.

        A caller that is cancelled before its turn leaves the queue. A question that has begun is not
        cancelled: the next one would get its answer.
        """
        await self._turn.acquire()
        task = asyncio.create_task(self._answered(question, tables))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        task.add_done_callback(lambda _: self._turn.release())
        return await asyncio.shield(task)

    async def _answered(self, question: str, tables: Mapping[str, Any]) -> Any:
        answer = await self._answered_once(question, tables)
        if answer is ENDED and self._was_killed():  # nobody would ask for this figure again
            return await self._answered_once(question, tables)
        return answer

    def _was_killed(self) -> bool:
        """Whether the process has ended, but not by `stop`."""
        if self._process is None:
            return False
        self._process.join(1.0)  # its pipe closes a moment before
        return not self._process.is_alive()

    async def _answered_once(self, question: str, tables: Mapping[str, Any]) -> Any:
        if self._process is None or not self._process.is_alive():
            self.start()
        assert self._pipe is not None
        reply = asyncio.create_task(asyncio.to_thread(_exchange, self._pipe, question, tables))
        done, _ = await asyncio.wait({reply}, timeout=SLOWEST_S)
        if done:
            return reply.result()
        self.stop()
        await reply
        return Fault("", f"the fast model gave no answer within {SLOWEST_S:g} s")

    def stop(self) -> None:
        """End the process at once."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None


def _exchange(pipe: Connection, question: str, tables: Mapping[str, Any]) -> Any:
    try:
        pipe.send((question, tables))
        return pipe.recv()
    except (EOFError, OSError):
        return ENDED


def serve(pipe: Connection, niceness: int) -> None:
    """The process: load everything, then answer until the other end closes."""
    if hasattr(os, "nice"):  # Windows has none: there slow questions share evenly with quick ones
        os.nice(niceness)
    from flexspline.results.studio.questions import answer

    while True:
        try:
            question, tables = pipe.recv()
        except EOFError:
            return
        pipe.send(answer(question, tables))
