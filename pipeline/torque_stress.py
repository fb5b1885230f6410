"""Displacement and stress of a part under the design's torque, and the peak that counts."""

from __future__ import annotations

from dataclasses import replace

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import torsion_stress
from flexspline.fea.deadline import Deadline
from flexspline.fea.solid.peak import stress_field
from flexspline.fea.types import MET, Shortfall, SolidField
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
from flexspline.pipeline.unfilleted_shaft import FILLETS, marked_unfilleted
from flexspline.pipeline.wave_generator import sharp_edges


def torque_field(model: PartModel) -> SolidField:
    """Return displacement and stress under the torque T_L, with the peak of the model that answers.

    That of a flexspline with bolt holes is told by two bodies of revolution where these agree: a solid mesh's
    nodes beside the edge of the held face, where it often is, were up to a fifth off.

    Raises
    ------
    DesignError
    ComputationError, MemoryError : the solve failed.
    """
    torque = model.context.design.load.torque_Nm
    twisted = twisted_part(model)
    turned = turned_field(model, twisted)
    with model.context.progress.stage(f"stress of the {model.name} under torque"):
        solved = stress_field(
            twisted.meshed.mesh,
            turned.displacement * (torque / turned.K_Nm_per_rad),
            model.material,
            f"{model.name} under T_L = {torque:g} N·m",
            sharp_edges(model, twisted.meshed),
        )
    if model.axisymmetric:
        left_out = FILLETS if twisted.without_fillets else ""
        return replace(solved, peak=body_peak(model, _load(model)), left_out=left_out)
    if model.name == "flexspline":
        agreed = peak_by_two_bodies(model, _load(model), lambda: solved)
        if agreed is not None and agreed.stands_for:
            return replace(solved, peak=agreed)
    shortfall = twisted.stiffness.shortfall or _of_one_mesh(twisted, model.tolerance)
    solved = replace(solved, peak=replace(solved.peak, shortfall=shortfall))
    return marked_unfilleted(solved) if twisted.without_fillets else solved


def _load(model: PartModel) -> BodyLoad:
    torque, exclusion_mm = model.context.design.load.torque_Nm, model.part.exclusion_mm
    material, driven = model.material, model.part.driven
    tolerance = peak_tolerance(model.tolerance)

    def solve(outline: Meridian, deadline: Deadline) -> RevolvedField:
        return torsion_stress(outline, material, driven, torque, exclusion_mm, tolerance, deadline)

    title = f"stress of the {model.name} under torque"
    return BodyLoad("torque_peak", title, solve, {"torque_Nm": torque})


def _of_one_mesh(twisted: TwistedPart, tolerance: float) -> Shortfall:
    """Of a mesh that is refined no further since two bodies of revolution enclose K (`twisted_part`)."""
    half = twisted.stiffness.half_width
    if half <= tolerance:
        return MET
    reached, wanted = percent(half), percent(tolerance)
    return Shortfall(
        f"it is computed on one mesh, whose own K is known to ± {reached} where ± {wanted} is asked"
    )
