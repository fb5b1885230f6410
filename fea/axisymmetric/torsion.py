"""Torsional stiffness of a body of revolution, between two bounds that are theorems."""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.patches import sorted_boundary
from flexspline.fea.axisymmetric.torsion_fields import Bracket, across_from_axis, bracket
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline, Pace
from flexspline.fea.shortfall import largest_mesh, next_mesh_failed
from flexspline.fea.types import NMM_PER_NM, Elastic, MeshLevel, Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import Meridian

BULK = 0.75
"""Share of the gap whose triangles are refined each round (Dörfler, SINUM 33, 1996)."""
MOST_TRIANGLES = 400_000
"""A mesh with more of them is the last one."""


def torsional_stiffness(
    outline: Meridian,
    material: Elastic,
    driven: str,
    tolerance: float,
    deadline: Deadline = NO_DEADLINE,
) -> Stiffness:
    """Torsional stiffness K = torque/angle with `mount` held and `driven` turned rigidly.

    `driven` is "mesh" for a flexspline, "grip" for a shaft. `tolerance` is the wanted
    (upper - lower)/K as a fraction (0.001 is 0.1 %); the mesh is refined where the two fields
    disagree until it is met, or until a mesh fails, is too large or would end after the deadline: then
    the bounds are those of the meshes before, and `shortfall` says why.
    The bounds are theorems, for the outline with its exact arcs too, which straight edges pushed
    outwards enclose above and inwards below: `torsion_fields` says why. K is their mean.
    `levels` holds each mesh's displacement solution (its upper bound), by energy and by reaction.

    Raises
    ------
    PatchError, MeshingError, OutOfTimeError : of the first mesh.

    Source: J. H. Michell, Proc. London Math. Soc. 31 (1899) 130-146, for the two fields.
    """
    boundary = sorted_boundary(outline, driven)
    mesh = triangulate(outline)
    while (near := across_from_axis(mesh, boundary)).any():
        mesh = refined(mesh, near)
    per_G = material.mu / NMM_PER_NM  # mm³ -> N·m/rad
    levels: list[MeshLevel] = []
    lower, upper, shortfall = 0.0, np.inf, ""
    pace = Pace(deadline)
    while True:
        try:
            pace.begin(len(mesh.triangles))
            found = bracket(mesh, boundary)
        except (ComputationError, MemoryError) as fault:
            if not levels:
                raise
            shortfall = next_mesh_failed(fault)
            break
        # every mesh's bounds hold, so the best of all do
        lower, upper = max(lower, found.lower), min(upper, found.upper)
        levels.append(_level(mesh, found, per_G))
        reached = 2 * (upper - lower) / (upper + lower)
        if reached < tolerance:
            break
        if len(mesh.triangles) > MOST_TRIANGLES:
            shortfall = largest_mesh(len(mesh.triangles), MOST_TRIANGLES)
            break
        mesh = refined(mesh, bulk(found.share, BULK))
    return Stiffness(
        K_Nm_per_rad=(lower + upper) / 2 * per_G,
        lower_Nm_per_rad=lower * per_G,
        upper_Nm_per_rad=upper * per_G,
        guaranteed=True,
        model="axisymmetric",
        symmetry="body of revolution",
        method=(
            "energy bounds from both sides: minimum potential energy above, minimum complementary energy "
            "below (Michell's two fields), exact fillet arcs enclosed"
        ),
        levels=tuple(levels),
        shortfall=shortfall,
    )


def bulk(share: np.ndarray, fraction: float) -> np.ndarray:
    """Mask of the fewest triangles that together hold the given fraction of the whole."""
    order = np.argsort(-share)
    held = np.cumsum(share[order])
    mask = np.zeros(len(share), bool)
    mask[order[: int(np.searchsorted(held, fraction * held[-1])) + 1]] = True
    return mask


def _level(mesh: MeridianMesh, found: Bracket, per_G: float) -> MeshLevel:
    return MeshLevel(
        shortest_edge_mm=mesh.shortest_edge_mm,
        elements=len(mesh.triangles),
        dofs=found.unknowns,
        K_Nm_per_rad=found.upper * per_G,
        K_check_Nm_per_rad=found.reaction * per_G,
        residual=found.residual,
    )
