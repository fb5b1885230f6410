"""One browser tab: its newest design, the results so far, and the next question.

Three lanes run side by side, each with a worker of its own: the stiffnesses that follow a slider, the
picture, and what takes longer. A lane drops what a newer design has made stale, so the newest wins. No
stress is refined before the first figures are there: three lanes at work slow each other on two cores.
"""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.pipeline.bearing_play import BearingPlayDomainError
from flexspline.pipeline.stress_limits import PEAK_OF, STRESS_CASES
from flexspline.results.studio.answer import agreement, design_warnings_shown, left_out, message
from flexspline.results.studio.fields import received
from flexspline.results.studio.questions import FIRST_LOBES, FIRST_STRESS, GEAR, RIM
from flexspline.results.studio.worker import Fault, Worker

Send = Callable[[dict[str, Any] | bytes], Awaitable[None]]
STILL_S = 0.35
"""The slow questions wait until no slider has moved for so long: they would only delay the others."""
QUICK = ("torsion", FIRST_LOBES, "K_b_lobes")
REFINED = frozenset(f"field {view}" for view in STRESS_CASES)
ROUGH = f"{PEAK_OF['wave_generator']}_rough"


@dataclass(frozen=True)
class StudioWorkers:
    """Quick: K_b, K_e and K_b at the lobes. Picture: shape and stress. Slow: all the rest."""

    quick: Worker
    picture: Worker
    slow: Worker

    @classmethod
    def of_this_machine(cls) -> StudioWorkers:
        return cls(Worker("quick"), Worker("picture", 2), Worker("slow", 4))

    def start(self) -> None:
        for worker in (self.quick, self.picture, self.slow):
            worker.start()

    def stop(self) -> None:
        for worker in (self.quick, self.picture, self.slow):
            worker.stop()


@dataclass
class WantedDesign:
    """A design as the tab sent it; `number` grows with each.

    `begun` is set when its first figures are there, or a newer design is.
    """

    number: int
    design: Design
    tables: Mapping[str, Any]
    view: str
    figures: dict[str, Any] = field(default_factory=dict)
    begun: asyncio.Event = field(default_factory=asyncio.Event)


class Tab:
    """A connected tab; `key` is its secret, by which its uploads and files are found."""

    def __init__(self, workers: StudioWorkers, send: Send) -> None:
        self.key = secrets.token_urlsafe(24)
        self._workers, self._send = workers, send
        self._wanted: WantedDesign | None = None
        self._lanes: list[asyncio.Task[None]] = []
        self._news = [asyncio.Event() for _ in range(3)]

    def open(self) -> None:
        """Start the lanes."""
        w = self._workers
        for event, worker, still, plan in (
            (self._news[0], w.quick, 0.0, lambda view: QUICK),
            (self._news[1], w.picture, 0.0, _picture),
            (self._news[2], w.slow, STILL_S, _slow),
        ):
            lane = self._lane(event, worker, still, plan)
            self._lanes.append(asyncio.create_task(lane))

    async def close(self) -> None:
        """Stop the lanes; the answer to a running question is dropped."""
        for lane in self._lanes:
            lane.cancel()
        await asyncio.gather(*self._lanes, return_exceptions=True)

    async def want(self, number: int, tables: Mapping[str, Any], view: str) -> None:
        """Give the lanes a design, or refuse it with its key and reason.

        After a refusal the lanes continue with the previous design, which the page still shows.
        """
        try:
            design = received(tables)
            first = message(design, {})
        except (DesignError, BearingPlayDomainError) as fault:
            self._look_at(view)
            key = fault.key if isinstance(fault, DesignError) else "bearing.radial_clearance_um"
            await self._send({"is": "fault", "number": number, "key": key, "text": str(fault)})
            return
        self._set(WantedDesign(number, design, tables, view))
        await self._send({"is": "taken", "number": number, "left_out": left_out(design),
                          "agreement": agreement(design), "warnings": design_warnings_shown(design),
                          **first})  # fmt: skip

    def _look_at(self, view: str) -> None:
        if (before := self._wanted) is None or before.view == view:
            return
        wanted = replace(before, view=view, begun=asyncio.Event())
        if before.begun.is_set():
            wanted.begun.set()
        self._set(wanted)

    def _set(self, wanted: WantedDesign) -> None:
        if self._wanted is not None:
            self._wanted.begun.set()
        self._wanted = wanted
        for event in self._news:
            event.set()

    async def _lane(
        self,
        news: asyncio.Event,
        worker: Worker,
        still: float,
        plan: Callable[[str], Sequence[str]],
    ) -> None:
        while True:
            await news.wait()
            news.clear()
            wanted = self._wanted
            if wanted is None:
                continue
            if still:
                try:
                    await asyncio.wait_for(news.wait(), still)
                    continue  # a newer design came while waiting
                except TimeoutError:
                    pass
            for question in plan(wanted.view):
                if question in REFINED:
                    await wanted.begun.wait()
                    if self._wanted is not wanted:
                        break
                answer = await worker.ask(question, wanted.tables)
                late = self._wanted is not wanted
                if late and (isinstance(answer, Fault) or question.startswith("profile")):
                    break
                # the exact one may be there
                if question != FIRST_STRESS or ROUGH not in wanted.figures:
                    await self._tell(wanted, question, answer)
                if question == FIRST_LOBES:
                    wanted.begun.set()
                if late:  # told all the same: while a slider moves, every answer comes late
                    break

    async def _tell(self, wanted: WantedDesign, question: str, answer: Any) -> None:
        if isinstance(answer, Fault):
            await self._send({"is": "failed", "number": wanted.number, "question": question,
                              "key": answer.key, "text": answer.message})  # fmt: skip
            return
        picture = answer.pop("picture", None)
        if answer:
            wanted.figures |= answer
            await self._send({"number": wanted.number, "done": question, **_message(wanted)})
        if picture is not None:
            if question == FIRST_STRESS:  # to draw it takes a browser longer than all first figures
                await wanted.begun.wait()
            whose = {"number": wanted.number, "name": wanted.design.name}
            await self._send({"is": "picture", **whose})
            await self._send(picture)


def _message(wanted: WantedDesign) -> dict[str, Any]:
    try:
        return {"is": "answer", **message(wanted.design, wanted.figures)}
    except BearingPlayDomainError as fault:
        return {"is": "fault", "key": "bearing.radial_clearance_um", "text": str(fault)}


def _picture(view: str) -> list[str]:
    """The stress on the wave generator is wanted at once whatever is in view; exact only after."""
    mine = f"field {view}"
    return [
        f"profile {view}",
        *([FIRST_STRESS, mine] if view == "wave_generator" else [mine, FIRST_STRESS]),
    ]


def _slow(view: str) -> list[str]:
    """The wave generator's peak, the whole gear, the other peaks, then the other rim cases; the peak of the
    view itself comes with its picture."""
    peaks = [f"field {v}" for v in STRESS_CASES if v != view]
    peaks.sort(key=lambda question: question != "field wave_generator")
    return [*peaks[:1], GEAR, *peaks[1:], *(name for name in RIM if name not in QUICK)]
