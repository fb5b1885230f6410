"""The queue of the page's workers: who has left takes no turn; and the order of what a tab gets."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from socket import SHUT_RDWR
from typing import Any

import aiohttp.test_utils
from studio_client import TABLES, heard, want, with_client

from flexspline.results.studio.questions import FIRST_LOBES, FIRST_STRESS
from flexspline.results.studio.tab import REFINED, STILL_S
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
                socket.get_extra_info("socket").shutdown(SHUT_RDWR)
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


class Asked:
    """Answers all but what is held, and notes what it was asked, of which design."""

    def __init__(self, *held: str) -> None:
        self.held = set(held)
        self.noted: list[tuple[str, str]] = []
        self.free = asyncio.Event()

    def start(self) -> None: ...

    def stop(self) -> None: ...

    async def ask(self, question: str, tables: Mapping[str, Any]) -> Any:
        self.noted.append((tables["name"], question))
        if question in self.held:
            await self.free.wait()
        return Fault("", "no figures here")

    async def until(self, name: str, question: str) -> None:
        async with asyncio.timeout(30):
            while (name, question) not in self.noted:
                await asyncio.sleep(0.01)


def test_no_stress_is_refined_before_the_first_figures_are_there() -> None:
    worker = Asked(FIRST_LOBES)

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            await socket.send_str(want(1, {**TABLES, "name": "one"}))
            await worker.until("one", FIRST_LOBES)
            await worker.until("one", FIRST_STRESS)
            await asyncio.sleep(2 * STILL_S)
            refined = {("one", question) for question in REFINED}
            assert refined.isdisjoint(worker.noted)
            # a newer design: nothing more of the one before is asked
            await socket.send_str(want(2, {**TABLES, "name": "two"}))
            await worker.until("two", FIRST_STRESS)
            worker.free.set()
            await worker.until("two", "field wave_generator")
            await worker.until("two", "field shaft_torque")
            assert refined.isdisjoint(worker.noted)

    with_client(check, worker=worker)


class WithPicture(Asked):
    """Answers the first stress with a picture."""

    async def ask(self, question: str, tables: Mapping[str, Any]) -> Any:
        answer = await super().ask(question, tables)
        return {"picture": b"drawn"} if question == FIRST_STRESS else answer


def test_the_first_stress_is_drawn_after_the_first_figures() -> None:
    """To draw it keeps a browser without a graphics card from showing figures for 60 ms."""
    worker = WithPicture(FIRST_LOBES)

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            await socket.send_str(want(1, TABLES))
            await worker.until(TABLES["name"], FIRST_LOBES)
            await worker.until(TABLES["name"], FIRST_STRESS)
            await asyncio.sleep(0.2)
            worker.free.set()
            got: list[str] = []
            while "picture" not in got:
                note = await heard(socket)
                got.append(note.get("question", note["is"]))
        assert got.index(FIRST_LOBES) < got.index("picture")

    with_client(check, worker=worker)


def test_another_view_of_a_design_without_figures_waits_for_them_too() -> None:
    """A change that is refused leaves the design before, which may be in another view by then."""
    worker = Asked(FIRST_LOBES)

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            await socket.send_str(want(1, TABLES))
            await worker.until(TABLES["name"], FIRST_LOBES)
            refused = TABLES | {"flexspline": TABLES["flexspline"] | {"wall_thickness_mm": -1.0}}
            other = json.loads(want(2, refused)) | {"view": "flexspline_torque"}
            await socket.send_str(json.dumps(other))
            await asyncio.sleep(2 * STILL_S)
            assert {question for _, question in worker.noted}.isdisjoint(REFINED)

    with_client(check, worker=worker)
