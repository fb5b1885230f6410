"""A stress field on refined meridian meshes, until its peak has converged.

The mesh is refined where the energy error is large, and where the error of a relevant stress is large.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import cos, inf, pi, sin

from flexspline.fea.axisymmetric.bisection import Box, refined_with_parents, refined_within
from flexspline.fea.axisymmetric.harmonics import Amplitudes, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.marking import MOST_TRIANGLES, bulk
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.peak import coarse_at_border, peak_stress
from flexspline.fea.axisymmetric.recovery import recovered
from flexspline.fea.axisymmetric.revolved_field import RevolvedField, StressLevel
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.refinement import refine, refinements
from flexspline.fea.stress_rule import TWICE, judged
from flexspline.fea.types import Elastic, Shortfall
from flexspline.geometry.outline import Meridian

PEAK_BULK = 0.5
"""Share of the estimated energy error in the triangles refined, beside those of LOCAL_ERROR_SHARE. Judgement:
less than `lobes.LOBE_BULK`, as the others come on top."""
LOCAL_ERROR_SHARE = 0.5
"""Triangles whose stress is off by more than this share of the tolerance are refined too. Judgement."""
BORDER_SHARE = 0.25
"""Borders of the excluded neighbourhoods are meshed finely from this share of the peak on, or of the largest
stress at twice the distance, which is told too. A coarse mesh may see too little there: stress grows at most
as distance^-1/2 towards a singular point, to four times within 16 exclusion distances, which no first
triangle exceeds by much. Of 60 random cups and hats, peaks came within 0.6 % of those to 0.1 %; with all
borders fine within 0.75 %, in 1.4 times the time."""
QUIET_ROUNDS = 2
"""Successive refinements that must leave the peak unchanged within the tolerance. A single one may have
refined other places only."""
ENERGY_SHARE = 0.5
"""The estimated energy error must be below this share of the tolerance: a thick hat's peak was 1.4 % too high
after two quiet rounds with 0.9 % of the energy in doubt."""


@dataclass(frozen=True)
class HarmonicLoad:
    """One harmonic's load case: its wave, and how it is solved on a mesh."""

    wave: Harmonic
    solve: Callable[[HarmonicModel], Amplitudes]


@dataclass(frozen=True)
class StressProblem:
    """A load on a body of revolution, and how well its peak stress is wanted.

    Attributes
    ----------
    exclusion_mm : no point nearer to a sharp corner or a patch edge counts.
    tolerance : the peak may change by no more than this fraction over QUIET_ROUNDS refinements. Where a mesh
        fails, is too large or would end after the deadline, the peak is that of the mesh before, and its
        `shortfall` says why.
    boxes : where the first mesh is finer, if its field is wanted there.
    """

    outline: Meridian
    material: Elastic
    load: HarmonicLoad
    exclusion_mm: float
    tolerance: float
    deadline: Deadline = NO_DEADLINE
    boxes: tuple[Box, ...] = ()

    def field(self) -> RevolvedField:
        """Refine until the peak is within the tolerance, and return the last field.

        Raises
        ------
        MeshingError, HarmonicError, StressError, OutOfTimeError : of the first mesh.
        """
        meshed = _MeshedField(self)
        shortfall = refine(meshed, self._first_mesh(), self.deadline, MOST_TRIANGLES)
        return meshed.field(shortfall)

    def fields(self) -> Iterator[RevolvedField]:
        """Yield the field of each mesh whose peak counts; the last one is `field`, and so are the errors."""
        meshed = _MeshedField(self)
        for shortfall in refinements(meshed, self._first_mesh(), self.deadline, MOST_TRIANGLES):
            if meshed.peaks or shortfall:
                yield meshed.field(shortfall)

    def _first_mesh(self) -> MeridianMesh:
        return refined_within(triangulate(self.outline), self.boxes)


class _MeshedField:
    """Results of the finest mesh and the figures of all meshes. A field is made only on request.

    Attributes
    ----------
    peaks : the largest stress of each mesh [MPa], but that of a first mesh with coarse borders.
    """

    def __init__(self, problem: StressProblem) -> None:
        self._problem = problem
        self._levels: list[StressLevel] = []
        self.peaks: list[float] = []

    def solve(self, mesh: MeridianMesh) -> None:
        wanted, load = self._problem, self._problem.load
        model = HarmonicModel(mesh, wanted.material)
        solved = load.solve(model)
        recovery = recovered(model, load.wave, solved.values)
        peak = peak_stress(model, recovery.nodal, wanted.exclusion_mm)
        self._model, self._solved, self._recovery, self._peak = model, solved, recovery, peak
        energy_error = float(recovery.error.sum() / recovery.energy.sum())
        self._levels.append(
            StressLevel(mesh.elements, solved.unknowns, peak.mises_MPa, energy_error)
        )
        farther = peak.largest(TWICE * wanted.exclusion_mm) or peak.mises_MPa  # as well as the peak
        loud = peak.anywhere > BORDER_SHARE * min(farther, peak.mises_MPa)
        self._coarse = loud & coarse_at_border(mesh, wanted.exclusion_mm)
        if len(self._levels) > 1 or not self._coarse.any():
            self.peaks.append(peak.mises_MPa)

    @property
    def change(self) -> float:
        """Of the peak, relative, over the last refinements."""
        if len(self.peaks) <= QUIET_ROUNDS:
            return inf
        last = self.peaks[-1 - QUIET_ROUNDS :]
        return max(last) / min(last) - 1

    @property
    def met(self) -> bool:
        tolerance = self._problem.tolerance
        energy_error = self._levels[-1].energy_error
        return (
            not self._coarse.any()
            and self.change < tolerance
            and energy_error < ENERGY_SHARE * tolerance
        )

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        recovery, peak = self._recovery, self._peak
        allowed = LOCAL_ERROR_SHARE * self._problem.tolerance * peak.mises_MPa
        wrong = peak.counted & (recovery.largest_misfit > allowed)
        # far below the peak, stresses may be a few percent off
        near = peak.local_mises > peak.mises_MPa / 2
        marked = bulk(recovery.error, PEAK_BULK) | (wrong & near) | self._coarse
        mesh, parent = refined_with_parents(mesh, marked)
        border = self._coarse[parent]
        while (still := border & coarse_at_border(mesh, self._problem.exclusion_mm)).any():
            mesh, parent = refined_with_parents(mesh, still)
            border = border[parent]
        return mesh

    def field(self, shortfall: Shortfall) -> RevolvedField:
        """The field, its peak judged: does it go on rising into the excluded zone?"""
        wave, peak, space = self._problem.load.wave, self._peak, self._model.space
        phi = pi / (2 * wave.n) if wave.n and peak.at_sine else 0.0
        r, z = peak.rz
        at = (r * cos(phi), r * sin(phi), z)
        judged_peak = judged(peak.mises_MPa, at, self._problem.exclusion_mm, peak.largest)
        return RevolvedField(
            n=wave.n,
            places=space.places,
            triangles=space.dofs,
            displacement=self._solved.values.reshape(-1, 3),
            stress=self._recovery.nodal,
            peak=replace(judged_peak, shortfall=shortfall),
            peak_rz=peak.rz,
            levels=tuple(self._levels),
        )
