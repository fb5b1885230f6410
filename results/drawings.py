"""Pictures and views of a run: the content of each, and its inputs."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from flexspline.fea.types import SolidField
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
from flexspline.pipeline.packing import packed
from flexspline.pipeline.parts import AnalysisContext
from flexspline.results.figures.chart import chart
from flexspline.results.file_names import CHARTS, ELLIPSE
from flexspline.results.renders.ellipse_picture import write_ellipse_picture, write_turning_ellipse
from flexspline.results.renders.mesh_picture import write_mesh_picture
from flexspline.results.renders.stress_picture import (
    write_torque_stress,
    write_turning_torque_stress,
)
from flexspline.results.renders.webp import write_webp

TITLES: Mapping[PartName, str] = {"flexspline": "Flexspline", "shaft": "Output shaft"}
DRAWING = 13
"""Raise when a drawing changes, so that kept pictures are drawn again."""
TURNING = 3
"""The same of the 3-D views."""


@dataclass(frozen=True)
class Drawing:
    """A picture of a part, that as WebP, a chart, or the view of a picture's part that turns in a browser.

    Attributes
    ----------
    inputs : what it depends on beside its name. write, arguments : `write(path, *arguments)` makes its file.
    """

    name: str
    kind: Literal["part", "small", "chart", "view"]
    inputs: Mapping[str, Any]
    write: Callable[..., None]
    arguments: tuple[Any, ...]

    @property
    def key(self) -> Mapping[str, Any]:
        """What it is kept by."""
        return {"drawing": DRAWING, "name": self.name, **self.inputs}


def of_field(context: AnalysisContext, name: str, field: SolidField) -> Iterator[Drawing]:
    """What shows a field of `RunResult.fields`: a part's mesh, its stress, and that as a view.

    Each is kept by all that it is drawn from: one part has other fields where a solve was cut short.
    """
    turning = {"turning": TURNING}
    if name == ELLIPSE:
        moved = field, context.design.w0_mm
        yield Drawing(name, "part", _content(moved), write_ellipse_picture, moved)
        yield Drawing(name, "view", turning | _content(moved), write_turning_ellipse, moved)
        return
    part = next(part for part in TITLES if name == f"{part}_torque")
    title = TITLES[part]
    if field.left_out:
        title += f" without {field.left_out}"
    meshed, shown = (field.mesh, title), (field, title, context.design.load.torque_Nm)
    yield Drawing(f"{part}_mesh", "part", _content(meshed), write_mesh_picture, meshed)
    yield Drawing(name, "part", _content(shown), write_torque_stress, shown)
    yield Drawing(name, "view", turning | _content(shown), write_turning_torque_stress, shown)


def small(png: bytes) -> Drawing:
    """A picture as WebP."""
    return Drawing("webp", "small", {"sha256": _digest(png)}, write_webp, (png,))


def charts(result: RunResult, extended: ExtendedBacklash | None) -> Iterator[Drawing]:
    """The charts that have something to show; each is kept by all that it is drawn from."""
    for name in CHARTS:
        one = chart(name)
        arguments = one.arguments(result, extended)
        if arguments is not None:
            yield Drawing(name, "chart", _content(arguments), one.write, arguments)


def _content(arguments: tuple[Any, ...]) -> dict[str, Any]:
    return {"sha256": _digest(packed(arguments))}


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
