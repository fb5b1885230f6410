"""The contract's stress figure: the largest von Mises stress away from edges where it is singular."""

from __future__ import annotations

import numpy as np

from fea.solid.cases import Solved
from fea.solid.errors import SolveError
from fea.solid.stress import nodal_stress, von_mises
from fea.types import Elastic, SolidField, StressPeak, TetMesh

LATTICE = 6
"""Stresses are looked at on a lattice of this many steps along the sides of every boundary facet, so
that the figure does not depend on where nodes happen to lie."""


def stress_field(
    solved: Solved,
    material: Elastic,
    load_case: str,
    scale: float,
    sharp_edges: np.ndarray,
    clearance_mm: float,
) -> SolidField:
    """Displacement and von Mises stress of a solved case times `scale`, with the counted peak.

    Points nearer than `clearance_mm` to `sharp_edges` (k, 3) are not counted.

    Raises
    ------
    SolveError : no point is that far from every edge.
    """
    u = solved.displacement * scale
    stress = nodal_stress(solved.mesh, u, material)
    peak = _peak(solved.mesh, stress, sharp_edges, clearance_mm)
    return SolidField(solved.mesh, load_case, u, von_mises(stress), peak)


def _peak(
    mesh: TetMesh, stress: np.ndarray, sharp_edges: np.ndarray, clearance_mm: float
) -> StressPeak:
    from scipy.spatial import cKDTree

    values = _facet_lattice()
    outer = mesh.facets[["symmetry" not in mesh.patches[p] for p in mesh.facet_patch]]
    surface = np.einsum("qi,kix->kqx", values, mesh.nodes[outer]).reshape(-1, 3)
    on_surface = np.einsum("qi,kiab->kqab", values, stress[outer]).reshape(-1, 3, 3)
    points = np.vstack([mesh.nodes, surface])
    mises = np.concatenate([von_mises(stress), von_mises(on_surface)])
    away, _ = cKDTree(sharp_edges).query(points)
    counted = np.flatnonzero(away >= clearance_mm)
    if not len(counted):
        raise SolveError(f"no point of the part is {clearance_mm:g} mm away from its edges")
    top = counted[mises[counted].argmax()]
    x, y, z = (float(v) for v in points[top])
    excluded = (
        f"points nearer than {clearance_mm:g} mm to a sharp edge or a patch edge,"
        " where the linear solution is singular"
    )
    return StressPeak(float(mises[top]), (x, y, z), excluded)


def _facet_lattice() -> np.ndarray:
    """Six-node basis values (q, 6) on a lattice of the reference triangle."""
    from skfem import ElementTriP2

    i, j = np.meshgrid(np.arange(LATTICE + 1), np.arange(LATTICE + 1), indexing="ij")
    inside = i + j <= LATTICE
    where = np.stack([i[inside], j[inside]]) / LATTICE
    element = ElementTriP2()
    return np.stack([element.lbasis(where, k)[0] for k in range(6)], axis=1)
