"""Projects boundary nodes onto the exact CAD surfaces; the mesher places them within a tolerance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.geometry.surfaces import Plane, Surface, sector_planes

PROJECTION_ROUNDS = 40
"""Alternating projections: surfaces that meet at 90° agree after two, at 45° each round halves the
distance, so 40 reach rounding."""
AGREEMENT_mm = 1e-8
"""[mm] Change of a round below which the surfaces agree: a hundredth of what counts as on a surface."""
FLATTENED_TETRAHEDRON = 0.1
"""Share of its volume that a tetrahedron must keep. If it keeps less, it is a sliver, whose curved copy can
turn inside out."""
MOST_PASSES = 10
"""Rounds at most. Each undoes the moves of nodes whose tetrahedra the round before flattened. A mesh with
flat ones left is refused."""
SETTLED_mm = 1e-6
"""[mm] Nearer than this to a surface is on it: a nanometre, where the smallest length of a design is 1 µm."""


def snap_to_surfaces(
    points: np.ndarray,
    faces: np.ndarray,
    facet_surface: np.ndarray,
    surfaces: Sequence[Surface],
    limit: float,
) -> np.ndarray:
    """Move nodes of `faces` onto their surfaces; returns a copy of `points` (n, 3) mm.

    A node where several surfaces meet goes to their common point. If that is farther than `limit`
    [mm] (a smooth joint, which the mesher need not follow), it goes to the nearest surface alone,
    but never leaves a plane of symmetry.
    """
    out = points.copy()
    for owners, nodes in _nodes_by_surfaces(faces, facet_surface).items():
        group = [surfaces[i] for i in owners]
        out[nodes] = _snapped(points[nodes], group, limit, np.ones(len(nodes), bool))
    return out


def middles_on_surfaces(
    corners: np.ndarray,
    middles: np.ndarray,
    edges: np.ndarray,
    facets: np.ndarray,
    facet_surface: np.ndarray,
    surfaces: Sequence[Surface],
) -> np.ndarray:
    """Return nodes (n, 3) mm: `corners`, then `middles` of `edges`, those of `facets` on their surfaces.

    A middle moves by the longest edge at most.
    """
    longest = float(np.linalg.norm(corners[edges[:, 0]] - corners[edges[:, 1]], axis=1).max())
    nodes = np.vstack([corners, middles])
    nodes = snap_to_surfaces(nodes, facets, facet_surface, surfaces, longest)
    nodes[: len(corners)] = corners
    return nodes


def snap_middles(
    nodes: np.ndarray,
    edges: np.ndarray,
    facets: np.ndarray,
    facet_surface: np.ndarray,
    surfaces: Sequence[Surface],
    limit: float,
) -> np.ndarray:
    """Move the middle nodes, the last of `nodes` (n, 3) mm, as `snap_to_surfaces`; returns a copy.

    Where several surfaces meet, a middle goes to their common point only if both ends of its edge (e, 2) lie
    on all of them. An edge that crosses a smooth joint has an end beside it. Its middle, moved to the joint
    by 0.1 mm, bent the elements so far that they were made straight, and K came out 0.04 % too low.
    """
    corners = len(nodes) - len(edges)
    out = nodes.copy()
    for owners, at in _nodes_by_surfaces(facets[:, 3:], facet_surface).items():
        group = [surfaces[i] for i in owners]
        ends = nodes[edges[at - corners]].reshape(-1, 3)
        on_all = _off(ends, group).reshape(-1, 2).max(axis=1) < SETTLED_mm
        out[at] = _snapped(nodes[at], group, limit, on_all)
    return out


def _snapped(
    points: np.ndarray, group: Sequence[Surface], limit: float, to_common: np.ndarray
) -> np.ndarray:
    """Points (k, 3) on the surfaces of a group: at their common point where allowed, or on the nearest."""
    moved, settled = common_point(points, group)
    fine = settled & (np.linalg.norm(moved - points, axis=1) <= limit)
    if len(group) == 1:
        return np.where(fine[:, None], moved, points)
    fine &= to_common
    return np.where(fine[:, None], moved, _nearest_alone(points, group, limit))


def into_sector_planes(
    points: np.ndarray,
    faces: np.ndarray,
    facet_surface: np.ndarray,
    surfaces: Sequence[Surface],
    sector_deg: float,
) -> np.ndarray:
    """Put the nodes of the symmetry planes into them, whatever else may be undone later.

    Nodes of both planes go onto the axis: put into one plane and then the other they leave the first.
    """
    out = points.copy()
    in_planes = np.zeros(len(points), int)
    for plane in sector_planes(sector_deg):
        mine = [i for i, s in enumerate(surfaces) if s.patch == plane.patch]
        nodes = np.unique(faces[np.isin(facet_surface, mine)])
        out[nodes] = plane.project(out[nodes])
        in_planes[nodes] += 1
    out[in_planes == 2, :2] = 0.0
    return out


def _nodes_by_surfaces(
    faces: np.ndarray, facet_surface: np.ndarray
) -> dict[tuple[int, ...], np.ndarray]:
    """Nodes of `faces` by the surfaces that meet at them."""
    touches = np.zeros((int(faces.max()) + 1, int(facet_surface.max()) + 1), bool)
    touches[faces.ravel(), np.repeat(facet_surface, faces.shape[1])] = True
    nodes = np.flatnonzero(touches.any(axis=1))
    packed = np.packbits(touches[nodes], axis=1)
    _, first, group = np.unique(packed, axis=0, return_index=True, return_inverse=True)
    owners = (tuple(np.flatnonzero(touches[nodes[k]]).tolist()) for k in first)
    return {those: nodes[group.ravel() == k] for k, those in enumerate(owners)}


def common_point(points: np.ndarray, group: Sequence[Surface]) -> tuple[np.ndarray, np.ndarray]:
    """Project points onto a group of surfaces in turn; return whether each settled on all of them."""
    moved = points
    for _ in range(PROJECTION_ROUNDS if len(group) > 1 else 1):
        before = moved
        for surface in group:
            moved = surface.project(moved)
        if np.abs(moved - before).max() < AGREEMENT_mm:
            break
    return moved, _off(moved, group) < SETTLED_mm


def _off(points: np.ndarray, group: Sequence[Surface]) -> np.ndarray:
    """How far points are from the farthest surface of a group, mm."""
    return np.max([np.abs(s.project(points) - points).max(axis=1) for s in group], axis=0)


def _nearest_alone(points: np.ndarray, group: Sequence[Surface], limit: float) -> np.ndarray:
    planes = [s for s in group if isinstance(s, Plane) and "symmetry" in s.patch]
    others = [s for s in group if s not in planes]
    if not others:
        return points
    targets = [common_point(points, [s, *planes])[0] for s in others]
    away = np.array([np.linalg.norm(t - points, axis=1) for t in targets])
    best = away.argmin(axis=0)
    chosen = np.array(targets)[best, np.arange(len(points))]
    return np.where((away.min(axis=0) <= limit)[:, None], chosen, points)


def undo_inverted(
    raw: np.ndarray, snapped: np.ndarray, tets: np.ndarray, passes: int = MOST_PASSES
) -> np.ndarray:
    """Take back the moves of nodes whose tetrahedra they flattened (below `FLATTENED_TETRAHEDRON`)."""
    before = signed_volumes(raw, tets)
    out = snapped.copy()
    for _ in range(passes):
        bad = signed_volumes(out, tets) < FLATTENED_TETRAHEDRON * before
        if not bad.any():
            return out
        nodes = np.unique(tets[bad])
        out[nodes] = raw[nodes]
    raise MeshQualityError("boundary nodes cannot be put onto the CAD surface without inversion")
