"""Local refinement of a meridian mesh by halving longest edges (Rivara 1984; red-green-blue)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh, edge_lengths, edge_middles
from flexspline.fea.edges import SIDES, edge_numbers


def refined(mesh: MeridianMesh, marked: np.ndarray) -> MeridianMesh:
    """Cut the marked triangles (mask (m,)) in four; cut their neighbours so that the mesh stays conforming.

    New nodes of fillets are put on the exact arc.
    """
    return refined_with_parents(mesh, marked)[0]


def refined_while(mesh: MeridianMesh, marked: Callable[[MeridianMesh], np.ndarray]) -> MeridianMesh:
    """The mesh refined until `marked`, a mask (m,) of its triangles, is empty."""
    while (now := marked(mesh)).any():
        mesh = refined(mesh, now)
    return mesh


@dataclass(frozen=True)
class Box:
    """Ranges of r and z [mm] in a meridian, and how long edges there may be [mm]."""

    r: tuple[float, float]
    z: tuple[float, float]
    longest_mm: float

    def meets(self, mesh: MeridianMesh) -> np.ndarray:
        """Return the mask (m,) of the triangles whose ranges of r and z meet the box."""
        corner = mesh.points[mesh.triangles]
        low, high = corner.min(axis=1), corner.max(axis=1)
        ends = np.array([self.r, self.z])
        return np.asarray(((high > ends[:, 0]) & (low < ends[:, 1])).all(axis=1))


def refined_within(mesh: MeridianMesh, boxes: Sequence[Box], share: float = 1.0) -> MeridianMesh:
    """The mesh refined until no triangle that meets a box has an edge longer than `share` of its longest."""

    def too_long(mesh: MeridianMesh) -> np.ndarray:
        longest = mesh.longest_edges()
        return np.logical_or.reduce(
            [(longest > share * box.longest_mm) & box.meets(mesh) for box in boxes]
        )

    return refined_while(mesh, too_long)


def refined_repeatedly(mesh: MeridianMesh, marked: Iterable[np.ndarray]) -> MeridianMesh:
    """Refine the first mask's triangles (m,), then the pieces of the next mask's, and so on."""
    piece_of = np.arange(mesh.elements)
    for mask in marked:
        mesh, parent = refined_with_parents(mesh, mask[piece_of])
        piece_of = piece_of[parent]
    return mesh


def refined_with_parents(mesh: MeridianMesh, marked: np.ndarray) -> tuple[MeridianMesh, np.ndarray]:
    """Refine, and return for each new triangle the triangle of `mesh` that it is a piece of."""
    tri = _longest_first(mesh.points, mesh.triangles)
    n = len(mesh.points)
    keys, of = np.unique(edge_numbers(tri[:, SIDES], n), return_inverse=True)
    of = of.reshape(-1, 3)
    cut = np.zeros(len(keys), bool)
    cut[of[marked]] = True
    while True:
        spread = cut[of].any(axis=1) & ~cut[of[:, 0]]
        if not spread.any():
            break
        cut[of[spread, 0]] = True
    new = np.full(len(keys), -1)
    new[cut] = n + np.arange(cut.sum())
    ends = np.column_stack([keys // n, keys % n])
    middle = mesh.points[ends].mean(axis=1)
    rim = np.searchsorted(keys, edge_numbers(mesh.edges, n))
    middle[rim] = edge_middles(mesh.outline, mesh.points, mesh.edges, mesh.edge_segment)
    edges, segment = _halved(mesh, new[rim])
    children, parent = _children(tri, new[of])
    points = np.concatenate([mesh.points, middle[cut]])
    return MeridianMesh(mesh.outline, points, children, edges, segment), parent


def _longest_first(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles turned so that their longest edge runs from corner 0 to corner 1."""
    longest = edge_lengths(points, triangles).argmax(axis=1)
    return np.take_along_axis(triangles, (longest[:, None] + np.arange(3)) % 3, axis=1)


def _halved(mesh: MeridianMesh, new: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Boundary edges and their segments, those with a new node split in two."""
    cut = new >= 0
    old, mine, at = mesh.edges[cut], mesh.edge_segment[cut], new[cut]
    halves = [np.column_stack([old[:, 0], at]), np.column_stack([at, old[:, 1]])]
    return (
        np.concatenate([mesh.edges[~cut], *halves]),
        np.concatenate([mesh.edge_segment[~cut], mine, mine]),
    )


def _children(tri: np.ndarray, new: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles after the split and their parents; `new` (m, 3) holds each edge's middle node, or -1."""
    has = new >= 0
    a, b, c = tri.T
    m, p, q = new.T
    kinds = {
        (False, False, False): [(a, b, c)],
        (True, False, False): [(c, a, m), (b, c, m)],
        (True, True, False): [(c, a, m), (m, b, p), (m, p, c)],
        (True, False, True): [(b, c, m), (m, c, q), (m, q, a)],
        (True, True, True): [(a, m, q), (m, b, p), (q, p, c), (m, p, q)],
    }
    parts, parents = [], []
    for kind, children in kinds.items():
        mine = np.flatnonzero((has == kind).all(axis=1))
        parts += [np.column_stack(child)[mine] for child in children]
        parents += [mine] * len(children)
    return np.concatenate(parts), np.concatenate(parents)
