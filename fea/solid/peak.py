"""The stress figure: the largest von Mises stress away from edges where it is singular."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from flexspline.fea.errors import SolveError
from flexspline.fea.quadratic_triangle import lattice_values
from flexspline.fea.solid.stress import elements_beside, nodal_stress, von_mises
from flexspline.fea.solid.unfold import folded
from flexspline.fea.stress_rule import judged
from flexspline.fea.types import Elastic, SolidField, StressPeak, TetMesh

LATTICE = 6
"""Steps along the sides of every boundary facet of the lattice on which stresses are evaluated. The peak then
does not depend on where nodes happen to lie. Judgement."""

AT_EDGE = 0.2
"""Of the distance left out: a node so near to the points along an edge, an eighth of that distance apart, is
on it. One element is then all that there is from the edge to the peak."""


@dataclass(frozen=True)
class SharpEdges:
    """Points (k, 3) mm along the sharp edges and patch edges of a sector, and how far they reach.

    Stresses nearer to them than `exclusion_mm` are not counted. A larger sector is folded onto this.
    """

    points: np.ndarray
    sector_deg: float
    exclusion_mm: float

    def away(self, points: np.ndarray) -> np.ndarray:
        """Return the distance (k,) [mm] of points (k, 3) [mm] from the nearest edge."""
        from scipy.spatial import cKDTree

        return cKDTree(self.points).query(folded(points, self.sector_deg))[0]


@dataclass(frozen=True)
class Stresses:
    """Stresses (k, 3, 3) [MPa] at points (k, 3) [mm]."""

    points: np.ndarray
    values: np.ndarray


def stress_field(
    mesh: TetMesh,
    displacement: np.ndarray,
    material: Elastic,
    load_case: str,
    edges: SharpEdges,
) -> SolidField:
    """Return the von Mises stress of a displacement (n, 3) Cartesian mm, with the peak that counts.

    Raises
    ------
    SolveError : no point is far enough from every edge.
    """
    stress = nodal_stress(mesh, displacement, material)
    facets = outer_facets(mesh)
    on_surface = Stresses(on_lattice(mesh.nodes, facets), on_lattice(stress, facets))
    peak = largest_of((Stresses(mesh.nodes, stress), on_surface), edges, mesh)
    return SolidField(mesh, load_case, displacement, von_mises(stress), peak)


def outer_facets(mesh: TetMesh) -> np.ndarray:
    """Return the facets (k, 6) that are no symmetry plane."""
    return mesh.facets[["symmetry" not in mesh.patches[p] for p in mesh.facet_patch]]


def on_lattice(nodal: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Return nodal values (n, ...) at the lattice points of facets (k, 6), facet by facet."""
    values = lattice_values(LATTICE).T.copy()  # (q, 6)
    return np.einsum("qi,ki...->kq...", values, nodal[facets]).reshape(-1, *nodal.shape[1:])


def largest_of(
    stresses: Sequence[Stresses], edges: SharpEdges, mesh: TetMesh | None = None
) -> StressPeak:
    """Return the largest von Mises stress of those that count.

    `mesh`: all of the stress is interpolated in its elements. One that reaches from the edge to the peak
    carries the edge's stress there.

    Raises
    ------
    SolveError : no point is far enough from every edge.
    """
    points = np.concatenate([s.points for s in stresses])
    mises = np.concatenate([von_mises(s.values) for s in stresses])
    # a point at the distance but for rounding is at the distance
    away = edges.away(points) * (1 + 1e-9)
    counted = np.flatnonzero(away >= edges.exclusion_mm)
    if not len(counted):
        raise SolveError(f"no point of the part is {edges.exclusion_mm:g} mm away from its edges")
    top = counted[mises[counted].argmax()]
    x, y, z = (float(v) for v in points[top])

    from_peak = np.linalg.norm(points - points[top], axis=1)

    def largest(distance_mm: float, within_mm: float = inf) -> float | None:
        stresses = mises[(away >= distance_mm) & (from_peak <= within_mm)]
        return float(stresses.max()) if len(stresses) else None

    blind = mesh is not None and _reaches(mesh, points[top], edges)
    return judged(float(mises[top]), (x, y, z), edges.exclusion_mm, largest, blind)


def _reaches(mesh: TetMesh, place: np.ndarray, edges: SharpEdges) -> bool:
    """Whether an element at the node nearest to a place (3,) [mm] goes on to a sharp edge."""
    beside = np.unique(mesh.cells[elements_beside(mesh, place)])
    return bool(edges.away(mesh.nodes[beside]).min() < AT_EDGE * edges.exclusion_mm)
