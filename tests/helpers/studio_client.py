"""The page's server in this process, with a client that has the token, for the tests beside this file."""

from __future__ import annotations

import asyncio
import json
import tomllib
from collections.abc import Awaitable, Callable
from typing import Any

from aiohttp import ClientWebSocketResponse, TCPConnector
from aiohttp.test_utils import TestClient, TestServer

from flexspline.geometry.load import design_from
from flexspline.geometry.template import template
from flexspline.results.studio.guard import Guard
from flexspline.results.studio.server import Studio, application
from flexspline.results.studio.tab import StudioWorkers

DESIGN = design_from(tomllib.loads(template("cup")))
TABLES = DESIGN.tables
Check = Callable[[TestClient], Awaitable[None]]


class Idle:
    """A worker that never answers, for tests of who may ask and what."""

    def start(self) -> None: ...

    def stop(self) -> None: ...

    async def ask(self, question: str, tables: object) -> Any:
        await asyncio.Event().wait()


def with_client(
    check: Check, guard: Guard | None = None, *, known: bool = True, worker: Any = None
) -> Studio:
    """Run a check against a server; `known`: the client has been let in, as a browser is."""
    worker = worker or Idle()
    studio = Studio(guard or Guard("127.0.0.1"), DESIGN, StudioWorkers(worker, worker, worker))

    async def run() -> None:
        server, many = TestServer(application(studio)), TCPConnector(limit=0)
        async with TestClient(server, connector=many) as client:
            if known:
                assert (await client.get(f"/?token={studio.guard.token}")).status == 200
            await check(client)

    asyncio.run(run())
    return studio


def want(number: int, tables: dict[str, Any] = TABLES) -> str:
    """A message of the page: figures of this design."""
    return json.dumps({"do": "want", "number": number, "tables": tables, "view": "wave_generator"})


async def heard(socket: ClientWebSocketResponse) -> dict[str, Any]:
    """The next message of the server."""
    return json.loads((await socket.receive(timeout=30)).data)
