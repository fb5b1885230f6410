"""Torsional stiffness of a part, by the model that its shape and `solver.model` ask for."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import inf

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.tetwild import MESHER_SECONDS
from flexspline.fea.types import Stiffness
from flexspline.pipeline.drawn_teeth import of_toothed
from flexspline.pipeline.enclosed_part import bodies_if_any, bodies_of, enclosure_of, may_answer
from flexspline.pipeline.enclosure import answered_within, check_against, overlap, proven_by
from flexspline.pipeline.part_meshes import MeshedPart, PartMeshes
from flexspline.pipeline.parts import PartModel, is_lasting
from flexspline.pipeline.rim_size import most_in_sector
from flexspline.pipeline.solid_torsion import (
    SECOND_SECONDS,
    TurnedField,
    TwistedPart,
    slow_to_confirm,
    twisted,
)
from flexspline.pipeline.unfilleted_shaft import may_leave_fillets_out, twisted_shaft


def part_stiffness(model: PartModel) -> Stiffness:
    """Return K by the design's `solver.model`: axisymmetric where the part allows it, else solid.

    A flexspline with bolt holes lies between two bodies of revolution: the solid model's K is held
    within them, or, with `solver.model = "solid"`, only checked against them. Nobody waits for a mesh that is
    `slow_to_confirm` where the two meet the tolerance, unless `solver.mesher` names one: then the answer is
    theirs.

    Raises
    ------
    DesignError : as `PartModel.axisymmetric` and `PartModel.is_swept`.
    NestingError : the solid model's K lies outside.
    ComputationError, MemoryError : of the first mesh.
    """
    K = revolved_stiffness(model) if model.axisymmetric else _solid_stiffness(model)
    return of_toothed(K) if model.toothed else K


def revolved_stiffness(model: PartModel) -> Stiffness:
    """Return K in torsion of a body of revolution, with its bounds; it goes through the cache.

    Raises
    ------
    ComputationError : the mesh failed.
    """
    part = model.part

    def make() -> Stiffness:
        with model.context.progress.stage(f"axisymmetric bounds of the {model.name}"):
            return torsional_stiffness(
                part.meridian,
                model.material,
                part.driven,
                model.tolerance,
                Deadline(STAGE_SECONDS),
            )

    return model.context.cache.get("axisymmetric", model.revolved_key, make, is_lasting)[0]


def torsion_enclosure(model: PartModel) -> Stiffness | None:
    """Return the enclosure in torsion, if any; its bodies take 0.1 s each. It raises NestingError."""
    bodies = bodies_if_any(model, partial(bodies_of, solve=revolved_stiffness))
    return None if bodies is None else enclosure_of(model, bodies)


def _solid_stiffness(model: PartModel) -> Stiffness:
    enclosure = torsion_enclosure(model)
    if enclosure is not None and may_answer(model):
        tolerance = model.tolerance
        met = enclosure.half_width <= tolerance
        if met and model.mesher == "auto" and slow_to_confirm(model):
            return enclosure
        return answered_within(enclosure, lambda: twisted_part(model).stiffness, tolerance)
    solid = twisted_part(model).stiffness
    if enclosure is not None:
        check_against(solid, enclosure)
        return replace(solid, proven_Nm_per_rad=proven_by(enclosure))
    return solid


def twisted_part(model: PartModel) -> TwistedPart:
    """Turn the solid model by 1 rad, refined until the tolerance is met; errors as `part_stiffness`.

    Where the enclosure meets it, one mesh is enough, unless that mesh's bounds and the enclosure are apart.
    """
    enclosure = torsion_enclosure(model) if may_answer(model) else None
    tolerance = model.tolerance
    one_mesh = enclosure is not None and enclosure.half_width <= tolerance
    second_s = MESHER_SECONDS if enclosure is None else SECOND_SECONDS

    def make() -> TwistedPart:
        with model.context.progress.stage(f"torsion of the {model.name}"):
            if one_mesh and enclosure is not None:
                solved = twisted(model, inf, second_s=second_s)
                if overlap(solved.stiffness, enclosure):
                    return solved
            if may_leave_fillets_out(model):
                return twisted_shaft(model, tolerance)
            return twisted(model, tolerance, second_s=second_s)

    key = {**model.torsion_key, "one_mesh": one_mesh}
    return model.context.cache.get("torsion", key, make, lambda made: is_lasting(made.stiffness))[0]


def turned_field(model: PartModel, twisted: TwistedPart) -> TurnedField:
    """Return the field of that part's mesh, solved now if K did not need it; errors as `part_stiffness`."""
    if twisted.turned is not None:
        return twisted.turned

    def make() -> TurnedField:
        solid = Model.of(twisted.meshed.mesh, model.material)
        return TurnedField.of(torsion(solid, model.part.driven))

    last = twisted.stiffness.levels[-1]
    key = {**model.torsion_key, "elements": last.elements, "K_Nm_per_rad": last.K_Nm_per_rad}
    with model.context.progress.stage(f"torsion of the {model.name}"):
        return model.context.cache.get("turned", key, make)[0]


def rim_mesh(model: PartModel) -> MeshedPart:
    """Return a flexspline's sector for lobes and ellipse: torsion's, or a coarser one (`most_in_sector`).

    Raises
    ------
    ComputationError, MemoryError : as `twisted_part`.
    """
    meshed, most = twisted_part(model).rim, most_in_sector(model)
    if meshed.mesh.elements <= most or not model.is_swept:
        return meshed
    meshes = PartMeshes(model)
    return meshes.meshed(meshes.coarsened(most))
