"""All pictures of a run, drawn while it goes on, once for the same content, and kept.

Two processes draw (`results.renders.process`): a solved part as soon as it is there, the charts in the end.
What cannot be drawn is missing and everything else comes; it is not kept, so the next run tries again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from queue import SimpleQueue

from flexspline.fea.types import SolidField
from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
from flexspline.pipeline.parts import AnalysisContext
from flexspline.results.atomic import write_bytes
from flexspline.results.drawings import Drawing, charts, drawing_key, of_field, small
from flexspline.results.renders.process import DrawingProcess, NotDrawnError
from flexspline.results.renders.scene import load

STAGE = "picture"
"""Of the cache."""
PROCESSES = 2
"""That draw at once, the second from when there are pictures for both. A run of the example cup on two cores:
12.3 s with two, 14.0 with one."""
NOTED = {"part": "picture", "view": "3-D view"}
"""Kinds of drawings that take long enough to be told."""


@dataclass(frozen=True)
class RunPictures:
    """What was drawn of a run.

    Attributes
    ----------
    paths : PNG files by name.
    small : those of parts as WebP, a fifth of the PNG: for pages, which carry their pictures.
    views : the stress pictures as views that turn in a browser, by the pictures' names.
    missing : why, by the names of the pictures and views that could not be drawn.
    """

    paths: Mapping[str, Path]
    small: Mapping[str, bytes] = field(default_factory=dict)
    views: Mapping[str, bytes] = field(default_factory=dict)
    missing: Mapping[str, str] = field(default_factory=dict)

    @property
    def warnings(self) -> tuple[str, ...]:
        """One line for each reason."""
        by_reason: dict[str, list[str]] = {}
        for name, reason in self.missing.items():
            by_reason.setdefault(reason, []).append(name)
        return tuple(f"not drawn: {', '.join(n)}: {reason}" for reason, n in by_reason.items())


class RunDrawings:
    """Draws a run's pictures while it goes on; a context that ends the drawing."""

    def __init__(self, context: AnalysisContext) -> None:
        self.context = context
        given_up: dict[str, str] = {}  # by all
        self._processes = [DrawingProcess(gave_up=given_up) for _ in range(PROCESSES)]
        self._idle: SimpleQueue[DrawingProcess] = SimpleQueue()
        for process in self._processes:
            self._idle.put(process)
        self._threads = ThreadPoolExecutor(PROCESSES)
        self._asked: list[tuple[Sequence[Drawing], Future[list[bytes | NotDrawnError]]]] = []
        self._small: dict[str, bytes] = {}

    def __enter__(self) -> RunDrawings:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._processes:  # first: the threads then come to their end
            process.__exit__()
        self._threads.shutdown(cancel_futures=True)

    def prepare(self) -> None:
        """Load what draws parts, in its own process, while they are solved; nothing where all is drawn."""
        part = self.context.part("flexspline")
        if not self.context.cache.has(STAGE, drawing_key("flexspline_mesh", part.torsion_key)):
            self._threads.submit(self._load)

    def add_field(self, name: str, field: SolidField) -> None:
        """Begin to draw one of `RunResult.fields`; a picture and its view by the same process."""
        for drawings in of_field(self.context, name, field):
            self._begin(drawings)

    def add(self, drawings: Iterable[Drawing]) -> None:
        """Begin to draw these, in this order, when what was asked before has begun."""
        for drawing in drawings:
            self._begin([drawing])

    def _begin(self, drawings: Sequence[Drawing]) -> None:
        """Those that one process draws, one after the other."""
        self._asked.append((drawings, self._threads.submit(self._all_drawn, drawings)))

    def kept_in(self, folder: Path) -> RunPictures:
        """Wait for all, and write the pictures.

        A picture of an earlier run that cannot be drawn now is removed: it may be another design's.
        """
        paths: dict[str, Path] = {}
        views: dict[str, bytes] = {}
        missing: dict[str, str] = {}
        for drawings, asked in self._asked:
            for drawing, made in zip(drawings, asked.result(), strict=True):
                name, path = drawing.name, folder / f"{drawing.name}.png"
                is_view = drawing.kind == "view"
                if is_view and name not in paths:
                    continue  # the picture stands where scripts do not run
                if isinstance(made, NotDrawnError):
                    missing[f"3-D view {name}" if is_view else name] = str(made)
                    if not is_view:
                        path.unlink(missing_ok=True)
                elif is_view:
                    views[name] = made
                else:
                    write_bytes(path, made)
                    paths[name] = path
        return RunPictures(paths, self._small, views, missing)

    @contextmanager
    def _process(self) -> Iterator[DrawingProcess]:
        process = self._idle.get()  # there is one for each thread
        try:
            yield process
        finally:
            self._idle.put(process)

    def _load(self) -> None:
        with self._process() as process:
            process.draw(load)

    def _all_drawn(self, drawings: Sequence[Drawing]) -> list[bytes | NotDrawnError]:
        made: list[bytes | NotDrawnError] = []
        with self._process() as process:
            for drawing in drawings:
                try:
                    made.append(self._drawn(process, drawing))
                except NotDrawnError as error:
                    made.append(error)
        return made

    def _drawn(self, process: DrawingProcess, drawing: Drawing) -> bytes:
        def make() -> bytes:
            if drawing.kind in NOTED:
                self.context.progress.note(f"  {NOTED[drawing.kind]} {drawing.name}")
            return process.draw(drawing.write, *drawing.arguments)

        made, _ = self.context.cache.get(STAGE, drawing.key, make)
        if drawing.kind == "part":
            self._small[drawing.name] = self._drawn(process, small(made))
        return made


def write_pictures(
    drawings: RunDrawings,
    result: RunResult,
    folder: Path,
    extended: ExtendedBacklash | None = None,
) -> RunPictures:
    """Every picture of a run into `folder`, and the 3-D views, but for those of fields that are missing."""
    drawings.add(charts(result, extended))
    with drawings.context.progress.stage("pictures"):
        return drawings.kept_in(folder)
