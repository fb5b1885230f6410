"""Adds patch edges on smooth surfaces to a mesher's mesh, which keeps corners but no lines on a plane.

Where mesh edges cross a patch edge, near ends move onto it and the other edges are halved there with all
their tetrahedra, after the warping and cutting of Labelle and Shewchuk, Isosurface stuffing, ACM
Transactions on Graphics 26 (2007) 57.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.fea.edges import SIDES, distinct_edges
from flexspline.fea.solid.bisect import Simplices, halved
from flexspline.fea.solid.snap import undo_inverted
from flexspline.fea.solid.unroll import MeshingMap
from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.geometry.outline import SAME_mm, joins_smoothly
from flexspline.geometry.surfaces import Surface, Swept

NEAR_EDGE_SHARE = 0.3
"""A node moves onto the patch edge if it is nearer than this share of the crossing mesh edge. Judgement: a
cut so near to a node leaves flat elements, a node that moves farther bends its neighbours."""
SLIP = 0.1
"""How far a moved node may leave another surface, as a share of its move. Moves along a curved surface stay
below it, moves across a surface do not. Judgement."""


@dataclass(frozen=True)
class PatchEdge:
    """A circle about the axis where two surfaces that join smoothly have different patches.

    `rz` (2,) [mm] and the meridian's tangent there; `first`, `second`: the surfaces before and after.
    """

    first: int
    second: int
    rz: np.ndarray
    tangent: np.ndarray

    def beyond(self, points: np.ndarray) -> np.ndarray:
        """Return how far (n,) [mm] points (n, 3) are beyond the circle, along the meridian."""
        return (_meridional(points) - self.rz) @ self.tangent

    def reached(self, points: np.ndarray) -> np.ndarray:
        """Return the points (n, 3) moved along the meridian onto the circle."""
        rz = _meridional(points)
        moved = rz - self.beyond(points)[:, None] * self.tangent
        scale = moved[:, 0] / np.maximum(rz[:, 0], ABOVE_ZERO)
        return np.column_stack([points[:, :2] * scale[:, None], moved[:, 1]])


def smooth_patch_edges(surfaces: Sequence[Surface]) -> Iterator[PatchEdge]:
    """Return the smooth patch edges between the swept surfaces of a part."""
    swept = [(i, s.segment) for i, s in enumerate(surfaces) if isinstance(s, Swept)]
    for i, a in swept:
        for j, b in swept:
            if joins_smoothly(a, b) and a.patch != b.patch:
                yield PatchEdge(i, j, np.array(b.start), b.tangent(0))


@dataclass(frozen=True)
class MesherMesh:
    """A mesher's mesh: points (n, 3) mm in meshing space, tets (m, 4), boundary faces (k, 3).

    `facet_surface` (k,): the index of the surface that each face lies on.
    """

    points: np.ndarray
    tets: np.ndarray
    faces: np.ndarray
    facet_surface: np.ndarray


def with_patch_edges(
    mesh: MesherMesh, surfaces: Sequence[Surface], space: MeshingMap
) -> MesherMesh:
    """Return the mesh in which no face crosses a patch edge, and each is on its side's surface."""
    for edge in smooth_patch_edges(surfaces):
        mesh = _with(mesh, edge, surfaces, space)
    return mesh


def _with(
    mesh: MesherMesh, edge: PatchEdge, surfaces: Sequence[Surface], space: MeshingMap
) -> MesherMesh:
    """One patch edge: near nodes onto it, other crossing edges halved, faces given to their side."""
    whole = space.back(mesh.points)
    on_both = np.isin(mesh.facet_surface, (edge.first, edge.second))
    sides = distinct_edges(mesh.faces[on_both][:, SIDES], len(mesh.points))
    beyond = edge.beyond(whole)
    beyond[np.abs(beyond) < SAME_mm] = 0.0
    crossing = sides[beyond[sides].prod(axis=1) < 0]
    share = np.abs(beyond[crossing]) / np.abs(np.diff(beyond[crossing]))
    near = np.unique(crossing[share < NEAR_EDGE_SHARE])
    reached = edge.reached(whole[near])
    stay = _stay(mesh, near, whole[near], reached, surfaces)
    near = near[stay]
    wanted = mesh.points.copy()
    wanted[near] = space.to(reached[stay])
    points = undo_inverted(mesh.points, wanted, mesh.tets)
    beyond[near[(points[near] == wanted[near]).all(axis=1)]] = 0.0

    crossing = crossing[beyond[crossing].prod(axis=1) < 0]
    a, b = crossing.T
    at = (beyond[a] / (beyond[a] - beyond[b]))[:, None]
    between = space.to(edge.reached(space.back(points[a] + at * (points[b] - points[a]))))
    uncut = Simplices(len(points), mesh.tets, mesh.faces, mesh.facet_surface)
    in_turn = -np.arange(len(crossing))
    cut, _ = halved(uncut, crossing, in_turn, np.ones(len(crossing), bool))
    faces, surface = cut.facets, cut.facet_surface
    beyond = np.append(beyond, np.zeros(len(crossing)))[faces].sum(axis=1)
    mine = np.isin(surface, (edge.first, edge.second))
    surface = np.where(mine & (beyond < 0), edge.first, surface)
    surface = np.where(mine & (beyond > 0), edge.second, surface)
    return MesherMesh(np.vstack([points, between]), cut.tets, faces, surface)


def _stay(
    mesh: MesherMesh,
    nodes: np.ndarray,
    there: np.ndarray,
    then: np.ndarray,
    surfaces: Sequence[Surface],
) -> np.ndarray:
    """Mask (k,) of `nodes` that keep to all their surfaces when they move from `there` to `then` (k, 3)."""
    allowed = SLIP * np.linalg.norm(then - there, axis=1)
    stay = np.ones(len(nodes), bool)
    for k in np.unique(mesh.facet_surface):
        mine = np.isin(nodes, mesh.faces[mesh.facet_surface == k])
        off = [np.linalg.norm(surfaces[k].project(p) - p, axis=1) for p in (there, then)]
        stay &= ~mine | (off[1] <= off[0] + allowed)
    return stay


def _meridional(points: np.ndarray) -> np.ndarray:
    return np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
