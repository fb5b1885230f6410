"""Added stiffness of a thin layer on the free surface of a twisted body of revolution."""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.twist import Twist
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import Meridian, SAME_mm

LAYER_POINTS = 16
"""Points on each edge, within which a layer may end. Judgement."""


class HeldSurfaceError(ComputationError):
    """No slope over the free surface: a patch moves by `by_mm` where the outline gets new corners."""

    def __init__(self, patch: str, by_mm: float) -> None:
        self.patch, self.by_mm = patch, by_mm
        super().__init__(f"the outline gets new corners and its {patch} moves")


def layer_stiffness(solved: Twist, outline: Meridian) -> float:
    """Return the stiffness of the layers between the solved and another outline [N·m/rad], first order.

    On a free surface only the strain along it is left, γ = r ∂ψ/∂s; dA = 2πr ds.

    Raises
    ------
    HeldSurfaceError : a patch moves; its share is no matter of the energy alone.
    """
    mesh = solved.mesh
    space = HarmonicModel(mesh, solved.material).space
    ends = space.places[space.rim[:, :2]]
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    outward = np.column_stack([along[:, 1], -along[:, 0]]) / length[:, None]
    added = 0.0
    for t in (np.arange(LAYER_POINTS) + 0.5) / LAYER_POINTS:
        at = ends[:, 0] + t * along
        exact = _nearest(mesh.outline, at)  # the mesh's edges are chords of its arcs
        thickness = ((_nearest(outline, exact) - exact) * outward).sum(axis=1)
        _check_patches(mesh, thickness)
        slopes = np.array([4 * t - 3, 4 * t - 1, 4 - 8 * t])  # of the edge's shape functions
        strain = at[:, 0] * (solved.rotation[space.rim] @ slopes) / length
        shear = solved.material.mu * strain**2
        added += float((shear * thickness * 2 * np.pi * at[:, 0] * length).sum()) / LAYER_POINTS
    return added / NMM_PER_NM


def _nearest(outline: Meridian, at: np.ndarray) -> np.ndarray:
    """The outline's nearest points to points (n, 2)."""
    nearest = np.stack([s.nearest(at) for s in outline.segments])
    closest = np.linalg.norm(nearest - at, axis=2).argmin(axis=0)
    return nearest[closest, np.arange(len(at))]


def _check_patches(mesh: MeridianMesh, thickness: np.ndarray) -> None:
    for index, segment in enumerate(mesh.outline.segments):
        moves = np.abs(thickness[mesh.edge_segment == index])
        if segment.patch and moves.size and moves.max() > SAME_mm:
            raise HeldSurfaceError(segment.patch, float(moves.max()))
