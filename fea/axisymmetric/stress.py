"""Peak von Mises stress under the wave generator's ellipse and under torque, on the meridian.

At sharp corners and patch edges the linear solution is singular and no stress converges; points
nearer to them than `exclusion_mm` do not count. Fillets count in full.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import (
    RADIAL,
    TANGENTIAL,
    Amplitudes,
    Fixed,
    HarmonicModel,
    Wave,
)
from flexspline.fea.axisymmetric.peak import Peak, coarse_at_border, peak_stress
from flexspline.fea.axisymmetric.recovery import Recovered, mises_parts, recovered
from flexspline.fea.axisymmetric.torsion import MOST_TRIANGLES, bulk
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline, Pace
from flexspline.fea.shortfall import largest_mesh, next_mesh_failed
from flexspline.fea.stress_rule import judged
from flexspline.fea.types import NMM_PER_NM, Elastic, StressPeak
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import Meridian

BULK = 0.5
"""Share of the estimated energy error in the triangles that are refined, beside those that LOCAL adds."""
LOCAL = 0.5
"""Triangles whose stress is off by more than this share of the wanted tolerance are refined too."""
QUIET_ROUNDS = 2
"""So many refinements in a row must leave the peak unchanged within the tolerance."""


@dataclass(frozen=True)
class StressLevel:
    """One mesh of the sequence and its peak."""

    elements: int
    unknowns: int
    mises_MPa: float
    energy_error: float
    """Estimated relative error of the strain energy."""


@dataclass(frozen=True)
class RevolvedField:
    """A solved harmonic on the finest mesh, its peak stress and how it got there.

    u_r = U cos nφ, u_θ = V sin nφ, u_z = W cos nφ; torsion is n = 0 with V alone. Stresses rr, θθ,
    zz and rz vary as cos nφ, rθ and θz as sin nφ (torsion: constant).

    Attributes
    ----------
    places : (count, 2) P2 nodes (r, z) [mm].
    triangles : (m, 6) their numbers: corners, then the middles of 01, 12, 02; any sense.
    displacement : (count, 3) amplitudes U, V, W [mm].
    stress : (count, 6) smoothed amplitudes rr, θθ, zz, rz, rθ, θz [MPa].
    peak : the largest von Mises stress that counts, Cartesian place at angle `peak_phi`.
    peak_rz : the same place on the meridian [mm].
    peak_phi : its angle [rad], the first of those with the same stress.
    peak_change : relative change of the peak over the last refinements, the estimate of its error.
    levels : the meshes.
    """

    n: int
    places: np.ndarray
    triangles: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray
    peak: StressPeak
    peak_rz: tuple[float, float]
    peak_phi: float
    peak_change: float
    levels: tuple[StressLevel, ...]

    def mises(self, phi: float) -> np.ndarray:
        """von Mises stress (count,) at the nodes at an angle [MPa]."""
        direct, shear = mises_parts(dict(enumerate(self.stress.T)))
        if self.n == 0:
            return np.sqrt(direct + shear)
        return np.sqrt(direct * np.cos(self.n * phi) ** 2 + shear * np.sin(self.n * phi) ** 2)


def ellipse_stress(
    outline: Meridian,
    material: Elastic,
    w0_mm: float,
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline = NO_DEADLINE,
) -> RevolvedField:
    """Peak stress with `mount` held and `seat` moved radially by w0 cos 2φ, otherwise free.

    `tolerance`: the peak may change by no more than this fraction over two refinements. Where a mesh
    fails, is too large or would end after the deadline, the peak is that of the mesh before, and its
    `shortfall` says why.

    Raises
    ------
    MeshingError, HarmonicError, StressError, OutOfTimeError : of the first mesh.
    """
    return _last(_ellipse(outline, material, w0_mm, exclusion_mm, tolerance, deadline))


def ellipse_refinements(
    outline: Meridian,
    material: Elastic,
    w0_mm: float,
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline = NO_DEADLINE,
) -> Iterator[RevolvedField]:
    """What `ellipse_stress` finds on each of its meshes; the last one is the answer."""
    for found in _ellipse(outline, material, w0_mm, exclusion_mm, tolerance, deadline):
        yield found.field()


def _ellipse(
    outline: Meridian,
    material: Elastic,
    w0_mm: float,
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline,
) -> Iterator[_Refined]:
    def solve(model: HarmonicModel) -> Amplitudes:
        fixed = [Fixed(model.on("seat"), RADIAL, w0_mm), *model.held("mount")]
        return model.solve(Wave(2), fixed, np.zeros(3 * model.space.count))

    return _refinements(outline, material, Wave(2), solve, exclusion_mm, tolerance, deadline)


def torsion_stress(
    outline: Meridian,
    material: Elastic,
    driven: str,
    torque_Nm: float,
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline = NO_DEADLINE,
) -> RevolvedField:
    """Peak stress with `mount` held and `driven` turned rigidly by a torque.

    Tolerance and errors are those of `ellipse_stress`.
    """

    def solve(model: HarmonicModel) -> Amplitudes:
        on = model.on(driven)
        fixed = [Fixed(on, TANGENTIAL, model.space.places[on, 0]), *model.held("mount")]
        unit = model.solve(Wave(0, torsion=True), fixed, np.zeros(3 * model.space.count))
        angle = torque_Nm * NMM_PER_NM / unit.twice_energy
        return Amplitudes(
            unit.values * angle, unit.twice_energy * angle**2, 0.0, unit.residual, unit.unknowns
        )

    wave = Wave(0, torsion=True)
    return _last(_refinements(outline, material, wave, solve, exclusion_mm, tolerance, deadline))


@dataclass(frozen=True)
class _Refined:
    """What one mesh gave; its field is made only where it is asked for."""

    model: HarmonicModel
    wave: Wave
    solved: Amplitudes
    found: Recovered
    peak: Peak
    change: float
    exclusion_mm: float
    levels: tuple[StressLevel, ...]
    shortfall: str

    def field(self) -> RevolvedField:
        """The field, its peak judged: does it go on rising into the excluded zone?"""
        wave, peak, space = self.wave, self.peak, self.model.space
        phi = pi / (2 * wave.n) if wave.n and peak.at_sine else 0.0
        r, z = peak.rz
        at = (r * cos(phi), r * sin(phi), z)
        found = judged(peak.mises_MPa, at, self.exclusion_mm, peak.largest)
        return RevolvedField(
            n=wave.n,
            places=space.places,
            triangles=space.dofs,
            displacement=self.solved.values.reshape(-1, 3),
            stress=self.found.nodal,
            peak=replace(found, shortfall=self.shortfall),
            peak_rz=peak.rz,
            peak_phi=phi,
            peak_change=self.change,
            levels=self.levels,
        )


def _last(refinements: Iterator[_Refined]) -> RevolvedField:
    for found in refinements:
        last = found
    return last.field()


def _refinements(
    outline: Meridian,
    material: Elastic,
    wave: Wave,
    solve: Callable[[HarmonicModel], Amplitudes],
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline,
) -> Iterator[_Refined]:
    """Refine where the energy is wrong, and where a stress that counts is, until neither is."""
    mesh = triangulate(outline)
    while (coarse := coarse_at_border(mesh, exclusion_mm)).any():
        mesh = refined(mesh, coarse)
    levels: list[StressLevel] = []
    last: _Refined | None = None
    pace = Pace(deadline)
    while True:
        try:
            pace.begin(len(mesh.triangles))
            model = HarmonicModel(mesh, material)
            solved = solve(model)
            found = recovered(model, wave, solved.values)
            peak = peak_stress(model, found.nodal, exclusion_mm)
        except (ComputationError, MemoryError) as fault:
            if last is None:
                raise
            yield replace(last, shortfall=next_mesh_failed(fault))
            return
        energy_error = float(found.error.sum() / found.energy.sum())
        levels.append(
            StressLevel(len(mesh.triangles), solved.unknowns, peak.mises_MPa, energy_error)
        )
        change = _change(levels)
        last = _Refined(
            model, wave, solved, found, peak, change, exclusion_mm, tuple(levels), shortfall=""
        )
        met = change < tolerance and energy_error < tolerance
        if not met and len(mesh.triangles) > MOST_TRIANGLES:
            yield replace(last, shortfall=largest_mesh(len(mesh.triangles), MOST_TRIANGLES))
            return
        yield last
        if met:
            return
        wrong = peak.counted & (found.misfit > LOCAL * tolerance * peak.mises_MPa)
        # no smaller than needed where the peak is not: those far below it may be a few percent off
        near = peak.local_mises > peak.mises_MPa / 2
        mesh = refined(mesh, bulk(found.error, BULK) | (wrong & near))


def _change(levels: list[StressLevel]) -> float:
    if len(levels) <= QUIET_ROUNDS:
        return np.inf
    last = [level.mises_MPa for level in levels[-1 - QUIET_ROUNDS :]]
    return max(last) / min(last) - 1
