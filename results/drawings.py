"""Which pictures and views there are of a run: what each shows, and what it depends on."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from flexspline.fea.types import SolidField
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, angle_rad
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
from flexspline.pipeline.parts import AnalysisContext
from flexspline.results.figures.budget import write_budget
from flexspline.results.figures.convergence import write_convergence
from flexspline.results.figures.gear import write_gear_angle, write_gear_loads
from flexspline.results.figures.torque_angle import drawn_branch, write_torque_angle
from flexspline.results.file_names import BUDGET, CONVERGENCE, CURVE, ELLIPSE, LOADS, TORQUE_ANGLE
from flexspline.results.renders.ellipse_picture import write_ellipse_picture, write_turning_ellipse
from flexspline.results.renders.mesh_picture import write_mesh_picture
from flexspline.results.renders.stress_picture import (
    write_torque_stress,
    write_turning_torque_stress,
)
from flexspline.results.renders.webp import write_webp

TITLES: Mapping[PartName, str] = {"flexspline": "Flexspline", "shaft": "Output shaft"}
DRAWING = 10
"""Raise when a drawing changes, so that kept pictures are drawn again."""
TURNING = 3
"""The same of the 3-D views."""


def drawing_key(name: str, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
    """What a drawing is kept by."""
    return {"drawing": DRAWING, "name": name, **inputs}


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
        return drawing_key(self.name, self.inputs)


def of_field(
    context: AnalysisContext, name: str, field: SolidField
) -> Iterator[tuple[Drawing, ...]]:
    """What shows a field of `RunResult.fields`: a part's mesh; its stress, with that as a view."""
    turning = {"turning": TURNING}
    if name == ELLIPSE:
        w0 = context.design.w0_mm
        inputs: dict[str, Any] = {**context.part("flexspline").torsion_key, "w0_mm": w0}
        yield (
            Drawing(name, "part", inputs, write_ellipse_picture, (field, w0)),
            Drawing(name, "view", turning | inputs, write_turning_ellipse, (field, w0)),
        )
        return
    part = next(part for part in TITLES if name == f"{part}_torque")
    title, torque, solved = (
        TITLES[part],
        context.design.load.torque_Nm,
        context.part(part).torsion_key,
    )
    if field.left_out:
        title += f" without {field.left_out}"
    yield (Drawing(f"{part}_mesh", "part", solved, write_mesh_picture, (field.mesh, title)),)
    inputs = {**solved, "torque_Nm": torque}
    shown = field, title, torque
    yield (
        Drawing(name, "part", inputs, write_torque_stress, shown),
        Drawing(name, "view", turning | inputs, write_turning_torque_stress, shown),
    )


def small(png: bytes) -> Drawing:
    """A picture as WebP."""
    return Drawing("webp", "small", {"sha256": hashlib.sha256(png).hexdigest()}, write_webp, (png,))


def charts(result: RunResult, extended: ExtendedBacklash | None) -> Iterator[Drawing]:
    """The charts; without `CONVERGENCE` where every stiffness was solved on one mesh."""
    design, found, backlash = result.design, result.stiffnesses, result.backlash
    torque = design.load.torque_Nm
    K_b, K_e = found.in_sum(design).K_Nm_per_rad, found.K_e.K_Nm_per_rad
    solved = {"K_b_Nm_per_rad": found.K_b, "K_e_Nm_per_rad": found.K_e}
    settling = {key: K for key, K in solved.items() if len(K.levels) > 1}

    def angle(torque: np.ndarray) -> np.ndarray:
        return np.asarray(angle_rad(design, torque, K_b, K_e)) * ARCSEC_PER_RAD

    def chart(
        name: str, inputs: Mapping[str, Any], write: Callable[..., None], *shown: Any
    ) -> Drawing:
        return Drawing(name, "chart", inputs, write, shown)

    sums = {"backlash": asdict(backlash), "torque_Nm": torque}
    added = None if extended is None else asdict(extended)
    yield chart(BUDGET, {**sums, "extended": added}, write_budget, backlash, extended)
    branch = drawn_branch(angle, torque)
    yield chart(
        TORQUE_ANGLE, {**sums, "K": [K_b, K_e]}, write_torque_angle, branch, torque, backlash
    )
    if result.gear is not None:
        for name, write in ((CURVE, write_gear_angle), (LOADS, write_gear_loads)):
            yield chart(name, {"curve": asdict(result.gear)}, write, result.gear)
    if settling:
        levels = {key: asdict(K) for key, K in settling.items()}
        yield chart(CONVERGENCE, levels, write_convergence, settling)
