"""The stress figure: the largest von Mises stress away from edges where it is singular."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
class FieldWithoutCuts:
    """Field of the body of revolution that a part is without holes and keyway.

    Attributes
    ----------
    at : displacements (k, 3) [mm] and stresses (k, 3, 3) [MPa] at points (k, 3) [mm], all Cartesian.
    places : (j, 2) the meridian's own nodes r, z [mm].
    """

    at: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    places: np.ndarray


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
    facets = _outer_facets(mesh)
    on_surface = Stresses(_on_lattice(mesh.nodes, facets), _on_lattice(stress, facets))
    peak = _peak((Stresses(mesh.nodes, stress), on_surface), edges)
    return SolidField(mesh, load_case, displacement, von_mises(stress), peak)


def superposed_field(
    mesh: TetMesh,
    change: np.ndarray,
    without_cuts: FieldWithoutCuts,
    material: Elastic,
    load_case: str,
    edges: SharpEdges,
) -> SolidField:
    """Return `stress_field`, where the field of the part without holes and keyway is known at any point.

    `change` (n, 3) [mm] is what these cuts change of the displacement. Only its stress has the mesh's error,
    which for the whole displacement is large at singular patch edges far from the cuts too: a shaft with 8
    holes in its flange had 4.32 MPa beside its grip in place of 3.57.
    """
    displacement, nodal = without_cuts.at(mesh.nodes)
    changed = nodal_stress(mesh, change, material)
    stress = changed + nodal
    facets = _outer_facets(mesh)
    points, on_surface = _on_lattice(mesh.nodes, facets), _on_lattice(stress, facets)
    # of nodes, where nothing is interpolated: beside a singular edge interpolation is far too high
    counted = von_mises(stress)[edges.away(mesh.nodes) >= edges.exclusion_mm].max(initial=0.0)
    of_facet = von_mises(on_surface).reshape(len(facets), -1)
    high = of_facet.max(axis=1) >= HIGH_SHARE * counted
    rows = np.repeat(high, of_facet.shape[1])
    on_surface[rows] += without_cuts.at(points[rows])[1] - _on_lattice(nodal, facets[high])
    peak = _peak(
        (
            Stresses(mesh.nodes, stress),
            Stresses(points, on_surface),
            _between_nodes(mesh, changed, without_cuts),
        ),
        edges,
    )
    return SolidField(mesh, load_case, displacement + change, von_mises(stress), peak)


def _between_nodes(mesh: TetMesh, changed: np.ndarray, without_cuts: FieldWithoutCuts) -> Stresses:
    """Return stresses at the meridian's own nodes, in planes of the mesh's nodes.

    Beside singular edges these are much closer to each other than the mesh's. `changed` (n, 3, 3) is taken
    from the nodes nearest in r and z.
    """
    from scipy.spatial import cKDTree

    x, y, z = mesh.nodes.T
    _, near = cKDTree(np.stack([np.hypot(x, y), z], axis=1)).query(without_cuts.places, PLANES)
    phi = np.arctan2(y, x)[near]
    r, height = (np.broadcast_to(a[:, None], phi.shape) for a in without_cuts.places.T)
    points = np.stack([r * np.cos(phi), r * np.sin(phi), height], axis=2).reshape(-1, 3)
    return Stresses(points, changed[near.ravel()] + without_cuts.at(points)[1])


def _outer_facets(mesh: TetMesh) -> np.ndarray:
    """Return the facets (k, 6) that are no symmetry plane."""
    return mesh.facets[["symmetry" not in mesh.patches[p] for p in mesh.facet_patch]]


def _on_lattice(nodal: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Return nodal values (n, ...) at the lattice points of facets (k, 6), facet by facet."""
    values = lattice_values(LATTICE).T.copy()  # (q, 6)
    return np.einsum("qi,ki...->kq...", values, nodal[facets]).reshape(-1, *nodal.shape[1:])


def _peak(stresses: Sequence[Stresses], edges: SharpEdges) -> StressPeak:
    """Return the largest von Mises stress of those far enough from the edges."""
    points = np.concatenate([s.points for s in stresses])
    mises = np.concatenate([von_mises(s.values) for s in stresses])
    away = edges.away(points)
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
