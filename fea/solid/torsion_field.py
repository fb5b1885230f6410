"""Torsion on a solid mesh: the whole field, or only the change caused by holes and keyway."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.errors import MeshQualityError, SolidError
from flexspline.fea.scaled_estimate import MeshResult
from flexspline.fea.solid.field_solver import (
    CORRECTION_SCALES,
    FULL_SCALES,
    ErrorScales,
    FieldSolver,
    by_correction,
    error_of,
)
from flexspline.fea.solid.load_cases import torsion, torsion_and_correction, torsion_correction
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.solved import SolvedStiffness
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.superposition import WholeTurned
from flexspline.fea.types import NMM_PER_NM, Elastic

LEAST_LEFT = 0.1
"""Least share of K without cuts that must be left. Less would be a small difference of two large numbers.
Judgement."""


class CorrectionError(SolidError):
    """The change by the cuts cannot be computed, or is nearly all of K. The whole field can be solved
    instead."""


@dataclass(frozen=True)
class TurnedMesh(MeshResult):
    """One mesh in torsion, with its elements' errors (m,); `turned`: the whole field, if it was solved.

    `change` : (n, 3) what the cuts change of the displacement for a turn of 1 rad, Cartesian [mm], if that
    was solved alone.
    """

    errors: np.ndarray = field(kw_only=True)
    turned: SolvedStiffness | None = field(default=None, kw_only=True)
    change: np.ndarray | None = field(default=None, kw_only=True)


class TorsionSolver(FieldSolver[TurnedMesh], Protocol):
    """Solves a part whose `driven` patch is turned."""

    driven: str


@dataclass
class FullTorsion:
    """Solves the whole field of a part whose `driven` patch is turned."""

    material: Elastic
    driven: str
    scales: ErrorScales = FULL_SCALES

    def solve(self, model: Model) -> TurnedMesh:
        """Solve on one mesh; raises SolidError, MemoryError."""
        solved = torsion(model, self.driven)
        error = energy_error(model.mesh, solved.displacement, self.material)
        return TurnedMesh(solved.level, error.relative, errors=error.error, turned=solved)

    def method(self, error: str) -> str:
        """As `FieldSolver.method`."""
        return f"{error}; K is that of the finest mesh minus the scaled estimate"


@dataclass
class TorsionCorrection:
    """Solves only the change by `cuts`, the holes and keyway (`fea.solid.superposition`).

    All of the field is solved on the first mesh only: it may contradict the correction. On each of the meshes
    after it, it would take as long again. `wholes` : the part without them, solved better and better, one for
    each mesh, at least one.
    """

    material: Elastic
    driven: str
    cuts: str
    wholes: Iterator[WholeTurned]
    scales: ErrorScales = CORRECTION_SCALES
    _whole: WholeTurned | None = None

    def solve(self, model: Model) -> TurnedMesh:
        """Solve on one mesh.

        Raises
        ------
        CorrectionError : the mesh has no walls, or one leaves the meridian; K is too small a difference.
        SolidError, MemoryError : of the solve.
        """
        first = self._whole is None
        self._whole = whole = next(self.wholes, self._whole)
        assert whole is not None
        turned = None
        try:
            if first:
                turned, correction = torsion_and_correction(model, self.driven, whole)
            else:
                correction = torsion_correction(model, self.driven, whole)
        except (MeshingError, MeshQualityError) as fault:
            raise CorrectionError(str(fault)) from fault
        known = whole.solved.stiffness
        K, check = (
            known.K_Nm_per_rad - lost / NMM_PER_NM
            for lost in (correction.lost, correction.lost_by_work)
        )
        if LEAST_LEFT * known.K_Nm_per_rad > K:
            raise CorrectionError(f"the effect of the {self.cuts} leaves too little of K")
        errors, whole_error = error_of(correction, self.material)
        doubt = known.width_Nm_per_rad / 2 + correction.doubt / NMM_PER_NM
        level = correction.level(K, check)
        error = whole_error / NMM_PER_NM / K
        change = correction.displacement
        return TurnedMesh(level, error, doubt / K, errors=errors, turned=turned, change=change)

    def method(self, error: str) -> str:
        """As `FieldSolver.method`."""
        return by_correction(self.cuts, error)
