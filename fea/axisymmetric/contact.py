"""The wave generator as it is: the rim rests on it and may lift off, it does not stick.

Torque enters at the two lobes; on the seat the contact force may only push: u_r ≥ 0, p ≥ 0, p u_r = 0, at
equally spaced angles and at places along the seat (`seat`, `lift_off`). The answer scales with the
torque, so K is one number, between the rim's that is free and the rim's that is held.
"""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.lift_off import pushing
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.seat import SeatCompliance, seat_compliance
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.refinement import refine
from flexspline.fea.shortfall import of_the_machine
from flexspline.fea.threads import one_thread
from flexspline.fea.types import Elastic, MeshLevel, Stiffness
from flexspline.geometry.outline import Meridian

ANGLES = 32
"""Contact points per half turn. 64 change K by 0.01 %, 48 by 0.006 % (xb1-40)."""
MOST_PLACES = 33
"""Along the seat, closer towards its ends. Twice as many change the ratio by 3e-5 at most (seats of up to 513
nodes), all nodes by 1e-5 (up to 129)."""


def contact_stiffness(
    outline: Meridian,
    material: Elastic,
    supported: Stiffness,
    deadline: Deadline = NO_DEADLINE,
) -> Stiffness:
    """K_b with the torque at the lobes and a seat that may lift off.

    `supported` is K_b with the seat held, solved to a known accuracy: the ratio of the two K on one
    mesh is far more accurate than either, so K = supported × ratio, and the bounds add the ratio's
    change from the mesh before to those of `supported`. They are estimates. Where the second mesh fails
    or would end after the deadline, the ratio is the first's, between that of the free seat and 1, and
    `shortfall` says why.

    Raises
    ------
    MeshingError, HarmonicError, OutOfTimeError : of the first mesh.
    """
    found = _Ratios(material)
    own = refine(found, triangulate(outline), deadline)
    # that of the held seat where a better machine may mend it
    shortfall = own if own and not of_the_machine(supported.shortfall) else supported.shortfall
    ratio = found.ratios[-1]
    lowest, highest = found.lowest, 1.0
    if found.met:
        doubt = abs(ratio - found.ratios[0])
        lowest, highest = ratio - doubt, ratio + doubt
    return Stiffness(
        K_Nm_per_rad=supported.K_Nm_per_rad * ratio,
        lower_Nm_per_rad=supported.lower_Nm_per_rad * lowest,
        upper_Nm_per_rad=supported.upper_Nm_per_rad * highest,
        guaranteed=False,  # the change between two meshes is an estimate
        model="axisymmetric",
        symmetry=supported.symmetry,
        method=(
            f"unilateral contact at {ANGLES} angles per half turn: {ratio:.4f} of the K with the"
            f" seat held; bounds from that K's and from {_bounded_by(len(found.ratios))}"
        ),
        levels=tuple(found.levels),
        shortfall=shortfall,
    )


class _Ratios:
    """K that rests over K that is held, of two meshes; `lowest`: the ratio of a free seat on the last."""

    def __init__(self, material: Elastic) -> None:
        self._material = material
        self.ratios: list[float] = []
        self.levels: list[MeshLevel] = []

    def solve(self, mesh: MeridianMesh) -> None:
        with one_thread():
            seat = seat_compliance(HarmonicModel(mesh, self._material), ANGLES, MOST_PLACES)
            resting, held = (seat.stiffness(f(seat)) for f in (lift_off_forces, held_forces))
        self.ratios.append(resting / held)
        self.levels.append(MeshLevel(mesh.shortest_edge_mm, mesh.elements, seat.unknowns, resting))
        self.lowest = seat.stiffness(np.zeros_like(seat.free)) / held

    @property
    def met(self) -> bool:
        return len(self.ratios) == 2

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        return refined(mesh, np.ones(mesh.elements, bool))


def _bounded_by(meshes: int) -> str:
    return "two meshes" if meshes == 2 else "the seat's that is free and that is held"


def lift_off_forces(seat: SeatCompliance) -> np.ndarray:
    """Contact forces (a, m) [N/rad], nowhere pulling.

    Raises
    ------
    HarmonicError : they did not settle.
    """
    return pushing(seat.matrix, seat.free.ravel()).reshape(seat.free.shape)


def held_forces(seat: SeatCompliance) -> np.ndarray:
    """Forces (a, m) [N/rad] of a seat that is held radially everywhere: the case `lobes`."""
    return seat.resisted(-seat.free)
