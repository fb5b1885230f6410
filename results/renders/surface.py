"""Surfaces and edges of quadratic tetrahedra for drawing: a six-node facet is four triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from flexspline.fea.solid.whole import FACES, WholePart
from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.results.renders.remembered import remembered

if TYPE_CHECKING:
    import pyvista as pv

FOUR_TRIANGLES = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
"""A six-node facet (corners, then middles of 01, 12, 20) as four flat triangles."""
CREASE_DEG = 30.0
"""Facets that turn by more than this meet in a drawn edge."""
VIEWS = 2
"""Of a part in a picture: large and small."""


@dataclass(frozen=True)
class Skin:
    """Boundary facets (k, 6) of the cells that are shown, and the patch (k,) of each, -1 if cut."""

    facets: np.ndarray
    patch: np.ndarray


@dataclass(frozen=True)
class Opening:
    """The piece left out of a picture: from `start_deg`, `width_deg` wide; 0 leaves nothing out."""

    start_deg: float
    width_deg: float

    @property
    def middle_deg(self) -> float:
        return self.start_deg + self.width_deg / 2


def opening(sector_deg: float) -> Opening:
    """About 100° from angle 0 in whole sectors, so that the section shows the mesh's own faces."""
    if sector_deg >= 180:
        return Opening(180.0, 180.0)
    return Opening(0.0, sector_deg * max(1, round(100 / sector_deg)))


def skin(part: WholePart, left_out: Opening | None = None) -> Skin:
    """Faces that belong to one shown cell only."""
    shown = np.ones(len(part.cells), bool)
    if left_out is not None:
        angle = (_cell_angle(part) - left_out.start_deg) % 360.0
        shown = angle >= left_out.width_deg
    cells, tags = part.cells[shown], part.face_patch[shown]
    # whole copies are shown: a face inside of one belongs to two shown cells
    outer = tags >= 0 if part.sector_deg < 360 else np.ones(tags.shape, bool)
    faces, tags = cells[:, FACES][outer], tags[outer]
    size = len(part.nodes)
    c = np.sort(faces[:, :3], axis=1).astype(np.int64)
    _, first, count = np.unique(
        (c[:, 0] * size + c[:, 1]) * size + c[:, 2], return_index=True, return_counts=True
    )
    alone = np.sort(first[count == 1])
    return Skin(faces[alone], tags[alone])


def _cell_angle(part: WholePart) -> np.ndarray:
    """Where a cell counts: the middle of its copy, or its own centre if the part is one copy."""
    if part.sector_deg < 360:
        return part.start_deg + part.sector_deg / 2
    centre = part.nodes[part.cells[:, :4]].mean(axis=1)
    return np.degrees(np.arctan2(centre[:, 1], centre[:, 0]))


@remembered(VIEWS)
def surface(points: np.ndarray, facets: np.ndarray, curved: bool = True) -> pv.PolyData:
    """Triangles over the facets' own nodes; point array "node" keeps each point's node index.

    `curved` takes four triangles for a facet, else one through its corners.
    """
    import pyvista as pv

    facets = facets if curved else facets[:, :3]
    used, local = np.unique(facets, return_inverse=True)
    triangles = local.reshape(facets.shape)[:, FOUR_TRIANGLES if curved else [0, 1, 2]].reshape(
        -1, 3
    )
    mesh = pv.PolyData.from_regular_faces(points[used], triangles.astype(int))
    mesh.point_data["node"] = used
    return mesh.compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=CREASE_DEG, consistent_normals=False
    )


def element_edges(points: np.ndarray, facets: np.ndarray) -> pv.PolyData:
    """The element edges of the facets as lines through their middle nodes."""
    edges = _edges(facets)
    _, first = np.unique(edges[:, 1], return_index=True)  # a middle node belongs to one edge
    return lines(points, edges[first])


def _edges(facets: np.ndarray) -> np.ndarray:
    """Nodes (3m, 3) of the edges of facets (m, 6): corner, middle, corner."""
    return np.concatenate([facets[:, [0, 3, 1]], facets[:, [1, 4, 2]], facets[:, [2, 5, 0]]])


def creases(points: np.ndarray, facets: np.ndarray) -> pv.PolyData:
    """Element edges at which the surface turns by more than CREASE_DEG, or ends."""
    return lines(points, crease_edges(points, facets))


@remembered(VIEWS)
def crease_edges(points: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Nodes (k, 3) of those edges: corner, middle, corner."""
    edges = _edges(facets)
    a, b, c = (points[facets[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), ABOVE_ZERO)[:, None]
    owner = np.tile(np.arange(len(facets)), 3)
    order = np.argsort(edges[:, 1], kind="stable")
    _, begin, count = np.unique(edges[order, 1], return_index=True, return_counts=True)
    one, other = owner[order[begin]], owner[order[np.minimum(begin + 1, len(order) - 1)]]
    turned = np.einsum("ij,ij->i", normal[one], normal[other]) < np.cos(np.radians(CREASE_DEG))
    return edges[order[begin[(count != 2) | turned]]]


def lines(points: np.ndarray, edges: np.ndarray) -> pv.PolyData:
    """Polylines through the nodes (k, 3) of edges."""
    import pyvista as pv

    used, local = np.unique(edges, return_inverse=True)
    cells = np.column_stack([np.full(len(edges), 3), local.reshape(-1, 3)])
    return pv.PolyData(points[used], lines=cells.ravel())
