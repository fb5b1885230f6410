"""Mesh size of a swept part's meridian and hole plan: by grading, and near chosen places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined_while
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.errors import TooManyElementsError
from flexspline.fea.solid.column import CORE_RIM, LARGEST_ARC, HoledColumn
from flexspline.fea.solid.sizing import Grading
from flexspline.geometry.outline import Meridian

PLAN_EDGE = 1.2
"""Largest edge in the plan beside a hole, in hole radii. At least five edges then go around the hole."""
MOST_ELEMENTS = 500_000
"""Most elements of a mesh: 2 million unknowns and 16 GB. Only parts of extreme proportions need more; they
are refused before the mesh is built."""


@dataclass(frozen=True)
class Finer:
    """Requirements on a mesh beyond the grading, by a load that varies about the axis.

    Attributes
    ----------
    step_rad : the largest step about the axis.
    places : points (r, z) of the meridian [mm].
    within_mm, edge_mm : edges of the meridian are at most so long, so near to one of the places.
    adapted : what else refines the meridian, or its part beside the column of the holes.
    even : the steps are as good as equal, and the holes' plan is as fine as the grading asks away from the
        interface; else the plan is as fine as the step throughout.
    """

    step_rad: float
    places: tuple[tuple[float, float], ...] = ()
    within_mm: float = 0.0
    edge_mm: float = np.inf
    adapted: Callable[[MeridianMesh], MeridianMesh] = lambda mesh: mesh
    even: bool = False


def graded_mesh(
    mesh: MeridianMesh, critical: np.ndarray, grading: Grading, finer: Finer | None
) -> MeridianMesh:
    """Halve triangles until no edge is longer than the grading and `finer` ask for."""

    def nearest(places: np.ndarray, points: np.ndarray) -> np.ndarray:
        return np.linalg.norm(points[:, None] - places, axis=2).min(axis=1)

    def wanted(points: np.ndarray) -> np.ndarray:
        edge = np.minimum(grading.far, grading.near + grading.growth * nearest(critical, points))
        if finer is None or not finer.places:
            return edge
        beyond = np.maximum(0.0, nearest(np.array(finer.places), points) - finer.within_mm)
        return np.minimum(edge, finer.edge_mm + grading.growth * beyond)

    sized = _sized(mesh, wanted)
    return sized if finer is None else finer.adapted(sized)


def plan_mesh(
    column: HoledColumn, sector: float, far: float, arc_rad: float = LARGEST_ARC
) -> MeridianMesh:
    """Return the column's plan, finer beside the hole; a core on the axis is a fan."""
    centre, hole = np.array([column.bolt_circle, 0.0]), column.hole_radius

    def wanted(points: np.ndarray) -> np.ndarray:
        away = np.linalg.norm(points - centre, axis=1) - hole
        return np.minimum(far, np.maximum(PLAN_EDGE * hole, away))

    plan = _sized(triangulate(column.plan(sector, arc_rad)), wanted)
    rim = plan.edges[np.isin(plan.edge_segment, plan.segments_of(CORE_RIM))]
    if not len(rim):
        return plan
    axis = len(plan.points)
    fan = np.column_stack([rim[:, ::-1], np.full(len(rim), axis)])
    points, triangles = np.vstack([plan.points, (0.0, 0.0)]), np.vstack([plan.triangles, fan])
    return replace(plan, points=points, triangles=triangles)


def _sized(mesh: MeridianMesh, wanted: Callable[[np.ndarray], np.ndarray]) -> MeridianMesh:
    """No edge longer than `wanted` at its triangle's centre."""

    def too_long(mesh: MeridianMesh) -> np.ndarray:
        centres = mesh.points[mesh.triangles].mean(axis=1)
        long = mesh.longest_edges() > wanted(centres)
        if long.any():
            refuse_beyond_memory(mesh.elements)  # before it has them all
        return np.asarray(long)

    return refined_while(mesh, too_long)


def critical_points(outline: Meridian) -> np.ndarray:
    """Return the points (k, 2) of the meridian where the torsional stress is singular.

    Patch edges and inside corners, as `TaggedSurface.critical_edges`.
    """
    return np.array([*outline.patch_edges, *outline.inside_corners])


def refuse_beyond_memory(prisms: int) -> None:
    """Raise TooManyElementsError for too many prisms of the meridian; the holes' column is not counted."""
    elements = 3 * prisms
    if elements > MOST_ELEMENTS:
        raise TooManyElementsError(elements, MOST_ELEMENTS)
