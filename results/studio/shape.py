"""A meridian field as bytes for the page, which turns it about the axis itself."""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.geometry.outline import SAME_mm
from flexspline.results.numbers import decimals_for, grouped
from flexspline.results.page_3d.arrays import packed
from flexspline.results.renders.picture_elements import magnification
from flexspline.results.renders.surface import FOUR_TRIANGLES
from flexspline.results.studio.simplify import simplified

PLACE = 2e-4
"""Of the part's size: a fifth of a pixel where it fills a thousand."""
COLOUR = 0.01
"""Of the colour scale, and of the largest displacement: two of 256 colours."""
TICKS = 4
"""Of the colour scale, beside 0."""


def field_message(view: str, field: RevolvedField) -> bytes:
    """Places, displacement, stress and triangles of a solved meridian.

    `direct` and `shear` are the squared von Mises stresses [MPa²] that go with cos² nφ and sin² nφ
    (n = 0: all in `direct`).
    """
    around = [field.mises(0.0) ** 2]
    around.append(field.mises(np.pi / (2 * field.n)) ** 2 if field.n else 0 * around[0])
    largest = float(np.abs(field.displacement).max())
    size = 2 * float(field.places[:, 0].max())
    cells = field.triangles[:, FOUR_TRIANGLES].reshape(-1, 3)
    head = {
        "is": "field",
        "view": view,
        "n": field.n,
        "peak_MPa": field.peak.mises_MPa,
        "ticks_MPa": _ticks(field.peak.mises_MPa),
        "peak_at_mm": list(field.peak.at_mm),
        "excluded": field.peak.excluded,
        "magnification": magnification(largest, size),
    }
    arrays = {
        "places": field.places,
        "displacement": field.displacement,
        "direct": around[0],
        "shear": around[1],
        "triangles": _one_way(field.places, cells),
        "rim": simplified(_rim(field.places, cells), _seen(field, around, size)),
    }
    return packed(head, arrays)


def _ticks(peak: float) -> list[str]:
    """What stands beside the colour scale, from its upper end to 0."""
    places = decimals_for(peak, 3)
    return [grouped(peak * i / TICKS, places) for i in range(TICKS, -1, -1)]


def _seen(field: RevolvedField, around: list[np.ndarray], size: float) -> np.ndarray:
    """What is drawn of each node, (count, 7), in units of what the eye makes out."""
    peak = field.peak.mises_MPa or 1.0
    moved = field.displacement / (np.abs(field.displacement).max() or 1.0)
    colours = np.sqrt(np.column_stack(around)) / peak
    return np.column_stack(
        [field.places / (PLACE * size), moved / COLOUR, np.minimum(colours, 1) / COLOUR]
    )


def profile_message(view: str, polygon: np.ndarray) -> bytes:
    """An outline (n, 2) without a solution, the same way round as the rim of a field."""
    count = len(polygon)
    rim = np.column_stack([np.arange(count), (np.arange(count) + 1) % count])
    head = {"is": "profile", "view": view}
    return packed(head, {"places": polygon, "rim": _off_axis(polygon, rim)})


def _one_way(places: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """All triangles counter-clockwise in (r, z)."""
    a, b, c = (places[cells[:, i]] for i in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    return np.where((area > 0)[:, None], cells, cells[:, [0, 2, 1]])


def _rim(places: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Edges (k, 2) of one triangle only, the material on their left, none on the axis."""
    turned = _one_way(places, cells)
    edges = turned[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    low, high = edges.min(axis=1).astype(np.int64), edges.max(axis=1)
    _, index, count = np.unique(
        low * (len(places) + 1) + high, return_index=True, return_counts=True
    )
    return _off_axis(places, edges[index[count == 1]])


def _off_axis(places: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return edges[(places[edges][:, :, 0] > SAME_mm).any(axis=1)]
