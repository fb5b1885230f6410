"""All pictures of a run, drawn during the run and cached by their content.

Two processes draw (`results.renders.process`): one a solved part as soon as it is there; one the charts in
the end, without VTK.
A picture that cannot be drawn is left out and not cached, so the next run tries it again.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from flexspline.fea.types import SolidField
from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
from flexspline.pipeline.parts import AnalysisContext
from flexspline.results.atomic import write_bytes
from flexspline.results.drawings import Drawing, charts, of_field, small
from flexspline.results.file_names import CHARTS, RENDERED
from flexspline.results.renders.process import DrawingProcess, NotDrawnError
from flexspline.results.renders.scene import load

STAGE, DRAWN = "picture", "drawn"
"""Of the cache: the pictures, and that those of a part were drawn once."""
NOTED = {"part": "picture", "view": "3-D view"}
"""Kinds of drawings that take long enough to be told."""
WITHOUT_VTK = ("chart", "small")
"""Kinds of drawings that the second process makes."""


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


@dataclass(frozen=True)
class _Line:
    """A process that draws one thing after the other, and the thread that waits for it."""

    process: DrawingProcess
    thread: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1))

    def end(self) -> None:
        self.process.__exit__()  # first: the thread then comes to its end
        self.thread.shutdown(cancel_futures=True)


class RunDrawings:
    """Draws a run's pictures while it goes on; a context that ends the drawing."""

    def __init__(self, context: AnalysisContext) -> None:
        self.context = context
        given_up: dict[str, str] = {}  # by both
        self._of_parts, self._of_charts = (
            _Line(DrawingProcess(gave_up=given_up)) for _ in range(2)
        )
        self._requested: list[tuple[Drawing, Future[bytes]]] = []
        self._small: dict[str, Future[bytes]] = {}

    def __enter__(self) -> RunDrawings:
        return self

    def __exit__(self, *_: object) -> None:
        for line in (self._of_parts, self._of_charts):
            line.end()

    def prepare(self) -> None:
        """Load what draws parts, in its own process, while they are solved; nothing where all is drawn."""
        if not self.context.cache.has(DRAWN, self.context.part("flexspline").torsion_key):
            self._of_parts.thread.submit(self._of_parts.process.draw, load)

    def add_field(self, name: str, field: SolidField) -> None:
        """Begin to draw one of `RunResult.fields`."""
        self.add(of_field(self.context, name, field))

    def add(self, drawings: Iterable[Drawing]) -> None:
        """Begin to draw these, in this order, after what was asked before; charts beside all else."""
        for drawing in drawings:
            self._requested.append((drawing, self._begin(drawing)))

    def kept_in(self, folder: Path) -> RunPictures:
        """Wait for all, and write the pictures.

        A picture of an earlier run that is not drawn now is removed: it may be another design's.
        """
        paths: dict[str, Path] = {}
        views: dict[str, bytes] = {}
        missing: dict[str, str] = {}
        for drawing, made in self._requested:
            name, path = drawing.name, folder / f"{drawing.name}.png"
            if drawing.kind == "view" and name not in paths:
                continue  # the picture stands where scripts do not run
            try:
                if drawing.kind == "view":
                    views[name] = made.result()
                else:
                    write_bytes(path, made.result())
                    paths[name] = path
            except NotDrawnError as error:
                if drawing.kind == "view":
                    missing[f"3-D view {name}"] = str(error)
                else:
                    missing[name] = str(error)
        for name in {*RENDERED, *CHARTS, *missing} - set(paths):
            (folder / f"{name}.png").unlink(missing_ok=True)
        if not missing:
            drawn = self.context.part("flexspline").torsion_key
            self.context.cache.get(DRAWN, drawn, lambda: True)
        smaller = {}
        for name, made in self._small.items():
            with suppress(NotDrawnError):  # pages take the PNG
                smaller[name] = made.result()
        return RunPictures(paths, smaller, views, missing)

    def _begin(self, drawing: Drawing) -> Future[bytes]:
        line = self._of_charts if drawing.kind in WITHOUT_VTK else self._of_parts
        return line.thread.submit(self._drawn, line.process, drawing)

    def _drawn(self, process: DrawingProcess, drawing: Drawing) -> bytes:
        def make() -> bytes:
            if drawing.kind in NOTED:
                self.context.progress.note(f"  {NOTED[drawing.kind]} {drawing.name}")
            return process.draw(drawing.write, *drawing.arguments)

        made, _ = self.context.cache.get(STAGE, drawing.key, make)
        if drawing.kind == "part":
            self._small[drawing.name] = self._begin(small(made))
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
