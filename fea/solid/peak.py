"""The stress figure: the largest von Mises stress away from edges where it is singular."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from flexspline.fea.errors import SolveError
from flexspline.fea.quadratic_triangle import lattice_values
from flexspline.fea.solid.stress import nodal_stress, von_mises
from flexspline.fea.solid.unfold import folded
from flexspline.fea.stress_rule import judged
from flexspline.fea.types import Elastic, SolidField, StressPeak, TetMesh

LATTICE = 6
"""Steps along the sides of every boundary facet of the lattice on which stresses are evaluated. The peak then
does not depend on where nodes happen to lie. Judgement."""


@dataclass(frozen=True)
class SharpEdges:
    """Points (k, 3) mm along the sharp edges and patch edges of a sector, and how far they reach.

    Stresses nearer to them than `exclusion_mm` are not counted. A larger sector is folded onto this.
    """

    points: np.ndarray
    sector_deg: float
    exclusion_mm: float


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
    peak = _peak(mesh, stress, edges)
    return SolidField(mesh, load_case, displacement, von_mises(stress), peak)


def _peak(mesh: TetMesh, stress: np.ndarray, edges: SharpEdges) -> StressPeak:
    from scipy.spatial import cKDTree

    values = lattice_values(LATTICE).T.copy()  # (q, 6)
    outer = mesh.facets[["symmetry" not in mesh.patches[p] for p in mesh.facet_patch]]
    surface = np.einsum("qi,kix->kqx", values, mesh.nodes[outer]).reshape(-1, 3)
    on_surface = np.einsum("qi,kiab->kqab", values, stress[outer]).reshape(-1, 3, 3)
    points = np.vstack([mesh.nodes, surface])
    mises = np.concatenate([von_mises(stress), von_mises(on_surface)])
    away, _ = cKDTree(edges.points).query(folded(points, edges.sector_deg))
    counted = np.flatnonzero(away >= edges.exclusion_mm)
    if not len(counted):
        raise SolveError(f"no point of the part is {edges.exclusion_mm:g} mm away from its edges")
    top = counted[mises[counted].argmax()]
    x, y, z = (float(v) for v in points[top])

    from_peak = np.linalg.norm(points - points[top], axis=1)

    def largest(distance_mm: float, within_mm: float = inf) -> float | None:
        stresses = mises[(away >= distance_mm) & (from_peak <= within_mm)]
        return float(stresses.max()) if len(stresses) else None

    return judged(float(mises[top]), (x, y, z), edges.exclusion_mm, largest)
