"""A larger sector from a smaller one by reflection: the lobes and the ellipse reuse the torsion mesh."""

from __future__ import annotations

import numpy as np

from flexspline.fea.types import TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

MIRRORED_CELL = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]
"""Ten nodes with corners 1 and 2 exchanged: a reflection turns the element inside out."""
MIRRORED_FACET = [0, 2, 1, 5, 4, 3]


def folded(points: np.ndarray, sector_deg: float) -> np.ndarray:
    """Points (n, 3) reflected back into the sector from 0 to `sector_deg`."""
    step = np.radians(sector_deg)
    phi = np.arctan2(points[:, 1], points[:, 0]) % (2 * step)
    phi = np.minimum(phi, 2 * step - phi)
    r = np.hypot(points[:, 0], points[:, 1])
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), points[:, 2]])


def unfolded(mesh: TetMesh, sector_deg: float) -> TetMesh:
    """The sector from 0 to `sector_deg`, a whole multiple of the mesh's, reflected at each plane.

    At 360° it is closed: the last copy's plane is the first one's, and no plane of symmetry is left.
    That takes an even number of copies of a sector whose two planes have their own names.
    """
    times = round(sector_deg / mesh.sector_deg)
    if times < 1 or abs(times * mesh.sector_deg - sector_deg) > 1e-9 * sector_deg:
        raise ValueError(f"{sector_deg} is no multiple of the sector {mesh.sector_deg}")
    closed = sector_deg == 360 and times > 1
    if closed and (times % 2 or times == 2):
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
        nodes.append(np.column_stack([r * np.cos(phi), r * np.sin(phi), mesh.nodes[:, 2]]))
        cells.append(owner[k][mesh.cells[:, MIRRORED_CELL] if odd else mesh.cells])
        names = [mesh.patches[i] for i in mesh.facet_patch]
        drop = {inner[k % 2]} if k < times - 1 else set()
        drop |= {inner[(k - 1) % 2]} if k else set()
        drop |= {SYMMETRY_START} if closed and k in (0, times - 1) else set()
        keep = np.array([name not in drop for name in names])
        facets.append(owner[k][(mesh.facets[:, MIRRORED_FACET] if odd else mesh.facets)[keep]])
        patches.append(_renamed(mesh, mesh.facet_patch[keep], last=k == times - 1 and odd))
    return _compact(
        np.concatenate(nodes), np.concatenate(cells), np.concatenate(facets),
        np.concatenate(patches), mesh.patches, sector_deg,
    )  # fmt: skip


def _renamed(mesh: TetMesh, facet_patch: np.ndarray, last: bool) -> np.ndarray:
    """In a reflected last copy the start plane has become the end plane."""
    if not last or SYMMETRY_START not in mesh.patches:
        return facet_patch
    start, end = mesh.patches.index(SYMMETRY_START), mesh.patches.index(SYMMETRY_END)
    return np.where(facet_patch == start, end, facet_patch)


def _compact(
    nodes: np.ndarray, cells: np.ndarray, facets: np.ndarray, facet_patch: np.ndarray,
    patches: tuple[str, ...], sector_deg: float,
) -> TetMesh:  # fmt: skip
    """Drop the nodes that another copy owns; corners first."""
    corners = np.unique(cells[:, :4])
    order = np.concatenate([corners, np.setdiff1d(np.unique(cells), corners)])
    number = np.full(len(nodes), -1)
    number[order] = np.arange(len(order))
    return TetMesh(nodes[order], number[cells], number[facets], facet_patch, patches, sector_deg)
