"""The coarsest layered mesh of a shaft: prisms cut into tetrahedra, each facet with its surface."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from flexspline.fea.errors import TooManyElementsError
from flexspline.fea.solid.bisect import Simplices
from flexspline.fea.solid.facet_surfaces import surfaces_of
from flexspline.fea.solid.layers import Layers
from flexspline.fea.solid.polar import cartesian
from flexspline.fea.solid.prisms import cut
from flexspline.fea.solid.quadratic import boundary_faces
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.snap import undo_inverted
from flexspline.geometry.outline import SAME_mm
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START, Surface

TETS_OF_PRISM = 3
"""Tetrahedra of a prism. Wedges on the axis have a third less."""
SUNK = 0.5
"""How far the sharp corner under a fillet moves into the material, as a share of the fillet's radius.
Judgement: no mesh edge may be a tangent of the arc."""
SUNK_OF_NEXT = 0.3
"""The corner moves at most by this share of the distance to the next node. Two nodes that move towards each
other then keep 0.4 of their distance."""


def coarsest(
    layers: Layers, surfaces: Sequence[Surface], grading: Grading, most: float = inf
) -> tuple[np.ndarray, Simplices]:
    """Return corners (n, 3) [mm] and tetrahedra of the layers' prisms, as few as the lines allow.

    Raises
    ------
    MeshingError : as `Layers.plan`.
    TooManyElementsError : more than `most` tetrahedra.
    """
    polar, prisms = layers.prisms(grading.near, grading.far)
    if TETS_OF_PRISM * len(prisms) > most:
        raise TooManyElementsError(TETS_OF_PRISM * len(prisms), most)
    polar, prisms = _corners_first(layers, polar, prisms)
    tets = cut(prisms)
    used, compact = np.unique(tets, return_inverse=True)
    polar, tets = polar[used], compact.reshape(tets.shape)
    points = cartesian(polar)
    faces = boundary_faces(tets)
    on = surfaces_of(points, faces, surfaces)
    points = _sunk(layers, polar, points, tets, faces, on, surfaces)
    return points, Simplices(len(points), tets, faces, on)


def _corners_first(
    layers: Layers, polar: np.ndarray, prisms: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Corners under fillets have the least numbers, so that prisms are cut from there, not along the arc."""
    corner = np.zeros(len(polar), bool)
    for f in layers.fillets:
        corner |= (np.abs(polar[:, 0] - f.r) < SAME_mm) & (np.abs(polar[:, 2] - f.z) < SAME_mm)
    order = np.argsort(~corner, kind="stable")
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    return polar[order], number[prisms]


def _sunk(
    layers: Layers,
    polar: np.ndarray,
    points: np.ndarray,
    tets: np.ndarray,
    faces: np.ndarray,
    on: np.ndarray,
    surfaces: Sequence[Surface],
) -> np.ndarray:
    """Nodes in the sharp corners under fillets moved into the material, inwards and away from the arc."""
    mirrors = [i for i, s in enumerate(surfaces) if s.patch in (SYMMETRY_START, SYMMETRY_END)]
    inside = np.ones(len(polar), bool)
    inside[faces[~np.isin(on, mirrors)]] = False
    r, _, z = polar.T
    a, b = Simplices(len(polar), tets, faces, on).edges().T
    length = np.linalg.norm(points[a] - points[b], axis=1)
    moved = polar.copy()
    for f in layers.fillets:
        corner = inside & (r > f.r - SAME_mm) & (r < f.far - SAME_mm) & (np.abs(z - f.z) < SAME_mm)
        beyond = (r < f.r - SAME_mm) | ((z - f.z) * f.up < -SAME_mm)
        room = np.full(len(polar), np.inf)
        for one, other in ((a, b), (b, a)):
            mine = beyond[other]
            np.minimum.at(room, one[mine], length[mine])
        step = np.minimum(SUNK * f.radius, SUNK_OF_NEXT * room[corner])
        moved[corner, 0] -= np.where(r[corner] < f.r + SAME_mm, step, 0.0)
        moved[corner, 2] -= f.up * step
    return undo_inverted(points, cartesian(moved), tets)
