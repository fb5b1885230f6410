"""Torsional stiffness of a body of revolution, between two bounds that are theorems."""

from __future__ import annotations

import numpy as np

from fea.axisymmetric.bisection import refined
from fea.axisymmetric.meridian_mesh import MeridianMesh
from fea.axisymmetric.patches import sorted_boundary
from fea.axisymmetric.torsion_fields import Bracket, across_from_axis, bracket
from fea.axisymmetric.triangulate import triangulate
from fea.types import NMM_PER_NM, Elastic, MeshLevel, Stiffness
from geometry.errors import ComputationError
from geometry.outline import Meridian

BULK = 0.75
"""Share of the gap whose triangles are refined each round (Dörfler, SINUM 33, 1996)."""
MOST_TRIANGLES = 400_000


class ToleranceError(ComputationError):
    """The wanted tolerance was not met; carries how far the bounds came.

    Attributes
    ----------
    reached : (upper - lower)/K of the last mesh.
    triangles : of that mesh.
    """

    def __init__(self, tolerance: float, reached: float, triangles: int) -> None:
        self.reached, self.triangles = reached, triangles
        super().__init__(
            f"bounds of K are {reached:.3g} apart on {triangles} triangles, wanted {tolerance:.3g}"
        )


def torsional_stiffness(
    outline: Meridian, material: Elastic, driven: str, tolerance: float
) -> Stiffness:
    """Torsional stiffness K = torque/angle with `mount` held and `driven` turned rigidly.

    `driven` is "mesh" for a flexspline, "grip" for a shaft. `tolerance` is the wanted
    (upper - lower)/K as a fraction (0.001 is 0.1 %); the mesh is refined where the two fields
    disagree until it is met.
    The bounds hold for the outline with its exact arcs; `torsion_fields` says why. K is their mean.
    `levels` holds each mesh's displacement solution (its upper bound), by energy and by reaction.

    Raises
    ------
    PatchError, MeshingError, ToleranceError

    Source: J. H. Michell, Proc. London Math. Soc. 31 (1899) 130-146, for the two fields.
    """
    boundary = sorted_boundary(outline, driven)
    mesh = triangulate(outline)
    while (near := across_from_axis(mesh, boundary)).any():
        mesh = refined(mesh, near)
    per_G = material.mu / NMM_PER_NM  # mm³ -> N·m/rad
    levels: list[MeshLevel] = []
    lower, upper = 0.0, np.inf
    while True:
        found = bracket(mesh, boundary)
        # every mesh's bounds hold, so the best of all do
        lower, upper = max(lower, found.lower), min(upper, found.upper)
        levels.append(_level(mesh, found, per_G))
        reached = 2 * (upper - lower) / (upper + lower)
        if reached < tolerance:
            break
        if len(mesh.triangles) > MOST_TRIANGLES:
            raise ToleranceError(tolerance, reached, len(mesh.triangles))
        mesh = refined(mesh, bulk(found.share, BULK))
    return Stiffness(
        K_Nm_per_rad=(lower + upper) / 2 * per_G,
        lower_Nm_per_rad=lower * per_G,
        upper_Nm_per_rad=upper * per_G,
        model="axisymmetric",
        symmetry="body of revolution",
        method=(
            "guaranteed bounds: minimum potential energy above, minimum complementary energy "
            "below (Michell's two fields), exact fillet arcs enclosed"
        ),
        levels=tuple(levels),
    )


def bulk(share: np.ndarray, fraction: float) -> np.ndarray:
    """Mask of the fewest triangles that together hold the given fraction of the whole."""
    order = np.argsort(-share)
    held = np.cumsum(share[order])
    mask = np.zeros(len(share), bool)
    mask[order[: int(np.searchsorted(held, fraction * held[-1])) + 1]] = True
    return mask


def _level(mesh: MeridianMesh, found: Bracket, per_G: float) -> MeshLevel:
    shortest = np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1).min()
    return MeshLevel(
        edge_length_mm=float(shortest),
        elements=len(mesh.triangles),
        dofs=found.unknowns,
        K_Nm_per_rad=found.upper * per_G,
        K_reaction_Nm_per_rad=found.reaction * per_G,
        residual=found.residual,
    )
