"""The flexspline on the wave generator: the ellipse, magnified, with its stress."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from flexspline.fea.solid.whole import WholePart, whole_part
from flexspline.fea.types import SolidField
from flexspline.results.renders.picture_elements import (
    Seen,
    goes_beyond,
    magnification,
    peak_mark,
    stress_bar,
    stress_layers,
    stress_note,
    wires,
)
from flexspline.results.renders.remembered import remembered
from flexspline.results.renders.scene import Shot, View, shoot
from flexspline.results.renders.sheet import INSET, MAIN, Mark, Sheet, write_sheet
from flexspline.results.renders.surface import crease_edges, lines, skin
from flexspline.results.renders.turntable import Drawn, turning
from flexspline.results.style import ACCENT

_VIEWS = tuple(View(-68.0, elevation) for elevation in (34.0, 48.0, 62.0, -34.0))
"""Along the minor axis more than the major, so that the ellipse's long side lies across. The first
that shows the peak is drawn; the last looks into a hat from its flange."""
_ALONG_AXIS = View(-90.0, 89.999)
"""Not 90°, where "up" has no direction."""
_STILL = 1e-2
"""Edges that move by less than this part of the size coincide with the deformed ones: not drawn."""


def write_ellipse_picture(path: Path, field: SolidField, amplitude_mm: float) -> None:
    """Write the PNG: deformed shape over the undeformed edges, also seen along the axis.

    Parameters
    ----------
    field : the solution with the seat displaced radially by w0 cos 2φ.
    amplitude_mm : w0.
    """
    scene = _scene(field, amplitude_mm)
    before = lines(scene.whole.nodes, scene.before)

    def shot(seen: Seen, frame: tuple[int, int], line: float) -> Shot:
        layers = stress_layers(seen.points, scene.whole.mises, seen.shown, field.peak, line)
        return shoot([*layers, wires(before, ACCENT, 1.3 * line)], seen.view, frame)

    write_sheet(path, shot(scene.main, MAIN, 2.4), shot(scene.inset, INSET, 2.0), scene.sheet)


def turning_ellipse(field: SolidField, amplitude_mm: float) -> bytes:
    """The same as a view that turns in a browser (`results.renders.turntable`)."""
    scene = _scene(field, amplitude_mm)
    whole, main = scene.whole, scene.main
    drawn = Drawn(
        main.points, whole.mises, main.shown, main.view, field.peak, scene.before, whole.nodes
    )
    return turning(drawn, scene.sheet)


def write_turning_ellipse(path: Path, field: SolidField, amplitude_mm: float) -> None:
    """Write that view."""
    path.write_bytes(turning_ellipse(field, amplitude_mm))


@dataclass(frozen=True)
class _Scene:
    """Both views, the edges (k, 3) that move, and the sheet around them."""

    whole: WholePart
    main: Seen
    inset: Seen
    before: np.ndarray
    sheet: Sheet


@remembered(1)
def _scene(field: SolidField, amplitude_mm: float) -> _Scene:
    whole = whole_part(field.mesh, field.displacement, field.mises, "symmetric")
    shown = skin(whole)
    size = float(np.ptp(whole.nodes[:, 0]))
    factor = magnification(float(np.linalg.norm(field.displacement, axis=1).max()), size)
    shift = factor * whole.displacement
    inset = Seen(whole.nodes + shift, shown, _ALONG_AXIS)
    edges = crease_edges(whole.nodes, shown.facets)
    main, mark = _facing_peak(field, whole.nodes, inset)
    moving = np.linalg.norm(shift, axis=1)[edges].max(axis=1) > _STILL * size
    beyond = goes_beyond(field.peak, shown, whole.mises)
    sheet = Sheet(
        title="Flexspline on the wave generator: stress",
        subtitle=f"von Mises; seat moved radially by w₀ cos 2φ, w₀ = {amplitude_mm:.3g} mm",
        inset_title="along the axis",
        note=f"Displacements drawn {factor:g} times as large. Red: edges before deformation.\n"
        + stress_note(field.peak, beyond),
        bar=stress_bar(field.peak, beyond),
        mark=mark,
    )
    return _Scene(whole, main, inset, edges[moving], sheet)


def _facing_peak(field: SolidField, nodes: np.ndarray, inset: Seen) -> tuple[Seen, Mark]:
    """The first of the views that shows the peak, or the first of all, and the mark in it."""
    views: list[tuple[Seen, Mark]] = []
    for view in _VIEWS:
        seen = Seen(inset.points, inset.shown, view)
        mark = peak_mark(field.peak, field.mesh.sector_deg, nodes, seen, inset)
        if mark.shown_by == "main":
            return seen, mark
        views.append((seen, mark))
    return views[0]
