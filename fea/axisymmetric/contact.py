"""Contact of the rim with the wave generator: without friction, and the rim may lift off.

Torque enters at the two lobes; on the seat the contact force may only push: u_r ≥ 0, p ≥ 0, p u_r = 0, at
equally spaced angles and at places along the seat (`seat`, `lift_off`). The answer scales with the
torque, so K is one number, between the rim's that is free and the rim's that is held.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.lift_off import pushing
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.seat import SeatCompliance, seat_compliance
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.refinement import refine
from flexspline.fea.threads import one_thread
from flexspline.fea.types import Elastic, MeshLevel, Stiffness
from flexspline.geometry.outline import Meridian

ANGLES = 32
"""Contact points per half turn. 64 change K by 0.01 %, 48 by 0.006 % (xb1-40)."""
MOST_SEAT_PLACES = 33
"""Most places along the seat; they are closer to each other towards its ends. Twice as many change the ratio
by 3e-5 at most (seats of up to 513 nodes), all nodes change it by 1e-5 (up to 129 nodes)."""
MOST_MESHES, MOST_CONTACT_TRIANGLES = 4, 2400
"""Most meshes and most triangles. Each mesh has four times the triangles of the one before; 2400 take 1.7 s,
7000 take 7 to 8 s."""
CHANGE_RATIOS = (0.25, 0.7)
"""Of the ratio's changes from mesh to mesh, the range believed: edges that halve leave a half at singular
ends of the seat, 1/4 of a smooth field. 0.26 to 0.65 on five random flexsplines and up to five meshes."""


def contact_stiffness(
    outline: Meridian,
    material: Elastic,
    supported: Stiffness,
    deadline: Deadline = NO_DEADLINE,
    tolerance: float = inf,
) -> Stiffness:
    """Return K_b with the torque at the lobes and a seat that may lift off.

    `supported` is K_b with the seat held, solved to a known accuracy: the ratio of the two K on one
    mesh is far more accurate than either, so K = supported × ratio, and the bounds add the ratio's
    change from the mesh before to those of `supported`. They are estimates. Where half their
    distance is more than `tolerance`·K, and that of `supported` is not, more meshes tell how fast the
    ratio settles, and the bounds go twice as far as it has yet to go. Where the second mesh fails or
    would end after the deadline, the ratio is the first's, between that of the free seat and 1, and
    `shortfall` says why.

    Raises
    ------
    MeshingError, HarmonicError, OutOfTimeError : of the first mesh.
    """
    ratios = _Ratios(material, tolerance - supported.half_width)
    shortfall = refine(ratios, triangulate(outline), deadline)
    if not shortfall or supported.shortfall.of_the_machine:  # a better machine may mend it
        shortfall = supported.shortfall
    ratio, lowest, highest = ratios.ratios[-1], ratios.lowest, 1.0
    if len(ratios.ratios) > 1:
        ratio, doubt = settling(ratios.ratios)
        lowest, highest = ratio - doubt, ratio + doubt
    return Stiffness(
        K_Nm_per_rad=supported.K_Nm_per_rad * ratio,
        lower_Nm_per_rad=supported.lower_Nm_per_rad * lowest,
        upper_Nm_per_rad=supported.upper_Nm_per_rad * highest,
        guaranteed=False,  # the change between two meshes is an estimate
        model="axisymmetric",
        symmetry=supported.symmetry,
        method=(
            f"unilateral contact at {ANGLES} angles per half turn: {ratio:.4f} times K with the seat"
            f" held; bounds: those of that K, widened {_doubt_of(len(ratios.ratios))}"
        ),
        levels=tuple(ratios.levels),
        shortfall=shortfall,
    )


class _Ratios:
    """K that rests over K that is held, of two meshes and more; `lowest`: a free seat's ratio on the last.

    `wanted` is the relative doubt that may be left. 0 or less cannot be reached; two meshes are then enough.
    """

    def __init__(self, material: Elastic, wanted: float) -> None:
        self._material, self._wanted = material, wanted
        self.ratios: list[float] = []
        self.levels: list[MeshLevel] = []

    def solve(self, mesh: MeridianMesh) -> None:
        with one_thread():
            seat = seat_compliance(HarmonicModel(mesh, self._material), ANGLES, MOST_SEAT_PLACES)
            resting, held = (seat.stiffness(f(seat)) for f in (lift_off_forces, held_forces))
        self.ratios.append(resting / held)
        self.levels.append(MeshLevel(mesh.shortest_edge_mm, mesh.elements, seat.unknowns, resting))
        self.lowest = seat.stiffness(np.zeros_like(seat.free)) / held

    @property
    def met(self) -> bool:
        if len(self.ratios) < 2:
            return False
        ratio, doubt = settling(self.ratios)
        return self._wanted <= 0 or doubt <= self._wanted * ratio

    def finer(self, mesh: MeridianMesh) -> MeridianMesh | None:
        beyond = 4 * mesh.elements > MOST_CONTACT_TRIANGLES or len(self.ratios) == MOST_MESHES
        if len(self.ratios) > 1 and beyond:
            return None
        return refined(mesh, np.ones(mesh.elements, bool))


def settling(ratios: Sequence[float]) -> tuple[float, float]:
    """Return the limit of the ratios on meshes with ever halved edges, and its possible error.

    Two meshes give only their difference. From three, the last two changes give the ratio of a geometric
    series.
    """
    last = ratios[-1] - ratios[-2]
    if len(ratios) == 2:
        return ratios[-1], abs(last)
    before = ratios[-2] - ratios[-3]
    if last * before <= 0 or abs(last) >= abs(before):  # no series
        return ratios[-1], max(abs(last), abs(before))
    rate = float(np.clip(last / before, *CHANGE_RATIOS))
    to_go = last * rate / (1 - rate)
    return ratios[-1] + to_go, abs(to_go)


def _doubt_of(meshes: int) -> str:
    if meshes > 1:
        return f"by what the ratio still changes between {meshes} meshes"
    return "from the ratio of a free seat to 1, for there is one mesh"


def lift_off_forces(seat: SeatCompliance) -> np.ndarray:
    """Return contact forces (a, m) [N/rad], none of them pulling.

    Raises
    ------
    HarmonicError : they did not settle.
    """
    return pushing(seat.matrix, seat.free.ravel()).reshape(seat.free.shape)


def held_forces(seat: SeatCompliance) -> np.ndarray:
    """Return the forces (a, m) [N/rad] of a seat that is held radially everywhere: the case `lobes`."""
    return seat.resisted(-seat.free)
