"""Torsional stiffness of a body of revolution, with guaranteed bounds from both sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.fea.axisymmetric.bisection import Box, refined_repeatedly, refined_while
from flexspline.fea.axisymmetric.finer_in_boxes import finer_in_boxes
from flexspline.fea.axisymmetric.marking import MOST_TRIANGLES, bulk
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.patches import Boundary, sorted_boundary
from flexspline.fea.axisymmetric.torsion_fields import Bracket, Turn, across_from_axis, bracket
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.refinement import refine
from flexspline.fea.types import NMM_PER_NM, Elastic, MeshLevel, Shortfall, Stiffness
from flexspline.geometry.outline import Meridian

TORSION_SHARES = (0.75, 0.5)
"""Shares of the gap: the triangles with the first are refined each round (Dörfler, SINUM 33, 1996), those
with the second twice. They lie where the stress is singular; K to 0.2 % then takes two thirds of the time."""
SMALL_MESH, SMALL_MESH_SHARE = 250, 0.25
"""Below so many triangles those with this share of the gap are refined a third time: a small mesh's time is
that of its setup. K of eight cups to 0.3, 0.2, 0.1 and 0.02 % then takes 3.0, 3.4, 4.0 and 5.1 meshes for
3.8, 4.0, 4.9 and 6.0, the last as large."""

MOST_TRIANGLES_WITHIN = 12_000
"""Most triangles of a third or later mesh that is fine in a box: 0.5 s."""


def torsional_stiffness(
    outline: Meridian,
    material: Elastic,
    driven: str,
    relative_width: float,
    deadline: Deadline = NO_DEADLINE,
) -> Stiffness:
    """Return the torsional stiffness K = torque/angle with `mount` held and `driven` turned rigidly.

    `driven` is "mesh" for a flexspline, "grip" for a shaft. `relative_width` is the wanted
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
    bounds, mesh = _Bounds(boundary, relative_width, material), _first_mesh(outline, boundary)
    return bounds.stiffness(refine(bounds, mesh, deadline, MOST_TRIANGLES))


@dataclass(frozen=True)
class SolvedTorsion:
    """The stiffness, and the field of the finest mesh for a turn of 1 rad."""

    stiffness: Stiffness
    turn: Turn


def solved_torsions(
    outline: Meridian,
    material: Elastic,
    driven: str,
    relative_width: float,
    boxes: Sequence[Box],
    deadline: Deadline = NO_DEADLINE,
) -> Iterator[SolvedTorsion]:
    """Yield `torsional_stiffness` with its field, on meshes that become finer and finer in boxes.

    Edges there are as the boxes ask on the first, and half as long on each mesh after it, until a third one
    would have more than MOST_TRIANGLES_WITHIN triangles.

    Raises
    ------
    PatchError, MeshingError, OutOfTimeError
    """
    boundary = sorted_boundary(outline, driven)
    bounds, mesh = _Bounds(boundary, relative_width, material), _first_mesh(outline, boundary)
    for shortfall in finer_in_boxes(bounds, mesh, boxes, deadline, MOST_TRIANGLES_WITHIN):
        yield SolvedTorsion(bounds.stiffness(shortfall), bounds.turn)


def _first_mesh(outline: Meridian, boundary: Boundary) -> MeridianMesh:
    return refined_while(triangulate(outline), lambda mesh: across_from_axis(mesh, boundary))


class _Bounds:
    """Bounds of K/G [mm³] by the meshes so far, and the figures of each mesh."""

    def __init__(self, boundary: Boundary, relative_width: float, material: Elastic) -> None:
        self._boundary, self._relative_width = boundary, relative_width
        self._per_G = material.mu / NMM_PER_NM  # mm³ -> N·m/rad
        self.lower, self.upper = 0.0, np.inf
        self.levels: list[MeshLevel] = []

    def solve(self, mesh: MeridianMesh) -> None:
        bounds = bracket(mesh, self._boundary)
        # every mesh's bounds hold, so the best of all do
        self.lower, self.upper = max(self.lower, bounds.lower), min(self.upper, bounds.upper)
        self.levels.append(_level(mesh, bounds, self._per_G))
        self._share, self.turn, self.mesh = bounds.share, bounds.turn, mesh

    @property
    def met(self) -> bool:
        return 2 * (self.upper - self.lower) / (self.upper + self.lower) < self._relative_width

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        small = mesh.elements < SMALL_MESH
        shares = (*TORSION_SHARES, SMALL_MESH_SHARE) if small else TORSION_SHARES
        return refined_repeatedly(mesh, [bulk(self._share, share) for share in shares])

    def stiffness(self, shortfall: Shortfall) -> Stiffness:
        """K between its bounds."""
        lower, upper = self.lower * self._per_G, self.upper * self._per_G
        return Stiffness(
            K_Nm_per_rad=(lower + upper) / 2,
            lower_Nm_per_rad=lower,
            upper_Nm_per_rad=upper,
            guaranteed=True,
            model="axisymmetric",
            symmetry="body of revolution",
            method=(
                "energy bounds from both sides: minimum potential energy above, minimum complementary energy "
                "below (Michell's two fields), exact fillet arcs enclosed"
            ),
            levels=tuple(self.levels),
            shortfall=shortfall,
        )


def _level(mesh: MeridianMesh, bounds: Bracket, per_G: float) -> MeshLevel:
    return MeshLevel(
        shortest_edge_mm=mesh.shortest_edge_mm,
        elements=mesh.elements,
        dofs=bounds.unknowns,
        K_Nm_per_rad=bounds.upper * per_G,
        K_check_Nm_per_rad=bounds.reaction * per_G,
        residual=bounds.residual,
    )
