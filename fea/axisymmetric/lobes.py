"""K_b when the torque enters at the two ends of the wave generator's major axis.

The traction on `mesh` is tangential, cos²(π(φ - φk)/2φ0) within φ0 = 30° of φk = 0 and 180°, that
is t(φ) = Σ t_n cos nφ over even n. Each harmonic is one solve on the meridian and their energies
add: K_b = T²/(2 Σ U_n). n = 0 is pure torsion.

What is left after the last harmonic N is bounded by c_N·Σ_{n>N} t_n², where c_n = U_n/t_n² falls
with n (shorter waves are stiffer) and the sum of all t_n² is known (Parseval).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import pi, sin

import numpy as np

from flexspline.fea.axisymmetric.bisection import Box, refined_repeatedly
from flexspline.fea.axisymmetric.finer_in_boxes import finer_in_boxes
from flexspline.fea.axisymmetric.harmonics import Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.marking import MOST_TRIANGLES, bulk
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.recovery import recovered
from flexspline.fea.axisymmetric.space import Space
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.lobe_torque import LOBE_TORQUE_NMM, stiffness_of_work
from flexspline.fea.refinement import refinements
from flexspline.fea.scaled_estimate import MeshResult, ScaledEstimate
from flexspline.fea.types import Elastic, MeshLevel, Shortfall, Stiffness
from flexspline.geometry.outline import Meridian
from flexspline.geometry.percent import percent

LOBE_HALF_WIDTH = pi / 6
"""φ0: torque enters over ±30° about each end of the major axis (docs/contract.md)."""
TAIL_SHARE = 0.1
"""Harmonics are added until the rest is below this share of the wanted width of the bounds. Judgement."""
MOST_HARMONICS = 200
"""Most even harmonics; it only ends the loop. The load falls as 1/n³, and cups and hats need about 20."""
LOBE_BULK = 0.6
"""Share of the estimated error in the triangles that are refined (Dörfler, SINUM 33 (1996) 1106-1124)."""
LOBE_TWICE_SHARE = 0.45
"""Share of that error in the triangles that are refined twice a round. Two meshes then suffice instead of
three, in 0.85 of the time (12 cups, bounds 1 % apart, K within 0.23 % of before)."""
MOST_TRIANGLES_WITHIN = 6_000
"""Most triangles of a third or later mesh that is fine in a box: some twenty harmonics take 1.5 s."""
ERROR_SCALES = (2.7, 4.0)
"""Range of true over estimated error that is accepted from two meshes. With one mesh it is the upper end. The
bounds hold up to twice that. Of 85 random cups and hats with two meshes it was 2.2 to 2.7 for half of them,
3.7 at most; one of another hundred had 5.0, where the meshes claimed 2.3."""


@dataclass(frozen=True)
class LobeSolution:
    """All harmonics on one mesh, for LOBE_TORQUE_NMM.

    Attributes
    ----------
    energies : strain energy of n = 0, 2, 4, … [N·mm].
    amplitudes : (count, 3) of each [mm].
    work : torque's work T·Θ over all harmonics [N·mm], twice the energy if all is well.
    tail : bound of what the harmonics left out would add [N·mm].
    error : (m,) estimated error of twice the energy in each triangle [N·mm].
    unknowns, residual : of the largest system, and the worst.
    """

    energies: tuple[float, ...]
    amplitudes: tuple[np.ndarray, ...]
    work: float
    tail: float
    error: np.ndarray
    unknowns: int
    residual: float

    @property
    def K(self) -> float:
        """T²/(2·energy) [N·m/rad]."""
        return stiffness_of_work(2 * sum(self.energies))

    @property
    def estimate(self) -> float:
        """Relative error of the energy by the recovery estimate."""
        return float(self.error.sum()) / (2 * sum(self.energies))


def lobe_coefficient(n: int) -> float:
    """Return t_n of two bumps of height 1, n even: 1/π ∫ t cos nφ dφ, half of it for n = 0.

    One bump's integral is p² sin nφ0 / (n (p² - n²)) with p = π/φ0; φ0 for n = 0, φ0/2 for n = p.
    """
    p = pi / LOBE_HALF_WIDTH
    if n == 0:
        return LOBE_HALF_WIDTH / pi
    if abs(n - p) < 1e-9:  # n = p, but for the rounding of π
        return LOBE_HALF_WIDTH / pi
    return 2 / pi * p**2 * sin(n * LOBE_HALF_WIDTH) / (n * (p**2 - n**2))


def lobe_traction(model: HarmonicModel) -> float:
    """Return the height t0 [MPa] of the bumps for LOBE_TORQUE_NMM.

    The torque of a traction t0·t(φ) is t0 R² width ∫ t dφ = t0 R² width 2 φ0.
    """
    r, z = model.space.places[model.on("mesh")].T
    return float(LOBE_TORQUE_NMM / (r[0] ** 2 * np.ptp(z) * 2 * LOBE_HALF_WIDTH))


def lobe_harmonic(n: int) -> Harmonic:
    """Return the load's harmonic n; for n = 0 it is torsion."""
    return Harmonic(n, torsion=n == 0)


@dataclass(frozen=True)
class SolvedLobes:
    """The harmonics n = 0, 2, 4, … of the lobe load, LOBE_TORQUE_NMM, on the finest mesh.

    u_r = −U sin nφ, u_θ = V cos nφ, u_z = −W sin nφ of `amplitudes`, (count, 3) each [mm].
    """

    space: Space
    amplitudes: tuple[np.ndarray, ...]


def solved_lobes(
    outline: Meridian,
    material: Elastic,
    supported: bool,
    relative_width: float,
    boxes: Sequence[Box],
    deadline: Deadline = NO_DEADLINE,
) -> Iterator[SolvedLobes]:
    """Yield the lobes' fields on meshes that become finer and finer in boxes.

    As of `torsion.solved_torsions`.

    Raises
    ------
    MeshingError, HarmonicError, OutOfTimeError
    """
    lobes, mesh = _RevolvedLobes(material, supported, relative_width), triangulate(outline)
    for _ in finer_in_boxes(lobes, mesh, boxes, deadline, MOST_TRIANGLES_WITHIN):
        yield SolvedLobes(lobes.space, lobes.solution.amplitudes)


def lobe_stiffnesses(
    outline: Meridian,
    material: Elastic,
    supported: bool,
    relative_width: float,
    deadline: Deadline = NO_DEADLINE,
) -> Iterator[Stiffness]:
    """Yield K_b under the lobe load for each mesh.

    `supported`: the seat may not move radially, else it is free.

    `relative_width` is the wanted (upper - lower)/K as a fraction. A given load stores too little
    energy in too few unknowns and harmonics, so K_h is an upper bound (but for the fillets, which
    quadratic edges follow closely, not exactly). The lower one is an estimate: twice the recovery
    error, scaled by what the last two meshes say of it, and the bound on missing harmonics. Where a
    mesh fails, is too large or would end after the deadline, the answer is that of the meshes before,
    and `shortfall` says why.

    Raises
    ------
    MeshingError, HarmonicError, OutOfTimeError : of the first mesh.
    """
    lobes = _RevolvedLobes(material, supported, relative_width)
    for shortfall in refinements(lobes, triangulate(outline), deadline, MOST_TRIANGLES):
        yield lobes.stiffness(shortfall)


class _RevolvedLobes:
    """What the finest mesh gave, and how far off its K is."""

    def __init__(self, material: Elastic, supported: bool, relative_width: float) -> None:
        self._material, self._supported, self._relative_width = material, supported, relative_width
        self.estimate = ScaledEstimate(ERROR_SCALES[1], ERROR_SCALES)

    def solve(self, mesh: MeridianMesh) -> None:
        model = HarmonicModel(mesh, self._material)
        self.solution = solve_lobes(model, self._supported, TAIL_SHARE * self._relative_width)
        self.space, self.mesh = model.space, mesh
        result = MeshResult(_level(model, self.solution), self.solution.estimate)
        self.estimate = self.estimate.with_mesh(result)

    @property
    def missing(self) -> float:
        """Relative error of K by the harmonics left out."""
        return self.solution.tail / sum(self.solution.energies)

    @property
    def met(self) -> bool:
        doubt = 2 * self.estimate.relative + self.missing
        return len(self.estimate.meshes) > 1 and doubt < self._relative_width

    def stiffness(self, shortfall: Shortfall) -> Stiffness:
        """K between its bounds."""
        bounds, missing = self.estimate.at_given_torque(self.missing), self.missing
        last = 2 * (len(self.solution.energies) - 1)
        method = (
            f"even Fourier harmonics 0 to {last}, all others change K by less than {percent(missing)}; "
            f"recovery estimate (Zienkiewicz-Zhu) on {len(self.estimate.meshes)} meshes, "
            f"scaled by {self.estimate.scale:.2f}"
        )
        harmonics = tuple(energy / sum(self.solution.energies) for energy in self.solution.energies)
        K = self.estimate.stiffness(bounds, "axisymmetric", "body of revolution", method, shortfall)
        return replace(K, harmonics=harmonics)

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        error = self.solution.error
        shares = (LOBE_BULK, LOBE_TWICE_SHARE)
        return refined_repeatedly(mesh, [bulk(error, share) for share in shares])


def solve_lobes(
    model: HarmonicModel, supported: bool, tail: float, held: tuple[str, ...] = ("mount",)
) -> LobeSolution:
    """Add even harmonics until the rest cannot add more than `tail` of the energy; `held`: patches."""
    peak = lobe_traction(model)
    square = 2 * 3 / 4 * LOBE_HALF_WIDTH / pi  # Σ t_n² over n > 0, + 2 t_0²: 1/π ∫ t² of two bumps
    left = square - 2 * lobe_coefficient(0) ** 2
    energies: list[float] = []
    amplitudes: list[np.ndarray] = []
    error = np.zeros(len(model.mesh.triangles))
    worst, unknowns, work = 0.0, 0, 0.0
    for n in range(0, 2 * MOST_HARMONICS, 2):
        wave = lobe_harmonic(n)
        coefficient = lobe_coefficient(n)
        load = peak * model.pressed("mesh", TANGENTIAL, wave)
        fixed = [f for patch in held for f in model.held(patch)]
        if supported:
            fixed.append(Fixed(model.on("seat"), RADIAL))
        solved = model.solve(wave, fixed, load)
        compliance = solved.twice_energy / 2
        energies.append(compliance * coefficient**2)
        amplitudes.append(coefficient * solved.values.reshape(-1, 3))
        work += solved.work * coefficient**2
        error += recovered(model, wave, solved.values).error * coefficient**2
        worst, unknowns = max(worst, solved.residual), max(unknowns, solved.unknowns)
        left -= coefficient**2 if n else 0.0
        rest = compliance * max(left, 0.0)
        # the compliance falls by up to 10⁴ from n = 2 to 8, slowly beyond: from there it bounds the rest
        if n >= 8 and rest < tail * sum(energies):
            break
    return LobeSolution(tuple(energies), tuple(amplitudes), work, rest, error, unknowns, worst)


def _level(model: HarmonicModel, solution: LobeSolution) -> MeshLevel:
    return MeshLevel(
        shortest_edge_mm=model.mesh.shortest_edge_mm,
        elements=model.mesh.elements,
        dofs=solution.unknowns,
        K_Nm_per_rad=solution.K,
        K_check_Nm_per_rad=stiffness_of_work(solution.work),
        residual=solution.residual,
    )
