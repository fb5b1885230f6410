"""A studio whose answers the test holds back and lets go: what the page shows meanwhile can be looked at."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from aiohttp import web
from kept import once

from flexspline.geometry.design import Design
from flexspline.results.studio.guard import Guard
from flexspline.results.studio.questions import answer
from flexspline.results.studio.server import Studio, application
from flexspline.results.studio.tab import StudioWorkers

Hold = Callable[[str, dict[str, Any]], bool]
LOOK_S = 0.02


class HeldWorker:
    """Answers as a worker does, in a thread; `studio.hold(question, tables)` true keeps it waiting.

    What an earlier test of this run of the suite asked is not computed again.
    """

    def __init__(self, studio: HeldStudio) -> None:
        self.studio = studio

    def start(self) -> None: ...

    def stop(self) -> None: ...

    async def ask(self, question: str, tables: dict[str, Any]) -> Any:
        while self.studio.hold(question, tables):
            await asyncio.sleep(LOOK_S)
        # no figure and no picture has the design's name
        asked = f"{question} {json.dumps({**tables, 'name': ''}, sort_keys=True)}"
        return await asyncio.to_thread(
            once, self.studio.suite, asked, lambda: answer(question, tables)
        )


class HeldStudio:
    """Its address, and which answers are held: none at first; `suite`: where they are kept."""

    def __init__(self, suite: Path) -> None:
        self.suite = suite
        self.hold: Hold = lambda question, tables: False
        self.guard = Guard("127.0.0.1")
        self.port = 0

    @property
    def url(self) -> str:
        return self.guard.address(self.port)


@contextmanager
def held_studio(design: Design, suite: Path) -> Iterator[HeldStudio]:
    """Serve in a thread of this process."""
    studio = HeldStudio(suite)
    loop, ready = asyncio.new_event_loop(), threading.Event()
    ended = asyncio.Event()
    workers: Any = StudioWorkers(*(HeldWorker(studio) for _ in range(3)))  # type: ignore[arg-type]

    async def serve() -> None:
        runner = web.AppRunner(application(Studio(studio.guard, design, workers)))
        await runner.setup()
        await web.TCPSite(runner, "127.0.0.1", 0).start()
        studio.port = runner.addresses[0][1]
        ready.set()
        await ended.wait()
        studio.hold = lambda question, tables: False
        await runner.cleanup()

    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()))
    thread.start()
    assert ready.wait(30)
    try:
        yield studio
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(30)
