"""The wave generator as it is: the rim rests on it and may lift off, it does not stick.

Torque enters at the two lobes; on the seat the contact force may only push: u_r ≥ 0, p ≥ 0, p u_r = 0.
Everything has period π in φ, so only even harmonics occur; each is condensed to the seat, and the
condition is imposed at equally spaced angles. The harmonics' compliances make up a block circulant
matrix S there, and the forces p solve the linear complementarity problem u0 + S p ≥ 0 by a primal-dual
active set (Hintermüller, Ito, Kunisch, SIAM J. Optim. 13 (2002) 865-888). The answer scales with the
torque, so K is one number, between the rim's that is free and the rim's that is held.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from fea.axisymmetric.bisection import refined
from fea.axisymmetric.harmonics import RADIAL, TANGENTIAL, HarmonicError, HarmonicModel, Wave
from fea.axisymmetric.lobes import HALF_WIDTH, TORQUE, lobe_coefficient
from fea.axisymmetric.space import factorised
from fea.axisymmetric.triangulate import triangulate
from fea.types import NMM_PER_NM, Elastic, MeshLevel, Stiffness
from geometry.outline import Meridian

ANGLES = 32
"""Contact points per half turn. 64 change K by 0.01 %, 48 by 0.006 % (xb1-40)."""
MOST_ROUNDS = 60


@dataclass(frozen=True)
class SeatCompliance:
    """The rim as the seat sees it, at `angles` (a,) over half a turn and seat nodes (s,).

    Attributes
    ----------
    free : (a, s) radial displacement [mm] under TORQUE at the lobes with nothing on the seat.
    matrix : (a·s, a·s) radial displacement per unit nodal force per angle [mm per N/rad].
    free_work : torque times rotation with nothing on the seat [N·mm].
    unknowns : of one harmonic.
    """

    angles: np.ndarray
    free: np.ndarray
    matrix: np.ndarray
    free_work: float
    unknowns: int

    def stiffness(self, force: np.ndarray) -> float:
        """K [N·m/rad] with seat forces (a, s) [N/rad]; their share of the work by Betti's theorem."""
        work = self.free_work + 2 * pi / len(self.angles) * float((force * self.free).sum())
        return TORQUE**2 / work / NMM_PER_NM


def contact_stiffness(outline: Meridian, material: Elastic, supported: Stiffness) -> Stiffness:
    """K_b with the torque at the lobes and a seat that may lift off.

    `supported` is K_b with the seat held, solved to a known accuracy: the ratio of the two K on one
    mesh is far more accurate than either, so K = supported × ratio, and the bounds add the ratio's
    change from the mesh before to those of `supported`. They are estimates.

    Raises
    ------
    HarmonicError : a harmonic was not solved, or the contact did not settle.
    """
    mesh = triangulate(outline)
    ratios: list[float] = []
    levels: list[MeshLevel] = []
    for _ in range(2):
        seat = seat_compliance(HarmonicModel(mesh, material), ANGLES)
        resting, held = (seat.stiffness(f(seat)) for f in (lift_off_forces, held_forces))
        ratios.append(resting / held)
        size = (len(mesh.triangles), seat.unknowns)
        levels.append(
            MeshLevel(_edge_length(mesh.points, mesh.triangles), *size, resting, resting, 0.0)
        )
        mesh = refined(mesh, np.ones(len(mesh.triangles), bool))
    doubt = abs(ratios[1] - ratios[0])
    return Stiffness(
        K_Nm_per_rad=supported.K_Nm_per_rad * ratios[1],
        lower_Nm_per_rad=supported.lower_Nm_per_rad * (ratios[1] - doubt),
        upper_Nm_per_rad=supported.upper_Nm_per_rad * (ratios[1] + doubt),
        model="axisymmetric",
        symmetry=supported.symmetry,
        method=(
            f"unilateral contact at {ANGLES} angles per half turn: {ratios[1]:.4f} of the K with the"
            " seat held; bounds from that K's and from two meshes"
        ),
        levels=tuple(levels),
    )


def seat_compliance(model: HarmonicModel, angles: int) -> SeatCompliance:
    """Condense the harmonics 0, 2, … `angles` (an even number) to the seat."""
    if angles % 2:
        raise ValueError("the number of angles must be even")
    seat = model.on("seat")
    phi = np.arange(angles) * pi / angles
    ring = model.space.places[model.on("mesh")]
    peak = TORQUE / (ring[0, 0] ** 2 * np.ptp(ring[:, 1]) * 2 * HALF_WIDTH)
    push = np.zeros((3 * model.space.count, len(seat)))
    push[3 * seat + RADIAL, np.arange(len(seat))] = 1.0
    free = np.zeros((angles, len(seat)))
    blocks = np.zeros((angles, len(seat), len(seat)))  # by difference of angle
    work = 0.0
    for n in range(0, angles + 1, 2):
        # a force of 1 N/rad times cos nφ has the nodal amplitude ∫cos² nφ dφ
        wave = Wave(n, torsion=n == 0)
        twist = (peak * lobe_coefficient(n) * model.pressed("mesh", TANGENTIAL, wave))[:, None]
        if n:
            both = _responses(model, wave, np.column_stack([push, twist]))
            pushed, u = both[:, :-1], both[:, -1]
        else:
            pushed, u = _responses(model, Wave(0), push), _responses(model, wave, twist)[:, 0]
        radial = Wave(n).around * pushed[3 * seat + RADIAL]
        share = (1 if n in (0, angles) else 2) / angles  # of a unit force at one angle
        blocks += share * np.cos(n * phi)[:, None, None] * radial
        work += float(u @ twist[:, 0])
        # the load varies as cos nφ, so u_r as −sin nφ (the twin symmetry of `harmonics`)
        free -= np.sin(n * phi)[:, None] * u[3 * seat + RADIAL]
    i, j = np.meshgrid(np.arange(angles), np.arange(angles), indexing="ij")
    matrix = blocks[(i - j) % angles].transpose(0, 2, 1, 3).reshape(free.size, free.size)
    return SeatCompliance(phi, free, (matrix + matrix.T) / 2, work, len(push))


def _responses(model: HarmonicModel, wave: Wave, loads: np.ndarray) -> np.ndarray:
    """Displacements (3·count, k) under nodal forces (3·count, k), `mount` held."""
    free, _ = model.prescribed(wave, model.held("mount"))
    out = np.zeros_like(loads)
    out[free] = factorised(model.supported(wave, free)).solve(loads[free])
    return out


def lift_off_forces(seat: SeatCompliance) -> np.ndarray:
    """Contact forces (a, s) [N/rad], nowhere pulling.

    Raises
    ------
    HarmonicError : the active set did not settle.
    """
    gap = seat.free.ravel()
    touching = gap < 0
    scale = np.diag(seat.matrix).mean()
    for _ in range(MOST_ROUNDS):
        force = np.zeros_like(gap)
        on = np.flatnonzero(touching)
        force[on] = np.linalg.solve(seat.matrix[np.ix_(on, on)], -gap[on])
        now = force - (gap + seat.matrix @ force) / scale > 0
        if (now == touching).all():
            return force.reshape(seat.free.shape)
        touching = now
    raise HarmonicError(f"the contact on the seat did not settle in {MOST_ROUNDS} rounds")


def held_forces(seat: SeatCompliance) -> np.ndarray:
    """Forces (a, s) [N/rad] of a seat that is held radially everywhere: the case `lobes`."""
    return np.linalg.solve(seat.matrix, -seat.free.ravel()).reshape(seat.free.shape)


def _edge_length(points: np.ndarray, triangles: np.ndarray) -> float:
    """Longest edge [mm]."""
    corner = points[triangles]
    return float(np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max())
