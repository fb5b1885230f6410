"""A meridian mesh that is moved with its outline."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import spsolve

from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.geometry.outline import Meridian


def followed(mesh: MeridianMesh, outline: Meridian) -> MeridianMesh:
    """Return the mesh on another outline with as many segments, a small step away.

    Boundary vertices keep their place along their segment; inner ones follow their neighbours.
    """
    shift = np.zeros_like(mesh.points)
    for index, (old, new) in enumerate(zip(mesh.outline.segments, outline.segments, strict=True)):
        nodes = np.unique(mesh.edges[mesh.edge_segment == index])
        at = _along(old.at(np.linspace(0, 1, 2)), old.centre, old.sweep, mesh.points[nodes])
        shift[nodes] = new.at(at) - old.at(at)
    rim = np.unique(mesh.edges)
    inner = np.setdiff1d(np.arange(len(shift)), rim)
    if len(inner):
        sides = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        both = np.concatenate([sides, sides[:, ::-1]])
        links = coo_matrix((np.ones(len(both)), both.T), shape=2 * (len(shift),)).tocsr()
        laplace = (diags(np.asarray(links.sum(axis=1)).ravel()) - links).tocsr()
        right = -laplace[inner][:, rim] @ shift[rim]
        shift[inner] = spsolve(laplace[inner][:, inner].tocsc(), right).reshape(-1, 2)
    return MeridianMesh(outline, mesh.points + shift, mesh.triangles, mesh.edges, mesh.edge_segment)


def _along(
    ends: np.ndarray, centre: tuple[float, float] | None, sweep: float, points: np.ndarray
) -> np.ndarray:
    """Parameter in [0, 1] of points on a line or an arc."""
    if centre is None:
        d = ends[1] - ends[0]
        return (points - ends[0]) @ d / (d @ d)
    begin, from_centre = ends[0] - centre, points - np.array(centre)
    angle = np.arctan2(from_centre[:, 1], from_centre[:, 0]) - np.arctan2(begin[1], begin[0])
    return ((angle + np.pi) % (2 * np.pi) - np.pi) / sweep
