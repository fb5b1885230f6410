"""The whole part from its sector: mirrored about the plane of angle 0, then turned about z."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from flexspline.fea.types import TetMesh

Parity = Literal["symmetric", "antisymmetric"]

FACES = np.array([[0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [2, 0, 3, 6, 7, 9], [0, 2, 1, 6, 5, 4]])
"""Outward faces of a quadratic tetrahedron: three corners, then the middles of their edges."""
_MIRRORED_CELL = np.array([1, 0, 2, 3, 4, 6, 5, 8, 7, 9])  # corners 0 and 1 swapped
_MIRRORED_FACE = np.array([0, 2, 1, 3])
_REFLECT = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True)
class WholePart:
    """A part in the round, with nodal values.

    Attributes
    ----------
    nodes : (n, 3) mm.
    cells : (m, 10) as in TetMesh.
    displacement : (n, 3) mm.
    mises : (n,) MPa.
    face_patch : (m, 4) index into `patches` of each cell's faces, -1 inside the material.
    start_deg : (m,) angle at which the cell's copy of the sector begins, in [0, 360).
    patches : patch names.
    sector_deg : angle of one copy.
    """

    nodes: np.ndarray
    cells: np.ndarray
    displacement: np.ndarray
    mises: np.ndarray
    face_patch: np.ndarray
    start_deg: np.ndarray
    patches: tuple[str, ...]
    sector_deg: float


def whole_part(
    mesh: TetMesh, displacement: np.ndarray, mises: np.ndarray, parity: Parity
) -> WholePart:
    """All 360° of a part of which `mesh` is a sector.

    Parameters
    ----------
    displacement, mises : nodal values (n, 3) [mm] and (n,) [MPa].
    parity : what the mirror does to the displacement: "antisymmetric" for torsion (even or at the
        lobes), "symmetric" for the wave generator's ellipse. The von Mises stress is the same.

    Raises
    ------
    ValueError : the sector does not divide the circle into mirrored pairs.
    """
    pairs = _mirrored_pairs(mesh.sector_deg)
    patch = face_patches(mesh)
    if pairs == 0:
        start = np.zeros(len(mesh.cells))
        return WholePart(
            mesh.nodes, mesh.cells, displacement, mises, patch, start, mesh.patches, 360.0
        )
    sign = 1.0 if parity == "symmetric" else -1.0
    halves = (
        (mesh.nodes, mesh.cells, displacement, patch, 0.0),
        (
            mesh.nodes * _REFLECT,
            mesh.cells[:, _MIRRORED_CELL],
            sign * displacement * _REFLECT,
            patch[:, _MIRRORED_FACE],
            -mesh.sector_deg,
        ),
    )
    nodes: list[np.ndarray] = []
    moved: list[np.ndarray] = []
    cells, patches, starts = [], [], []
    for k in range(pairs):
        turn = 2 * mesh.sector_deg * k
        rotation = _about_z(turn)
        for points, tets, shift, tags, begin in halves:
            cells.append(tets + len(mesh.nodes) * len(nodes))
            nodes.append(points @ rotation.T)
            moved.append(shift @ rotation.T)
            patches.append(tags)
            starts.append(np.full(len(tets), (begin + turn) % 360.0))
    merged, index = _joined(np.concatenate(nodes), _on_planes(mesh), len(nodes))
    return WholePart(
        nodes=merged,
        cells=index[np.concatenate(cells)],
        displacement=_first(np.concatenate(moved), index),
        mises=_first(np.tile(mises, 2 * pairs), index),
        face_patch=np.concatenate(patches),
        start_deg=np.concatenate(starts),
        patches=mesh.patches,
        sector_deg=mesh.sector_deg,
    )


def face_patches(mesh: TetMesh) -> np.ndarray:
    """(m, 4) patch index of every cell's faces, -1 where the face is inside the material."""
    size = len(mesh.nodes)
    faces = np.sort(mesh.cells[:, FACES[:, :3]].reshape(-1, 3), axis=1).astype(np.int64)
    wanted = np.sort(mesh.facets[:, :3], axis=1).astype(np.int64)
    keys = (faces[:, 0] * size + faces[:, 1]) * size + faces[:, 2]
    known = (wanted[:, 0] * size + wanted[:, 1]) * size + wanted[:, 2]
    order = np.argsort(known)
    at = np.minimum(np.searchsorted(known[order], keys), len(known) - 1)
    hit = known[order][at] == keys
    return np.where(hit, mesh.facet_patch[order][at], -1).reshape(-1, 4)


def _mirrored_pairs(sector_deg: float) -> int:
    if sector_deg >= 360:
        return 0
    pairs = 180 / sector_deg
    if abs(pairs - round(pairs)) > 1e-6:
        raise ValueError(
            f"a sector of {sector_deg:g}° does not fit a whole number of times in 180°"
        )
    return round(pairs)


def _about_z(degrees: float) -> np.ndarray:
    a = np.radians(degrees)
    return np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])


def _on_planes(mesh: TetMesh) -> np.ndarray:
    """Nodes of the sector's two planes: only these meet nodes of another copy."""
    x, y = mesh.nodes[:, 0], mesh.nodes[:, 1]
    a = np.radians(mesh.sector_deg)
    near = 1e-6 * np.ptp(mesh.nodes, axis=0).max()
    return np.flatnonzero((np.abs(y) < near) | (np.abs(x * np.sin(a) - y * np.cos(a)) < near))


def _joined(nodes: np.ndarray, seam: np.ndarray, copies: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes with those of touching copies made one, and the new index of each old node."""
    n = len(nodes)
    seams = (seam[None, :] + (n // copies) * np.arange(copies)[:, None]).ravel()
    near = 1e-6 * np.ptp(nodes, axis=0).max()
    pairs = seams[cKDTree(nodes[seams]).query_pairs(near, output_type="ndarray")]
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    _, first, index = np.unique(label, return_index=True, return_inverse=True)
    return nodes[first], index.ravel()


def _first(values: np.ndarray, index: np.ndarray) -> np.ndarray:
    _, first = np.unique(index, return_index=True)
    return values[first]
