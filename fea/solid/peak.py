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
"""Of the largest stress that counts at a node: facets with at least that are evaluated at their lattice
points, not interpolated between nodes. On the others interpolation is no 20 % off. Judgement."""
PLANES = 8
"""Nodes nearest to a place of the meridian, in whose planes the stress there is looked at. Judgement."""


@dataclass(frozen=True)
class StressWithoutCuts:
    """Stress of the body of revolution that a part is without holes and keyway.

    Attributes
    ----------
    at : stresses (k, 3, 3) [MPa] at points (k, 3) [mm], both Cartesian.
    places : (j, 2) the meridian's own nodes r, z [mm].
    """

    at: Callable[[np.ndarray], np.ndarray]
    places: np.ndarray


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
    without_cuts: StressWithoutCuts,
    material: Elastic,
    load_case: str,
    edges: SharpEdges,
) -> SolidField:
    """Return `stress_field`, where the stress of the part without holes and keyway is known at any point.

    `change` (n, 3) [mm] is what these cuts change of the displacement. Only its stress has the mesh's error,
    which for the whole displacement is large at singular patch edges far from the cuts too: a shaft with 8
    holes in its flange had 4.32 MPa beside its grip in place of 3.57.
    """
    nodal, changed = without_cuts.at(mesh.nodes), nodal_stress(mesh, change, material)
    stress = changed + nodal
    on_surface = _on_lattice(mesh, stress)
    # of nodes, where nothing is interpolated: beside a singular edge interpolation is far too high
    counted = von_mises(stress)[_away(mesh.nodes, edges) >= edges.exclusion_mm].max(initial=0.0)
    high = np.flatnonzero(von_mises(on_surface).max(axis=1) >= HIGH_SHARE * counted)
    points = _lattice_points(mesh)[high]
    on_surface[high] += without_cuts.at(points.reshape(-1, 3)).reshape(on_surface[high].shape)
    on_surface[high] -= _on_lattice(mesh, nodal)[high]
    between = _between_nodes(mesh, changed, without_cuts)
    peak = _peak(mesh, stress, on_surface, edges, between)
    return SolidField(mesh, load_case, displacement, von_mises(stress), peak)


def _between_nodes(
    mesh: TetMesh, changed: np.ndarray, without_cuts: StressWithoutCuts
) -> tuple[np.ndarray, np.ndarray]:
    """Return points (k, 3) and stresses (k, 3, 3) at the meridian's own nodes, in planes of the mesh's nodes.

    Beside singular edges these are much closer to each other than the mesh's. `changed` (n, 3, 3) is taken
    from the nodes nearest in r and z.
    """
    from scipy.spatial import cKDTree

    x, y, z = mesh.nodes.T
    _, near = cKDTree(np.stack([np.hypot(x, y), z], axis=1)).query(without_cuts.places, PLANES)
    phi = np.arctan2(y, x)[near]
    r, height = (np.broadcast_to(a[:, None], phi.shape) for a in without_cuts.places.T)
    points = np.stack([r * np.cos(phi), r * np.sin(phi), height], axis=2).reshape(-1, 3)
    return points, changed[near.ravel()] + without_cuts.at(points)


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
    mesh: TetMesh,
    stress: np.ndarray,
    on_surface: np.ndarray,
    edges: SharpEdges,
    more: tuple[np.ndarray, np.ndarray] = (np.empty((0, 3)), np.empty((0, 3, 3))),
) -> StressPeak:
    """Return the peak of stresses at the nodes (n, 3, 3) and at the lattice points (k, q, 3, 3).

    `more`: other points (j, 3) and the stresses (j, 3, 3) there.
    """
    points = np.vstack([mesh.nodes, _lattice_points(mesh).reshape(-1, 3), more[0]])
    mises = np.concatenate([von_mises(stress), von_mises(on_surface).ravel(), von_mises(more[1])])
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
