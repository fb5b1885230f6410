"""The queue of the page's workers: who has left takes no turn."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any

import aiohttp.test_utils
from studio_client import TABLES, heard, want, with_client

from flexspline.results.studio.worker import Fault, Worker

TABS = 200


class Counted(Worker):
    """The worker's queue without its process: notes whose questions are evaluated."""

    def __init__(self) -> None:
        super().__init__("counted")
        self.evaluated: list[str] = []
        self.free = asyncio.Event()

    def start(self) -> None: ...

    def stop(self) -> None: ...

    async def _answered(self, question: str, tables: Mapping[str, Any]) -> Any:
        self.evaluated.append(tables["name"])
        await self.free.wait()
        return Fault("", "no figures here")


def test_closed_tabs_take_no_turn() -> None:
    worker = Counted()

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        sockets = [await client.ws_connect("/live") for _ in range(TABS)]
        for i, socket in enumerate(sockets):
            await heard(socket)
            await socket.send_str(want(1, {**TABLES, "name": f"closed {i}"}))
            assert (await heard(socket))["is"] == "taken"
        # half of them close in good order, half as a killed browser does
        for i, socket in enumerate(sockets):
            if i % 2:
                await socket.close()
            else:
                socket._response.connection.transport.abort()
        begun = len(worker.evaluated)
        assert begun == 1  # the process answers one question at a time; it waits to be let go on
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            await socket.send_str(want(1, {**TABLES, "name": "next"}))
            assert (await heard(socket))["is"] == "taken"
            worker.free.set()
            assert (await heard(socket))["is"] == "failed"
        assert set(worker.evaluated[begun:]) == {"next"}

    with_client(check, worker=worker)
