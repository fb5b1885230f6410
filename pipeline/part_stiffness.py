"""Torsional stiffness of a part, by the model that its shape and `solver.model` ask for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.stiffness import solid_stiffness
from flexspline.fea.types import Stiffness, TetMesh
from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline.drawn_teeth import of_toothed
from flexspline.pipeline.part_meshes import MeshedPart, PartMeshes
from flexspline.pipeline.parts import PartModel, is_lasting

RIM_ELEMENTS = 40_000
"""About 180 000 unknowns and 5 s for each of the two lobe cases."""


@dataclass(frozen=True)
class TwistedPart:
    """A solid part's stiffness and its displacement (n, 3) mm for a turn of 1 rad.

    `rim` is the finest of its meshes that, unfolded for the lobe cases, keeps within RIM_ELEMENTS.
    """

    stiffness: Stiffness
    meshed: MeshedPart
    displacement: np.ndarray
    rim: MeshedPart


def part_stiffness(model: PartModel) -> Stiffness:
    """K by the design's `solver.model`: axisymmetric where the part allows it, else solid.

    Raises
    ------
    DesignError : as `PartModel.axisymmetric` and `PartModel.is_swept`.
    ComputationError, MemoryError : of the first mesh.
    """
    if not model.axisymmetric:
        return twisted_part(model).stiffness
    found = _revolved_stiffness(model)
    return of_toothed(found) if model.toothed else found


def _revolved_stiffness(model: PartModel) -> Stiffness:
    tolerance = model.context.design.solver.tolerance_pct / 100
    part = model.part

    def make() -> Stiffness:
        with model.context.progress.stage(f"axisymmetric bounds of the {model.name}"):
            return torsional_stiffness(
                part.meridian, model.material, part.driven, tolerance, Deadline(STAGE_SECONDS)
            )

    return model.context.cache.get("axisymmetric", model.revolved_key, make, is_lasting)[0]


def twisted_part(model: PartModel) -> TwistedPart:
    """The solid model turned by 1 rad, refined until the tolerance is met; errors as `part_stiffness`."""

    def make() -> TwistedPart:
        with model.context.progress.stage(f"torsion of the {model.name}"):
            return _twisted(model)

    return model.context.cache.get(
        "torsion", model.torsion_key, make, lambda made: is_lasting(made.stiffness)
    )[0]


def _twisted(model: PartModel) -> TwistedPart:
    meshes = PartMeshes(model)
    edges: list[np.ndarray] = []

    def mesher(spec: MeshSpec) -> TetMesh:
        made = meshes.meshed(spec)
        edges.append(made.sharp_edges)
        return made.mesh

    found = solid_stiffness(
        mesher,
        model.first_spec,
        model.material,
        model.part.driven,
        model.context.design.solver.tolerance_pct / 100,
        model.sector.label,
        lambda text: model.context.progress.note(f"  {model.name}: {text}"),
    )
    meshed = [MeshedPart(mesh, edges[0]) for mesh in found.meshes]
    times = sector_of(model.part, "ellipse").degrees / model.sector.degrees
    sizes = [m.mesh.elements * times for m in meshed]
    rim = max(1, sum(size <= RIM_ELEMENTS for size in sizes)) - 1
    return TwistedPart(found.stiffness, meshed[-1], found.solved.displacement, meshed[rim])
