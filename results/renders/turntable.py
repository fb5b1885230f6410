"""A coloured surface that turns in a browser: scene, colour scale, mark and words as one JSON value."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexspline.fea.types import StressPeak
from flexspline.results.renders.scene import View
from flexspline.results.renders.sheet import Bar, Mark, ticks
from flexspline.results.renders.surface import Skin, crease_edges, surface
from flexspline.results.renders.vtkjs import (
    actor,
    array,
    colour_table,
    polydata,
    short,
    window,
    zipped,
)
from flexspline.results.style import ACCENT, INK

COARSE_BEYOND = 45_000
"""Facets beyond which each is one flat triangle, not four: a view stays below about 2 MB."""
_MARGIN = 1.01
"""Half the picture over the radius of the part's bounding sphere: nothing is cut off, however turned."""


@dataclass(frozen=True)
class Drawn:
    """What is turned.

    Attributes
    ----------
    points : (n, 3) mm, where the nodes are drawn; mises : (n,) MPa.
    shown : the facets; before : (k, 3) edges drawn in red, at `before_points` (n, 3).
    """

    points: np.ndarray
    mises: np.ndarray
    shown: Skin
    view: View
    peak: StressPeak
    before: np.ndarray | None = None
    before_points: np.ndarray | None = None


@dataclass(frozen=True)
class Said:
    """The words around a view."""

    title: str
    subtitle: str
    note: str
    bar: Bar
    mark: Mark


def turning(name: str, drawn: Drawn, said: Said) -> bytes:
    """The view as JSON: its words, scale and mark, and the scene in base64.

    Parameters
    ----------
    name : tells this view's objects from those of the others in the same page.
    """
    facets = drawn.shown.facets
    mesh = surface(drawn.points, facets, len(facets) <= COARSE_BEYOND)
    node = np.asarray(mesh.point_data["node"])
    normals = np.asarray(mesh.point_data["Normals"], dtype=np.float32)
    arrays: dict[str, np.ndarray] = {}
    skin = polydata(arrays, f"{name}-skin", np.asarray(mesh.points), mesh.regular_faces, "polys")
    skin["fields"] = [
        array(arrays, f"{name}-normals", short(normals, 8), "Normals", registration="setNormals"),
        array(arrays, f"{name}-mises", short(drawn.mises[node], 11), "mises",
               registration="setScalars"),
    ]  # fmt: skip
    wires = [(crease_edges(drawn.points, facets), drawn.points, INK, 1.0)]
    if drawn.before is not None and drawn.before_points is not None:
        wires.append((drawn.before, drawn.before_points, ACCENT, 1.0))
    actors = [actor(f"{name}-part", skin, drawn.peak.mises_MPa)]
    for i, (edges, points, colour, width) in enumerate(wires):
        used, local = np.unique(edges, return_inverse=True)
        lines = polydata(arrays, f"{name}-line{i}", points[used], local.reshape(-1, 3), "lines")
        actors.append(actor(f"{name}-wire{i}", lines, None, colour, width))
    camera = _camera(drawn.points[np.unique(facets)], drawn.view)
    inside, labels = ticks(said.bar.high)
    marks = [*zip(inside, labels, strict=True), (said.bar.high, said.bar.high_text)]
    nearest = int(np.argmin(((np.asarray(mesh.points) - said.mark.at_mm) ** 2).sum(axis=1)))
    view = {
        "title": said.title,
        "subtitle": said.subtitle,
        "note": said.note.replace("\n", " "),
        "bar": {
            "label": said.bar.label,
            "beyond": said.bar.beyond,
            "ticks": [{"at": round(v / said.bar.high, 4), "text": t} for v, t in marks],
        },
        "mark": {
            "text": said.mark.text.replace("\n(hidden)", ""),
            "at": _rounded(said.mark.at_mm),
            "normal": _rounded(normals[nearest]),
        },
        "ramp": _ramp(),
        "camera": camera,
        "scene": base64.b64encode(zipped(window(name, actors, camera), arrays)).decode(),
    }
    return json.dumps(view).encode()


def _ramp() -> list[str]:
    """Colours of the scale from 0 up, evenly spaced, as CSS has them."""
    return ["#{:02x}{:02x}{:02x}".format(*c[:3]) for c in colour_table()[:: 255 // 15]]


def _camera(points: np.ndarray, view: View) -> dict[str, Any]:
    """Parallel projection on the middle of the points, near enough to show them however turned."""
    low, high = points.min(axis=0), points.max(axis=0)
    centre = (low + high) / 2
    radius = float(np.linalg.norm(points - centre, axis=1).max())
    eye = view.axes
    return {
        "focalPoint": _rounded(centre),
        "position": _rounded(centre + 5 * radius * eye[2]),
        "viewUp": _rounded(eye[1]),
        "parallelProjection": True,
        "parallelScale": round(_MARGIN * radius, 4),
        "clippingRange": [round(2 * radius, 4), round(8 * radius, 4)],
    }


def _rounded(values: np.ndarray) -> list[float]:
    return [round(float(v), 5) for v in values]
