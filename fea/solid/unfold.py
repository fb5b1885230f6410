"""A larger sector from a smaller one by reflection, up to the whole part.

The lobes and the ellipse reuse the torsion mesh; pictures and files show a part in the round.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from flexspline.fea.solid.polar import cartesian
from flexspline.fea.types import TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

Parity = Literal["symmetric", "antisymmetric"]
"""How a displacement changes under reflection: torsion, uniform or at the lobes, is antisymmetric; the wave
generator's ellipse is symmetric."""
MIRRORED_CELL = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]
"""Ten nodes with corners 1 and 2 exchanged: a reflection turns the element inside out."""
MIRRORED_FACET = [0, 2, 1, 5, 4, 3]
"""The same of six: corners, then the middles of the edges 01, 12, 20."""


def folded(points: np.ndarray, sector_deg: float) -> np.ndarray:
    """Return points (n, 3) reflected back into the sector from 0 to `sector_deg`."""
    step = np.radians(sector_deg)
    phi = np.arctan2(points[:, 1], points[:, 0]) % (2 * step)
    phi = np.minimum(phi, 2 * step - phi)
    r = np.hypot(points[:, 0], points[:, 1])
    return cartesian(np.column_stack([r, phi, points[:, 2]]))


@dataclass(frozen=True)
class Unfolding:
    """A larger sector, and where its nodes come from.

    Its cells are the copies' one after the other, each in the order of the sector's; copy k, counted from
    angle 0, is reflected where k is odd.

    Attributes
    ----------
    node : (n,) the sector's node that each is an image of. copy : (n,) the copy it belongs to.
    copies : how many. sector_deg : angle of one.
    """

    mesh: TetMesh
    node: np.ndarray
    copy: np.ndarray
    copies: int
    sector_deg: float

    def vectors(self, values: np.ndarray, parity: Parity) -> np.ndarray:
        """Return a Cartesian vector field (n, 3) from the sector's; `parity`: how a reflection changes it.

        `values` (copies, n, 3) are the copies' own, each as it is before that is turned and reflected.
        """
        vectors = values[self.node] if values.ndim == 2 else values[self.copy, self.node]
        odd = self.copy % 2 == 1
        vectors[odd] *= [1.0, -1.0, 1.0] if parity == "symmetric" else [-1.0, 1.0, -1.0]
        turn = np.radians((self.copy + odd) * self.sector_deg)
        c, s = np.cos(turn), np.sin(turn)
        x, y, z = vectors.T
        return np.column_stack([c * x - s * y, s * x + c * y, z])


def unfolded(mesh: TetMesh, sector_deg: float) -> TetMesh:
    """Return the sector from 0 to `sector_deg`; see `unfolding`."""
    return unfolding(mesh, sector_deg).mesh


def unfolding(mesh: TetMesh, sector_deg: float) -> Unfolding:
    """Return the sector from 0 to `sector_deg`, a whole multiple of the mesh's, reflected at each plane.

    At 360° it is closed: the last copy's plane is the first one's, and no plane of symmetry is left.

    Raises
    ------
    ValueError : no whole multiple, or 360° by an odd number of copies.
    """
    times = round(sector_deg / mesh.sector_deg)
    if times < 1 or abs(times * mesh.sector_deg - sector_deg) > 1e-9 * sector_deg:  # of rounding
        raise ValueError(f"{sector_deg} is not a multiple of the sector {mesh.sector_deg}")
    closed = sector_deg == 360 and times > 1
    if closed and times % 2:
        raise ValueError(f"copies of the sector {mesh.sector_deg} cannot be closed to 360°")
    n = len(mesh.nodes)
    r = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1])
    angle = np.arctan2(mesh.nodes[:, 1], mesh.nodes[:, 0])
    step = np.radians(mesh.sector_deg)
    # which copy owns a node: those on a shared plane belong to the copy before it
    owner = np.tile(np.arange(n), (times, 1)) + n * np.arange(times)[:, None]
    nodes, cells, facets, patches = [], [], [], []
    shared = (mesh.nodes_on(SYMMETRY_END), mesh.nodes_on(SYMMETRY_START))
    inner = (SYMMETRY_END, SYMMETRY_START)
    for k in range(times):
        odd = k % 2 == 1
        if k:
            plane = shared[(k - 1) % 2]
            owner[k, plane] = owner[k - 1, plane]
        if closed and k == times - 1:
            owner[k, shared[1]] = owner[0, shared[1]]
        phi = (k + 1) * step - angle if odd else k * step + angle
        nodes.append(cartesian(np.column_stack([r, phi, mesh.nodes[:, 2]])))
        cells.append(owner[k][mesh.cells[:, MIRRORED_CELL] if odd else mesh.cells])
        drop = {inner[k % 2]} if k < times - 1 else set()
        drop |= {inner[(k - 1) % 2]} if k else set()
        drop |= {SYMMETRY_START} if closed and k in (0, times - 1) else set()
        keep = ~np.isin(mesh.facet_patch, [i for i, p in enumerate(mesh.patches) if p in drop])
        facets.append(owner[k][(mesh.facets[:, MIRRORED_FACET] if odd else mesh.facets)[keep]])
        patches.append(_renamed(mesh, mesh.facet_patch[keep], last=k == times - 1 and odd))
    every = np.concatenate(cells)
    order = _corners_first(every, times * n)
    number = np.full(times * n, -1)
    number[order] = np.arange(len(order))
    larger = TetMesh(
        np.concatenate(nodes)[order], number[every], number[np.concatenate(facets)],
        np.concatenate(patches), mesh.patches, sector_deg,
    )  # fmt: skip
    return Unfolding(larger, order % n, order // n, times, mesh.sector_deg)


def _renamed(mesh: TetMesh, facet_patch: np.ndarray, last: bool) -> np.ndarray:
    """In a reflected last copy the start plane has become the end plane."""
    if not last or SYMMETRY_START not in mesh.patches:
        return facet_patch
    start, end = mesh.patches.index(SYMMETRY_START), mesh.patches.index(SYMMETRY_END)
    return np.where(facet_patch == start, end, facet_patch)


def _corners_first(cells: np.ndarray, nodes: int) -> np.ndarray:
    """Which of so many nodes the cells use; those that another copy owns are not among them."""
    corner, used = np.zeros(nodes, bool), np.zeros(nodes, bool)
    corner[cells[:, :4]] = used[cells] = True
    return np.concatenate([np.flatnonzero(corner), np.flatnonzero(used & ~corner)])
