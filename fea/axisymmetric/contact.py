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
from flexspline.fea.axisymmetric.seat import SeatCompliance, seat_compliance
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline, Pace
from flexspline.fea.shortfall import next_mesh_failed, of_the_machine
from flexspline.fea.threads import one_thread
from flexspline.fea.types import Elastic, MeshLevel, Stiffness
from flexspline.geometry.errors import ComputationError
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
    mesh = triangulate(outline)
    ratios: list[float] = []
    levels: list[MeshLevel] = []
    lowest, highest, shortfall = 0.0, 1.0, supported.shortfall
    pace = Pace(deadline)
    while len(levels) < 2:
        try:
            pace.begin(len(mesh.triangles))
            with one_thread():
                seat = seat_compliance(HarmonicModel(mesh, material), ANGLES, MOST_PLACES)
                resting, held = (seat.stiffness(f(seat)) for f in (lift_off_forces, held_forces))
        except (ComputationError, MemoryError) as fault:
            if not levels:
                raise
            if not of_the_machine(shortfall):  # which a better machine may mend
                shortfall = next_mesh_failed(fault)
            break
        ratios.append(resting / held)
        levels.append(MeshLevel(mesh.shortest_edge_mm, len(mesh.triangles), seat.unknowns, resting))
        lowest = seat.stiffness(np.zeros_like(seat.free)) / held
        mesh = refined(mesh, np.ones(len(mesh.triangles), bool))
    if len(ratios) == 2:
        doubt = abs(ratios[1] - ratios[0])
        lowest, highest = ratios[1] - doubt, ratios[1] + doubt
    return Stiffness(
        K_Nm_per_rad=supported.K_Nm_per_rad * ratios[-1],
        lower_Nm_per_rad=supported.lower_Nm_per_rad * lowest,
        upper_Nm_per_rad=supported.upper_Nm_per_rad * highest,
        guaranteed=False,  # the change between two meshes is an estimate
        model="axisymmetric",
        symmetry=supported.symmetry,
        method=(
            f"unilateral contact at {ANGLES} angles per half turn: {ratios[-1]:.4f} of the K with the"
            f" seat held; bounds from that K's and from {_bounded_by(len(ratios))}"
        ),
        levels=tuple(levels),
        shortfall=shortfall,
    )


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
