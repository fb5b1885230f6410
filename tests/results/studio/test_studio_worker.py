"""A worker process of the page: answers in turn, whoever leaves; a new process for one that ended."""

from __future__ import annotations

import asyncio
import contextlib
import tomllib
from multiprocessing import active_children
from multiprocessing.process import BaseProcess
from typing import Any

import pytest

from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.load import design_from
from flexspline.geometry.template import template
from flexspline.results.studio import worker as rules
from flexspline.results.studio.worker import Fault, Worker

CUP = without_holes(design_from(tomllib.loads(template("cup"))))


def tables(wall_mm: float) -> dict[str, Any]:
    design = with_values(CUP, {"flexspline.wall_thickness_mm": wall_mm})
    return design.tables


def process_of(name: str) -> BaseProcess | None:
    """The worker's process, if it runs."""
    return next((child for child in active_children() if child.name == name), None)


def test_who_leaves_takes_nobody_s_answer_along() -> None:
    async def run() -> list[Any]:
        worker = Worker("tested")
        try:
            expected = await worker.ask("torsion", tables(0.45))
            left = asyncio.create_task(worker.ask("field wave_generator", tables(0.4)))
            await asyncio.sleep(0.05)
            left.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await left
            return [expected, await worker.ask("torsion", tables(0.45))]
        finally:
            worker.stop()

    first, second = asyncio.run(run())
    assert second == first
    assert "K_b_Nm_per_rad" in first


def test_a_worker_that_ended_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    async def run() -> list[Any]:
        worker = Worker("tested")
        try:
            found = [await worker.ask("torsion", tables(0.4))]
            monkeypatch.setattr(rules, "SLOWEST_S", 0.01)  # no solve is that fast
            found.append(await worker.ask("field wave_generator", tables(0.41)))
            monkeypatch.undo()
            found.append(await worker.ask("torsion", tables(0.4)))
            return found
        finally:
            worker.stop()

    before, ended, after = asyncio.run(run())
    assert isinstance(ended, Fault)
    assert "no answer" in ended.message
    assert after == before


@pytest.mark.parametrize("kills", [pytest.param(1, marks=pytest.mark.long), 2])
def test_a_question_amid_which_the_worker_was_killed_is_asked_once_more(kills: int) -> None:
    async def run() -> list[Any]:
        worker = Worker("tested")
        try:
            await worker.ask("torsion", tables(0.4))  # loaded
            asked = asyncio.create_task(worker.ask("torsion", tables(0.42)))
            for _ in range(5):  # it has begun
                await asyncio.sleep(0)
            killed: set[int] = set()
            while len(killed) < kills:
                process = process_of("tested")
                if process is not None and process.pid is not None and process.pid not in killed:
                    killed.add(process.pid)
                    process.kill()
                await asyncio.sleep(0.001)
            return [await asked, await worker.ask("torsion", tables(0.42))]
        finally:
            worker.stop()

    during, after = asyncio.run(run())
    assert during == (after if kills == 1 else rules.ENDED)
    assert "K_b_Nm_per_rad" in after


def test_a_worker_that_was_stopped_amid_a_question_stays_so() -> None:
    async def run() -> Any:
        worker = Worker("tested")
        asked = asyncio.create_task(worker.ask("torsion", tables(0.4)))
        while process_of("tested") is None:
            await asyncio.sleep(0.001)
        worker.stop()
        return await asked

    assert asyncio.run(run()) == rules.ENDED
    assert process_of("tested") is None


def test_impossible_designs_come_back_as_faults() -> None:
    from flexspline.results.studio.questions import answer

    bad = tables(0.4)
    bad["flexspline"]["wall_thickness_mm"] = 50.0
    fault = answer("torsion", bad)
    assert isinstance(fault, Fault)
    assert fault.key.startswith("flexspline.")
