"""A tab's session: its jobs, their files, and the messages in both directions."""

from __future__ import annotations

import asyncio
import json
from typing import Any

from aiohttp import web

from flexspline.geometry.errors import DesignError, why_of
from flexspline.results.studio.fields import received
from flexspline.results.studio.job_summary import job_summary
from flexspline.results.studio.jobs import Done, JobKind, StudioJob
from flexspline.results.studio.requests import Start, Want, request_from
from flexspline.results.studio.tab import StudioWorkers, Tab


class Session:
    """A tab with its jobs: at most one of each kind; a new one replaces the old one and its files."""

    def __init__(self, workers: StudioWorkers, socket: web.WebSocketResponse) -> None:
        self._socket = socket
        self.tab = Tab(workers, self._send)
        self.measured = b""
        self._jobs: dict[JobKind, StudioJob] = {}
        self._tasks: dict[JobKind, asyncio.Task[None]] = {}

    async def open(self) -> None:
        self.tab.open()
        await self._send({"is": "hello", "tab": self.tab.key})

    async def close(self) -> None:
        """End everything that runs for this tab and remove its files."""
        await self.tab.close()
        for job in self._jobs.values():
            job.stop()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)
        for job in self._jobs.values():
            job.close()

    async def take(self, text: str) -> None:
        """A message of the tab; one that is not understood is answered, never fatal."""
        try:
            request = request_from(text)
        except ValueError:
            await self.refuse()
            return
        if isinstance(request, Want):
            await self.tab.want(request.number, request.tables, request.view)
        elif isinstance(request, Start):
            self._start(request.kind, request.tables)
        elif request.kind in self._jobs:
            self._jobs[request.kind].stop()

    async def refuse(self) -> None:
        """Answer a message that is not understood."""
        await self._send({"is": "refused", "text": "a message was not understood"})

    def file(self, kind: str, name: str) -> bytes | None:
        """Of the newest job of a kind; None if there is no such job or file."""
        job = next((job for k, job in self._jobs.items() if k == kind), None)
        return None if job is None else job.read(name)

    def _start(self, kind: JobKind, tables: dict[str, Any]) -> None:
        old, before = self._jobs.get(kind), self._tasks.get(kind)

        async def say(line: str) -> None:
            if self._jobs[kind] is job:  # one that was replaced ends in silence
                await self._send({"is": "progress", "kind": kind, "line": line})

        job = StudioJob(kind, say)
        self._jobs[kind] = job

        async def after() -> None:
            if old is not None and before is not None:
                old.stop()
                await asyncio.wait({before})
                old.close()
            await self._run(job, tables)

        self._tasks[kind] = asyncio.create_task(after())

    async def _run(self, job: StudioJob, tables: dict[str, Any]) -> None:
        answer: dict[str, Any] = {}
        try:
            design = received(tables)
            ended = await job.run(design, self.measured if job.kind == "diagnose" else b"")
            if ended.state == "done":
                answer = job_summary(job.kind, design, ended.text)
        except DesignError as fault:
            ended = Done("failed", str(fault))
        except OSError as fault:
            ended = Done("failed", why_of(fault))
        answer = answer or {"text": ended.text}
        if self._jobs[job.kind] is job:
            await self._send({"is": "ended", "kind": job.kind, "state": ended.state,
                              "files": ended.files, **answer})  # fmt: skip

    async def _send(self, note: dict[str, Any] | bytes) -> None:
        """To the tab, unless it is gone."""
        try:
            if isinstance(note, bytes):
                await self._socket.send_bytes(note)
            else:
                await self._socket.send_str(json.dumps(note, allow_nan=False))
        except (ConnectionError, RuntimeError):  # closed meanwhile: nobody is left to tell
            return
