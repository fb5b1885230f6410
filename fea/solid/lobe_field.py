"""The lobe load on a solid mesh: the whole field, or only the change caused by bolt holes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from flexspline.fea.lobe_torque import stiffness_of_work, work_of_stiffness
from flexspline.fea.scaled_estimate import MeshResult
from flexspline.fea.solid.field_solver import (
    CORRECTION_SCALES,
    FULL_SCALES,
    ErrorScales,
    FieldSolver,
    by_correction,
    error_of,
)
from flexspline.fea.solid.load_cases import lobe_correction, lobes
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.superposition import WholeUnderLobes
from flexspline.fea.types import Elastic

WAVES_SHARE = 0.05
"""What waves that are not solved may add to the bounds, as a share of the tolerance. On a hat with nine holes
one of five waves is then solved, in 1.7 s of the processor instead of 6.3 s."""


class LobeSolver(FieldSolver[MeshResult], Protocol):
    """Solves the lobe load; `supported`: the seat may not move radially."""

    supported: bool


@dataclass
class FullLobes:
    """Solves the whole field under the lobe load."""

    material: Elastic
    supported: bool
    scales: ErrorScales = FULL_SCALES

    def solve(self, model: Model) -> MeshResult:
        """Solve on a mesh of half a repeat; the level is that of the quarter or half."""
        solved = lobes(model, self.supported)
        error = energy_error(solved.mesh, solved.displacement, self.material)
        return MeshResult(solved.level, error.relative)

    def method(self, error: str) -> str:
        """As `FieldSolver.method`."""
        return error


@dataclass
class LobeCorrection:
    """Solves only the change by the bolt holes (`fea.solid.superposition`).

    `tolerance` : of K, relative. `wholes` : the part without its holes under the load, solved better and
    better, one for each mesh, at least one.
    """

    material: Elastic
    supported: bool
    tolerance: float
    wholes: Iterator[WholeUnderLobes]
    scales: ErrorScales = CORRECTION_SCALES
    _whole: WholeUnderLobes | None = None

    def solve(self, model: Model) -> MeshResult:
        """Solve on a mesh of half a repeat; raises MeshingError and MeshQualityError as `lobe_correction`."""
        self._whole = whole = next(self.wholes, self._whole)
        assert whole is not None
        known = whole.stiffness
        work = work_of_stiffness(known.K_Nm_per_rad)
        change = lobe_correction(model, self.supported, whole, WAVES_SHARE * self.tolerance * work)
        _, error = error_of(change, self.material)
        K, check = (stiffness_of_work(work + lost) for lost in (change.lost, change.lost_by_work))
        work += change.lost
        level = change.level(K, check)
        doubt = known.half_width + change.doubt / work
        return MeshResult(level, error / work, doubt=doubt)

    def method(self, error: str) -> str:
        """As `FieldSolver.method`."""
        return by_correction("holes", error)
