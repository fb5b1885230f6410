"""The whole part from its sector, for pictures and files: patches of faces, angles of copies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.solid.unfold import Parity, unfolding
from flexspline.fea.types import TetMesh

FACES = np.array([[0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [2, 0, 3, 6, 7, 9], [0, 2, 1, 6, 5, 4]])
"""Outward faces of a quadratic tetrahedron: three corners, then the middles of their edges."""
MIRRORED_FACES = [2, 1, 0, 3]
"""Which of FACES each becomes where corners 1 and 2 are exchanged, as by `MIRRORED_CELL`."""


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
    """Return all 360° of a part of which `mesh` is a sector.

    Parameters
    ----------
    displacement, mises : nodal values (n, 3) [mm] and (n,) [MPa].
    parity : of the displacement; the von Mises stress is the same in each copy.

    Raises
    ------
    ValueError : the sector does not divide the circle into mirrored pairs.
    """
    unfolded = unfolding(mesh, 360.0)
    patch = face_patches(mesh)
    mirrored = patch[:, MIRRORED_FACES]
    return WholePart(
        nodes=unfolded.mesh.nodes,
        cells=unfolded.mesh.cells,
        displacement=unfolded.vectors(displacement, parity),
        mises=mises[unfolded.node],
        face_patch=np.concatenate([mirrored if k % 2 else patch for k in range(unfolded.copies)]),
        start_deg=np.repeat(np.arange(unfolded.copies) * mesh.sector_deg, mesh.elements),
        patches=mesh.patches,
        sector_deg=mesh.sector_deg,
    )


def unloaded_part(mesh: TetMesh) -> WholePart:
    """Return all 360° of a part that nothing moves."""
    return whole_part(mesh, np.zeros_like(mesh.nodes), np.zeros(len(mesh.nodes)), "symmetric")


def face_patches(mesh: TetMesh) -> np.ndarray:
    """Return the patch (m, 4) of every cell's faces, -1 where the face is inside the material."""
    size = len(mesh.nodes)
    faces = np.sort(mesh.cells[:, FACES[:, :3]].reshape(-1, 3), axis=1).astype(np.int64)
    wanted = np.sort(mesh.facets[:, :3], axis=1).astype(np.int64)
    keys = (faces[:, 0] * size + faces[:, 1]) * size + faces[:, 2]
    known = (wanted[:, 0] * size + wanted[:, 1]) * size + wanted[:, 2]
    order = np.argsort(known)
    at = np.minimum(np.searchsorted(known[order], keys), len(known) - 1)
    hit = known[order][at] == keys
    return np.where(hit, mesh.facet_patch[order][at], -1).reshape(-1, 4)
