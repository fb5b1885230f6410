"""A coloured surface as a scene for vtk.js: what a browser turns, with its scale and its mark.

A scene is the state that vtk.js' synchronizable render window reads (the format of trame-vtk's
viewer): objects with their properties, arrays apart, zipped. It is written here and not taken from
trame-vtk's serializer, whose object ids are memory addresses: the same content gives the same bytes.
"""

from __future__ import annotations

import base64
import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fea.types import StressPeak
from results.renders.scene import View
from results.renders.sheet import Bar, Mark, ticks
from results.renders.shown import FLAT_LIT
from results.renders.surface import Skin, crease_edges, surface
from results.style import ACCENT, COLOUR_MAP, INK

COARSE_BEYOND = 45_000
"""Facets beyond which each is one flat triangle, not four: a view stays below about 2 MB."""
_MARGIN = 1.12
"""Half the height of the picture over the radius of the part's bounding sphere's silhouette."""


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
    skin = _polydata(arrays, f"{name}-skin", np.asarray(mesh.points), mesh.regular_faces, "polys")
    skin["fields"] = [
        _array(arrays, f"{name}-normals", _short(normals, 8), "Normals", registration="setNormals"),
        _array(arrays, f"{name}-mises", _short(drawn.mises[node], 11), "mises",
               registration="setScalars"),
    ]  # fmt: skip
    wires = [(crease_edges(drawn.points, facets), drawn.points, INK, 1.0)]
    if drawn.before is not None and drawn.before_points is not None:
        wires.append((drawn.before, drawn.before_points, ACCENT, 1.0))
    actors = [_actor(f"{name}-part", skin, drawn.peak.mises_MPa)]
    for i, (edges, points, colour, width) in enumerate(wires):
        used, local = np.unique(edges, return_inverse=True)
        lines = _polydata(arrays, f"{name}-line{i}", points[used], local.reshape(-1, 3), "lines")
        actors.append(_actor(f"{name}-wire{i}", lines, None, colour, width))
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
        "camera": camera,
        "scene": base64.b64encode(_zipped(_window(name, actors, camera), arrays)).decode(),
    }
    return json.dumps(view).encode()


def ramp() -> list[str]:
    """Colours of the scale from 0 up, evenly spaced, as CSS has them."""
    return ["#{:02x}{:02x}{:02x}".format(*c[:3]) for c in _table()[:: 255 // 15]]


def _table() -> list[list[int]]:
    import matplotlib as mpl

    colours = mpl.colormaps[COLOUR_MAP](np.arange(256), bytes=True)
    return [[int(v) for v in c] for c in colours]


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


def _polydata(
    arrays: dict[str, np.ndarray], name: str, points: np.ndarray, cells: np.ndarray, kind: str
) -> dict[str, Any]:
    number = np.uint16 if len(points) < 2**16 else np.uint32
    rows = np.column_stack([np.full(len(cells), cells.shape[1]), cells]).astype(number)
    return {
        "points": _array(arrays, f"{name}-p", _short(points, 13), "Points", "vtkPoints"),
        kind: _array(arrays, f"{name}-c", rows.ravel(), "cells", "vtkCellArray"),
    }


def _short(values: np.ndarray, bits: int) -> np.ndarray:
    """float32 rounded to `bits` of mantissa, the rest zero: what no eye sees need not be packed.

    13 bits place a point of a 40 mm part within 0.002 mm, 11 tell 2048 stresses, 8 turn a normal by
    less than 0.2°.
    """
    whole = np.ascontiguousarray(values, dtype=np.float32).view(np.uint32)
    half = np.uint32(1 << (22 - bits))
    return ((whole + half) & np.uint32(0xFFFFFFFF << (23 - bits) & 0xFFFFFFFF)).view(np.float32)


def _array(
    arrays: dict[str, np.ndarray],
    key: str,
    values: np.ndarray,
    name: str,
    kind: str = "vtkDataArray",
    registration: str = "",
) -> dict[str, Any]:
    arrays[key] = values
    found: dict[str, Any] = {
        "hash": key,
        "vtkClass": kind,
        "name": name,
        "dataType": f"{values.dtype.name.capitalize()}Array",
        "numberOfComponents": 1 if values.ndim == 1 else values.shape[1],
        "size": int(values.size),
    }
    if registration:
        found |= {"location": "pointData", "registration": registration}
    return found


def _actor(
    name: str, data: Mapping[str, Any], high: float | None, colour: str = INK, width: float = 1.0
) -> dict[str, Any]:
    """A surface coloured from 0 to `high`, or lines of one colour."""
    coloured = high is not None
    lut = {
        "numberOfColors": 256,
        "table": _table() if coloured else [[0, 0, 0, 255]],
        "range": [0.0, high or 1.0],
    }
    mapper = {
        "scalarVisibility": coloured,
        "colorMode": 1,
        "scalarMode": 1,
        "interpolateScalarsBeforeMapping": True,
        "scalarRange": [0.0, high or 1.0],
        "useLookupTableScalarRange": False,
        # the surface is set back a little, or it would swallow pieces of the lines on it
        "resolveCoincidentTopology": 1 if coloured else 0,
    }
    flat = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    look = {"lineWidth": width, "color": flat, "diffuseColor": flat, "ambientColor": flat,
            "interpolation": 1}  # fmt: skip
    look |= FLAT_LIT if coloured else {"ambient": 1.0, "diffuse": 0.0, "lighting": False}
    return _object(
        "vtkActor", name, {"visibility": True},
        [
            _object(
                "vtkMapper", f"{name}-mapper", mapper,
                [
                    _object("vtkPolyData", f"{name}-data", data),
                    _object("vtkLookupTable", f"{name}-lut", lut),
                ],
                {"setInputData": f"{name}-data", "setLookupTable": f"{name}-lut"},
            ),
            _object("vtkProperty", f"{name}-look", look),
        ],
        {"setMapper": f"{name}-mapper", "setProperty": f"{name}-look"},
    )  # fmt: skip


def _window(name: str, actors: list[dict[str, Any]], camera: dict[str, Any]) -> dict[str, Any]:
    seen = _object("vtkCamera", f"{name}-camera", camera)
    renderer = _object(
        "vtkRenderer", f"{name}-renderer", {"background": [1.0, 1.0, 1.0], "twoSidedLighting": True},
        [seen, *actors],
        {"setActiveCamera": seen["id"]},
    )  # fmt: skip
    renderer["calls"] += [["addViewProp", [f"instance:${{{a['id']}}}"]] for a in actors]
    window = _object(
        "vtkRenderWindow", f"{name}-window", {"numberOfLayers": 1}, [renderer],
        {"addRenderer": renderer["id"]},
    )  # fmt: skip
    return window | {"mtime": 1}


def _object(
    kind: str,
    name: str,
    properties: Mapping[str, Any],
    parts: list[dict[str, Any]] | None = None,
    calls: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    return {
        "id": name,
        "type": kind,
        "properties": dict(properties),
        "dependencies": parts or [],
        "calls": [[call, [f"instance:${{{target}}}"]] for call, target in (calls or {}).items()],
    }


def _zipped(scene: dict[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    hashes = {
        key: {"content": base64.b64encode(np.ascontiguousarray(values).tobytes()).decode()}
        for key, values in arrays.items()
    }
    text = json.dumps({"scene": scene, "hashes": hashes}, separators=(",", ":"))
    buffer = io.BytesIO()
    entry = zipfile.ZipInfo("index.json", (2000, 1, 1, 0, 0, 0))  # the same bytes on any day
    entry.compress_type = zipfile.ZIP_DEFLATED
    with zipfile.ZipFile(buffer, "w") as out:
        out.writestr(entry, text, compresslevel=6)
    return buffer.getvalue()
