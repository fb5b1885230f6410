"""Displacement and stress of a part under the design's torque, and the peak that counts."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import replace

from flexspline.fea.axisymmetric.field_at_points import FieldAtPoints
from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import torsion_stress
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.solid.load_cases import torsion_change
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.peak import stress_field
from flexspline.fea.solid.superposed_stress import FieldWithoutCuts
from flexspline.fea.types import MET, Shortfall, SolidField, TetMesh
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import Meridian
from flexspline.geometry.percent import percent
from flexspline.pipeline.part_stiffness import turned_field, twisted_part
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.peak_with_holes import (
    BodyLoad,
    body_peak,
    peak_by_two_bodies,
    peak_tolerance,
)
from flexspline.pipeline.solid_torsion import TwistedPart
from flexspline.pipeline.superposed_peak import Change, Superposition
from flexspline.pipeline.unfilleted_shaft import FILLETS, marked_unfilleted
from flexspline.pipeline.wave_generator import sharp_edges

WHOLE_FIELD = Shortfall(
    "it is of the whole field on the mesh that gave K, where such peaks were up to a fifth off"
)


def torque_field(model: PartModel) -> SolidField:
    """Return displacement and stress under the torque T_L, with the peak of the model that answers.

    That of a flexspline with bolt holes is told by two bodies of revolution where these agree: a solid mesh's
    nodes beside the edge of the held face, where it often is, were up to a fifth off.

    Raises
    ------
    DesignError
    ComputationError, MemoryError : the solve failed.
    """
    twisted = twisted_part(model)
    superposed = _superposed(model, twisted)
    solved = superposed or _of_mesh(model, twisted)
    if model.axisymmetric:
        left_out = FILLETS if twisted.without_fillets else ""
        return replace(solved, peak=body_peak(model, _load(model)), left_out=left_out)
    if model.name == "flexspline":
        agreed = peak_by_two_bodies(model, _load(model), lambda: solved)
        if agreed is not None and agreed.stands_for:
            return replace(solved, peak=agreed)
    if superposed is None:
        shortfall = twisted.stiffness.shortfall or _of_one_mesh(twisted, model.tolerance)
        solved = replace(solved, peak=replace(solved.peak, shortfall=shortfall))
    return marked_unfilleted(solved) if twisted.without_fillets else solved


def _of_mesh(model: PartModel, twisted: TwistedPart) -> SolidField:
    """Return the field that the finest mesh has of the whole load; errors as `turned_field`."""
    torque, turned = model.context.design.load.torque_Nm, turned_field(model, twisted)
    with _stage(model):
        return stress_field(
            twisted.meshed.mesh,
            turned.displacement * (torque / turned.K_Nm_per_rad),
            model.material,
            _title(model),
            sharp_edges(model, twisted.meshed),
        )


def _superposed(model: PartModel, twisted: TwistedPart) -> SolidField | None:
    """Return the field without holes and keyway, from the meridian, plus what these change of it.

    None where K is not from that change, or the meridian was not solved.
    """
    if twisted.change is None:
        return None
    whole = replace(model, part=model.part.without_holes())
    # of 1 rad, by the K that this change of the displacement leaves
    angle = model.context.design.load.torque_Nm / twisted.stiffness.levels[-1].K_Nm_per_rad
    known, first = twisted.change * angle, twisted.meshed.mesh
    with _stage(model):
        try:
            without = FieldAtPoints(
                _load(whole).solve(whole.part.meridian, Deadline(STAGE_SECONDS))
            )
            times = angle / without.turn

            def change(mesh: TetMesh) -> Change:
                if mesh is first:
                    return Change(mesh, known)
                solid = Model.of(mesh, model.material)
                moved = torsion_change(solid, model.part.driven, model.part, without)
                return Change(mesh, moved * times)

            return Superposition(
                model, _title(model), FieldWithoutCuts.of(without, times), twisted.meshed, 1, change
            ).field()
        except ComputationError as fault:
            model.context.progress.note(f"  {model.name}: not solved without its cuts, {fault}")
            return None


def _stage(model: PartModel) -> AbstractContextManager[None]:
    return model.context.progress.stage(f"stress of the {model.name} under torque")


def _title(model: PartModel) -> str:
    return f"{model.name} under T_L = {model.context.design.load.torque_Nm:g} N·m"


def _load(model: PartModel) -> BodyLoad:
    torque, exclusion_mm = model.context.design.load.torque_Nm, model.part.exclusion_mm
    material, driven = model.material, model.part.driven
    tolerance = peak_tolerance(model.tolerance)

    def solve(outline: Meridian, deadline: Deadline) -> RevolvedField:
        return torsion_stress(outline, material, driven, torque, exclusion_mm, tolerance, deadline)

    title = f"stress of the {model.name} under torque"
    return BodyLoad("torque_peak", title, solve, {"torque_Nm": torque})


def _of_one_mesh(twisted: TwistedPart, tolerance: float) -> Shortfall:
    """Of a mesh that knows K by the cuts' effect only, or that is refined no further since two bodies of
    revolution enclose K (`twisted_part`)."""
    if twisted.change is not None:
        return WHOLE_FIELD
    half = twisted.stiffness.half_width
    if half <= tolerance:
        return MET
    reached, wanted = percent(half), percent(tolerance)
    return Shortfall(
        f"it is computed on one mesh, whose own K is known to ± {reached} where ± {wanted} is asked"
    )
