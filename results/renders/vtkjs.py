"""Scenes as vtk.js' synchronizable render window reads them (the format of trame-vtk's viewer).

Objects with their properties, arrays apart, zipped. Written here and not by trame-vtk's serializer,
whose object ids are memory addresses: the same content gives the same bytes.
"""

from __future__ import annotations

import base64
import io
import json
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np

from flexspline.results.renders.picture_elements import FLAT_LIT
from flexspline.results.style import COLOUR_MAP, INK


def colour_table() -> list[list[int]]:
    """The colour map as vtkLookupTable takes it: 256 rows of red, green, blue, alpha."""
    import matplotlib as mpl

    colours = mpl.colormaps[COLOUR_MAP](np.arange(256), bytes=True)
    return [[int(v) for v in c] for c in colours]


def polydata(
    arrays: dict[str, np.ndarray], name: str, points: np.ndarray, cells: np.ndarray, kind: str
) -> dict[str, Any]:
    """A vtkPolyData of points (n, 3) and cells (k, corners); its arrays join `arrays`.

    Parameters
    ----------
    kind : "polys" or "lines".
    """
    number = np.uint16 if len(points) < 2**16 else np.uint32
    rows = np.column_stack([np.full(len(cells), cells.shape[1]), cells]).astype(number)
    return {
        "points": array(arrays, f"{name}-p", short(points, 13), "Points", "vtkPoints"),
        kind: array(arrays, f"{name}-c", rows.ravel(), "cells", "vtkCellArray"),
    }


def short(values: np.ndarray, bits: int) -> np.ndarray:
    """float32 rounded to `bits` of mantissa, the rest zero: what no eye sees need not be packed.

    13 bits place a point of a 40 mm part within 0.002 mm, 11 tell 2048 stresses, 8 turn a normal by
    less than 0.2°.
    """
    whole = np.ascontiguousarray(values, dtype=np.float32).view(np.uint32)
    half = np.uint32(1 << (22 - bits))
    return ((whole + half) & np.uint32(0xFFFFFFFF << (23 - bits) & 0xFFFFFFFF)).view(np.float32)


def array(
    arrays: dict[str, np.ndarray],
    key: str,
    values: np.ndarray,
    name: str,
    kind: str = "vtkDataArray",
    registration: str = "",
) -> dict[str, Any]:
    """What stands for an array in a scene; `registration` is the point data's setter, "setScalars"."""
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


def actor(
    name: str, data: Mapping[str, Any], high: float | None, colour: str = INK, width: float = 1.0
) -> dict[str, Any]:
    """A surface coloured from 0 to `high`, or lines of one colour."""
    coloured = high is not None
    lut = {
        "numberOfColors": 256,
        "table": colour_table() if coloured else [[0, 0, 0, 255]],
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


def window(name: str, actors: list[dict[str, Any]], camera: dict[str, Any]) -> dict[str, Any]:
    """The whole scene; `name` tells its objects from those of other scenes in a page."""
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


def zipped(scene: dict[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """The file that the viewer loads."""
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
