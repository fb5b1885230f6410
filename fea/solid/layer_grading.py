"""Bisects edges of a shaft's layers until all are shorter than the grading requires."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.fea.errors import MeshQualityError, TooManyElementsError
from flexspline.fea.solid.bisect import Simplices, halved
from flexspline.fea.solid.layers import RING_STEP
from flexspline.fea.solid.polar import cartesian, middles, polar
from flexspline.fea.solid.seams import Seams, distance_from, seams_of
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.snap import snap_to_surfaces, undo_inverted
from flexspline.geometry.surfaces import Surface

GRADING_ROUNDS = 60
"""Most rounds of halving. 150 random shafts took 5 at most."""
ROUND_RATIO = 2.0
"""A round halves the edges that are longer than required and longer than the longest one over this ratio;
lengths are relative to the required ones. Judgement: the longest edges first."""
WHOLE_STEP = 1.01
"""Times the plan's step about the axis: edges of this step are not halved because of rounding."""


def graded(
    points: np.ndarray, mesh: Simplices, surfaces: Sequence[Surface], grading: Grading, most: float
) -> tuple[np.ndarray, Simplices]:
    """Halve edges until none is longer than the grading asks; new boundary nodes are on its surfaces."""
    for _ in range(GRADING_ROUNDS):
        edges = mesh.edges()
        seams = seams_of(points, mesh.facets, mesh.facet_surface, surfaces)
        lengths = _relative_lengths(points, edges, seams, grading)
        if lengths.max() <= 1:
            return points, mesh
        mesh, cut_edges = halved(
            mesh, edges, lengths, lengths > max(1.0, lengths.max() / ROUND_RATIO)
        )
        if len(mesh.tets) > most:
            raise TooManyElementsError(len(mesh.tets), most)
        points = with_middles_of(points, mesh, cut_edges, surfaces)
    raise MeshQualityError(
        f"{int((lengths > 1).sum())} edges of the layers cannot be made short enough"
    )


def with_middles_of(
    points: np.ndarray, mesh: Simplices, cut_edges: np.ndarray, surfaces: Sequence[Surface]
) -> np.ndarray:
    """Add points between the ends of edges: at half the angle, or on the surfaces of the boundary.

    Straight middles are kept where another place would flatten a tetrahedron; the next round tries again.
    """
    ends = points[cut_edges]
    straight = np.vstack([points, ends.mean(axis=1)])
    wanted = np.vstack([points, cartesian(middles(polar(points)[cut_edges]))])
    limit = float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).max())
    wanted = snap_to_surfaces(wanted, mesh.facets, mesh.facet_surface, surfaces, limit)
    return undo_inverted(straight, wanted, mesh.tets, len(points))


def _relative_lengths(
    points: np.ndarray, edges: np.ndarray, seams: Seams, grading: Grading
) -> np.ndarray:
    """Of edges (e, 2), over those that are wanted.

    About the axis only holes and slots ask for short ones: what is revolved makes fields even there.
    """
    ends = polar(points)[edges]
    middle = middles(ends)
    dr, dz = (ends[:, 1, k] - ends[:, 0, k] for k in (0, 2))
    off_axis = (ends[:, :, 0] > 0).all(axis=1)
    turn = np.where(off_axis, ends[:, 1, 1] - ends[:, 0, 1], 0.0)
    places = cartesian(middle)
    across = np.minimum(
        grading.far,
        grading.near + grading.growth * distance_from(seams.nodes[seams.singular], points, places),
    )
    others = seams.nodes[seams.singular & ~seams.revolved]
    plain = grading.near + grading.growth * distance_from(others, points, places)
    around = np.maximum(across, np.minimum(plain, WHOLE_STEP * RING_STEP * middle[:, 0]))
    return np.sqrt((dr**2 + dz**2) / across**2 + (middle[:, 0] * turn / around) ** 2)
