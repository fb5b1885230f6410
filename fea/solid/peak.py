"""The stress figure: the largest von Mises stress away from edges where it is singular."""

from __future__ import annotations

from collections.abc import Callable
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


HIGH_SHARE = 0.8
"""Of the largest stress that counts: facets with at least that are evaluated at their lattice points, not
interpolated between nodes. On the others interpolation is no 20 % off. Judgement."""
StressAt = Callable[[np.ndarray], np.ndarray]
"""Stresses (k, 3, 3) [MPa] at points (k, 3) [mm], both Cartesian."""


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
    peak = _peak(mesh, stress, _on_lattice(mesh, stress), edges)
    return SolidField(mesh, load_case, displacement, von_mises(stress), peak)


def superposed_field(
    mesh: TetMesh,
    displacement: np.ndarray,
    change: np.ndarray,
    without_cuts: StressAt,
    material: Elastic,
    load_case: str,
    edges: SharpEdges,
) -> SolidField:
    """Return `stress_field`, where the stress of the part without holes and keyway is known at any point.

    `change` (n, 3) [mm] is what these cuts change of the displacement. Only its stress has the mesh's error,
    which for the whole displacement is large at singular patch edges far from the cuts too: a shaft with 8
    holes in its flange had 4.32 MPa beside its grip in place of 3.57.
    """
    nodal = without_cuts(mesh.nodes)
    stress = nodal_stress(mesh, change, material) + nodal
    on_surface = _on_lattice(mesh, stress)
    mises = von_mises(on_surface)
    away = _away(_lattice_points(mesh), edges)
    high = np.flatnonzero(
        mises.max(axis=1) >= HIGH_SHARE * mises[away >= edges.exclusion_mm].max(initial=0.0)
    )
    points = _lattice_points(mesh)[high]
    on_surface[high] += without_cuts(points.reshape(-1, 3)).reshape(on_surface[high].shape)
    on_surface[high] -= _on_lattice(mesh, nodal)[high]
    peak = _peak(mesh, stress, on_surface, edges)
    return SolidField(mesh, load_case, displacement, von_mises(stress), peak)


def _outer_facets(mesh: TetMesh) -> np.ndarray:
    """Return the facets (k, 6) that are no symmetry plane."""
    return mesh.facets[["symmetry" not in mesh.patches[p] for p in mesh.facet_patch]]


def _on_lattice(mesh: TetMesh, nodal: np.ndarray) -> np.ndarray:
    """Return nodal stresses (n, 3, 3) at the lattice points (k, q, 3, 3) of the outer facets."""
    values = lattice_values(LATTICE).T.copy()  # (q, 6)
    return np.einsum("qi,kiab->kqab", values, nodal[_outer_facets(mesh)])


def _lattice_points(mesh: TetMesh) -> np.ndarray:
    """Return the lattice points (k, q, 3) [mm] of the outer facets."""
    values = lattice_values(LATTICE).T.copy()
    return np.einsum("qi,kix->kqx", values, mesh.nodes[_outer_facets(mesh)])


def _away(points: np.ndarray, edges: SharpEdges) -> np.ndarray:
    """Return the distance [mm] of points (..., 3) from the nearest edge."""
    from scipy.spatial import cKDTree

    in_sector = folded(points.reshape(-1, 3), edges.sector_deg)
    return cKDTree(edges.points).query(in_sector)[0].reshape(points.shape[:-1])


def _peak(
    mesh: TetMesh, stress: np.ndarray, on_surface: np.ndarray, edges: SharpEdges
) -> StressPeak:
    """Return the peak of stresses at the nodes (n, 3, 3) and at the lattice points (k, q, 3, 3)."""
    points = np.vstack([mesh.nodes, _lattice_points(mesh).reshape(-1, 3)])
    mises = np.concatenate([von_mises(stress), von_mises(on_surface).ravel()])
    away = _away(points, edges)
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
