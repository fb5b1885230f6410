"""A coloured surface that can be turned in a browser: scene, colour scale, mark and words as JSON."""

from __future__ import annotations

import base64
import json
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexspline.fea.types import StressPeak
from flexspline.results.page_3d.arrays import packed
from flexspline.results.renders.scene import View
from flexspline.results.renders.sheet import Sheet, ticks
from flexspline.results.renders.surface import Skin, crease_edges, surface
from flexspline.results.style import ACCENT, INK

COARSE_BEYOND = 45_000
"""Facets beyond which each is one flat triangle, not four: a view stays below about 1.4 MB."""
STEPS = 65535
"""Of a coordinate, in 16 bits."""
LEVELS = 2047
"""Of stress, from 0 to the peak: eight to a colour of the scale."""
_MARGIN = 1.01
"""Half the picture over the radius of the part's bounding sphere: nothing is cut off, however turned."""
ZLIB_LEVEL = 4
"""Whole numbers of close places: 9 takes two to three times as long and 1 to 4 % more room."""


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


def turning(drawn: Drawn, sheet: Sheet) -> bytes:
    """The view as JSON: words, scale and mark of the picture's `sheet`, and the scene in base64."""
    bar, mark = sheet.bar, sheet.mark
    assert bar is not None
    assert mark is not None
    facets = drawn.shown.facets
    mesh = surface(drawn.points, facets, len(facets) <= COARSE_BEYOND)
    node, skin = np.asarray(mesh.point_data["node"]), np.asarray(mesh.points)
    inside, labels = ticks(bar.high)
    marks = [*zip(inside, labels, strict=True), (bar.high, bar.high_text)]
    nearest = int(np.argmin(((skin - mark.at_mm) ** 2).sum(axis=1)))
    view = {
        "title": sheet.title,
        "subtitle": sheet.subtitle,
        "note": sheet.note.replace("\n", " "),
        "bar": {
            "label": bar.label,
            "beyond": bar.beyond,
            "ticks": [{"at": round(v / bar.high, 4), "text": t} for v, t in marks],
        },
        "mark": {
            "text": mark.text.replace("\n(hidden)", ""),
            "at": _rounded(mark.at_mm),
            "normal": _rounded(mesh.point_data["Normals"][nearest]),
        },
        "camera": _camera(drawn.points[np.unique(facets)], drawn.view),
        "scene": _scene(drawn, skin, mesh.regular_faces, drawn.mises[node]),
    }
    return json.dumps(view).encode()


def _scene(drawn: Drawn, skin: np.ndarray, triangles: np.ndarray, mises: np.ndarray) -> str:
    """Points, stress over the peak, triangles and lines, packed and in base64.

    Every coordinate in steps of the part's size over 65535 (40 mm: 0.6 µm), all x before all y: half the
    bytes of whole points, and no eye sees the difference.
    """
    wires = [("edges", INK, crease_edges(drawn.points, drawn.shown.facets), drawn.points)]
    if drawn.before is not None and drawn.before_points is not None:
        wires.append(("before", ACCENT, drawn.before, drawn.before_points))
    points, lines = [skin], {}
    for name, _, edges, at in wires:
        used, local = np.unique(edges, return_inverse=True)
        halves = local.reshape(-1, 3)[:, [[0, 1], [1, 2]]].reshape(-1, 2)
        lines[name] = halves + sum(map(len, points))
        points.append(at[used])
    everywhere = np.concatenate(points)
    low, step = everywhere.min(axis=0), float(np.ptp(everywhere, axis=0).max()) / STEPS
    along = np.clip(mises / drawn.peak.mises_MPa, 0, 1) * LEVELS
    head = {
        "low_mm": low.tolist(),
        "step_mm": step,
        "levels": LEVELS,
        "lines": {name: colour for name, colour, _, _ in wires},
    }
    arrays = {
        "places": np.round((everywhere - low) / step).astype(np.uint16).T,
        "along": np.round(along).astype(np.uint16),
        "triangles": triangles,
        **lines,
    }
    return base64.b64encode(zlib.compress(packed(head, arrays), ZLIB_LEVEL)).decode()


def _camera(points: np.ndarray, view: View) -> dict[str, Any]:
    """On the middle of the points, the picture's half wide enough to show them however turned."""
    low, high = points.min(axis=0), points.max(axis=0)
    centre = (low + high) / 2
    radius = float(np.linalg.norm(points - centre, axis=1).max())
    return {
        "centre": _rounded(centre),
        "eye": _rounded(view.axes[2]),
        "half": round(_MARGIN * radius, 4),
    }


def _rounded(values: np.ndarray) -> list[float]:
    return [round(float(v), 5) for v in values]
