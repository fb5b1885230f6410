"""The wave generator's ellipse on a flexspline with bolt holes, by superposition."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from flexspline.fea.axisymmetric.field_at_points import FieldAtPoints
from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.solid.cyclic import half_repeat
from flexspline.fea.solid.load_cases import ellipse_correction
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.superposed_stress import FieldWithoutCuts
from flexspline.fea.solid.superposition import at_cuts
from flexspline.fea.types import SolidField, TetMesh
from flexspline.pipeline.part_stiffness import rim_mesh
from flexspline.pipeline.parts import PartModel, is_lasting
from flexspline.pipeline.peak_with_holes import peak_tolerance
from flexspline.pipeline.rim_size import copies_in_rim
from flexspline.pipeline.superposed_peak import Change, Superposition
from flexspline.pipeline.wave_generator import ellipse_title

EDGES_PER_HOLE = 2
"""Longest edges of the meridian beside a hole, in its diameter: the stress there is smooth without the hole.
Judgement."""


def superposed_ellipse(flexspline: PartModel) -> SolidField:
    """Return the field of `ellipse` on the flexspline's quarter or half, with its peak.

    Raises
    ------
    ComputationError, MemoryError : of the meridian, or of the first mesh.
    """

    def make() -> SolidField:
        meshed = rim_mesh(flexspline)
        with flexspline.context.progress.stage("wave generator"):
            without = _without_holes(flexspline)

            def change(mesh: TetMesh) -> Change:
                solid = Model.of(half_repeat(mesh), flexspline.material)
                solved = ellipse_correction(solid, flexspline.part, without)
                return Change(solved.mesh, solved.displacement)

            return Superposition(
                flexspline,
                ellipse_title(flexspline),
                FieldWithoutCuts.of(without, cuts=at_cuts(flexspline.part)),
                meshed,
                copies_in_rim(flexspline),
                change,
            ).field()

    w0 = flexspline.context.design.w0_mm
    inputs: dict[str, Any] = {**flexspline.torsion_key, "w0_mm": w0, "superposed": True}
    return flexspline.context.cache.get("ellipse", inputs, make, _is_lasting)[0]


def _without_holes(flexspline: PartModel) -> FieldAtPoints:
    whole, design = flexspline.part.without_holes(), flexspline.context.design
    boxes = tuple(
        replace(box, longest_mm=box.longest_mm / EDGES_PER_HOLE) for box in at_cuts(flexspline.part)
    )
    return FieldAtPoints(
        ellipse_stress(
            whole.meridian, flexspline.material, design.w0_mm, whole.exclusion_mm,
            peak_tolerance(flexspline.tolerance), Deadline(STAGE_SECONDS), boxes,
        )
    )  # fmt: skip


def _is_lasting(field: SolidField) -> bool:
    return is_lasting(field.peak)
