"""A solid part turned by 1 rad, on meshes of one kind, refined until its stiffness is known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain, pairwise
from math import inf
from typing import TypeGuard

import numpy as np

from flexspline.fea.axisymmetric.torsion import solved_torsions
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.errors import (
    MesherTimeError,
    MeshQualityError,
    SolidError,
    TooManyElementsError,
)
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.finer import finer_by_error
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.solved import SolvedStiffness
from flexspline.fea.solid.stiffness import MeshSequence, solid_stiffness
from flexspline.fea.solid.superposition import WholeTurned, at_cuts
from flexspline.fea.solid.tetwild import MESHER_SECONDS
from flexspline.fea.solid.torsion_field import FullTorsion, TorsionCorrection, TorsionSolver
from flexspline.fea.types import MET, Shortfall, Stiffness, TetMesh
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.mesh_words import long_solve, remedy
from flexspline.pipeline.part_meshes import (
    FIRST_ELEMENTS,
    KINDS,
    MeshedPart,
    MeshKind,
    OtherKindError,
    PartMeshes,
)
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.rim_size import fits_rim

SOLID_SECONDS = 30.0
"""Of all meshes of a part after the first: with that one and the rest of a command, a minute. Of 100 random
designs one is cut off by it: K_b ± 1.8 % in 10 s; with 60 s the same in 63 s, for a mesh not finished."""
HALVED_TIMES, HALVED_LEAST = 2.0, 1.5
"""Elements of the next mesh of a part with holes or a keyway over those of the last, and at least. Edges are
halved by the errors: a shaft with blind holes 0.1 mm from its bore was known to ± 0.73 % by a first mesh of
7 833 elements, to ± 0.26 % by 15 932. Meshes graded towards corners and patch edges gave ± 0.63, 0.61 and
0.45 % by 13 815, 18 531 and 36 108."""
HALVED_ELEMENTS = 20_000
"""Beyond so many none is made finer, whether the tolerance is met or not; the last has up to 1.5 times as
many and takes 2 to 4 s of the processor. K_e of seven random shafts at 0.1 % asked: 31 s; 42 s with 36 000
elements, one known to ± 0.142 % in place of 0.250, the others no closer. Whether the next mesh is expected
to meet the tolerance is not asked: a tighter one then ended earlier, with wider bounds."""
UNHALVED_LAST = 40_000
"""That number for any other mesh, by fTetWild or of a body of revolution: 66 024 elements took 14.6 s of the
processor."""
WHOLE_SHARE = 0.2
"""Of the tolerance, for the distance of the bounds of the part without holes: 0.1 to 0.7 s at 0.1 %. How far
off its field is at the walls is told by itself."""
COARSE_FIRST_ELEMENTS, COARSE_TOLERANCE = 8_000, 0.003
"""Of a first mesh where holes and keyway are solved alone, and the tolerance from which on it is so coarse.
Eighteen random shafts, 0.5 to 5 % asked: 39.5 s of the processor for 43.0; two of them took a mesh more. K of
`keyed-shaft`: 1.3 s for 2.3, ± 0.029 % for 0.024. At 0.1 % a mesh more is usual."""
FLEXSPLINE_FIRST_ELEMENTS = 5_000
"""Of a flexspline's first mesh, swept, where its holes are solved alone; its lobes are solved on it too. Ten
of twelve random flexsplines had fewer elements than with FIRST_ELEMENTS, K as well within its tolerance; one
of 0.1 % took a second mesh."""
LEAST_COARSE_ELEMENTS = 4_000
"""Of such a mesh: fewer leave too little for the meshes after it, each of twice as many at most. A shaft with
two holes was known to ± 0.98 % by 2 742, 5 646 and 11 341 elements, to ± 0.21 % by 10 863 and 21 799."""
CONFIRMING_ELEMENTS = 15_000
"""Of a first mesh where bodies of revolution give K within the tolerance: 2 s of the processor. A cup had
18 813, for 2.5 s; thin, wide flanges with one to three holes 39 303 and 62 940, for 7 and 11 s."""
ENCLOSED_SECONDS, FIRST_SECONDS, COARSER_FIRST = 10.0, 30.0, 4.0
"""Of fTetWild for a first mesh: where bodies of revolution give K within the tolerance and the mesh gives the
fields only, and elsewhere; and how many times as long the edges are after that. A tall cup with one large
hole took 284 s and 106 000 elements, another 100 s and 35 000 with the longer edges: where K alone is asked
for, there are none. A cup with two holes at its border took 46 s, and with the longer edges from the first
mesh on 15 s, known to ± 0.02 %."""
SECOND_SECONDS = 40.0
"""For the mesh with longer edges, where bodies of revolution give K, if not within the tolerance: a command
takes 90 s at most. A cup of two holes, 0.5 mm of land beside them and a fillet of 0.01 mm took 155 s where
the bounds of all its K were there. Where there is no other K the mesher has all its time, MESHER_SECONDS."""


@dataclass(frozen=True)
class TurnedField:
    """A mesh's displacement (n, 3) [mm] for a turn of 1 rad, and K of this field."""

    displacement: np.ndarray
    K_Nm_per_rad: float

    @classmethod
    def of(cls, solved: SolvedStiffness) -> TurnedField:
        """Return the field of a solution."""
        return cls(solved.displacement, solved.K_energy)


@dataclass(frozen=True)
class TwistedPart:
    """A solid part's stiffness; its field for a turn of 1 rad, where K needed it (else `turned_field`).

    `rim` is the finest of its meshes that is small enough for the lobe cases (`fits_rim`).
    `change` : (n, 3) what holes and keyway change of the field [mm], where that was solved alone.
    `without_fillets`: a shaft's meshes have sharp corners in place of its fillets.
    """

    stiffness: Stiffness
    meshed: MeshedPart
    turned: TurnedField | None
    rim: MeshedPart
    change: np.ndarray | None = None
    without_fillets: bool = False


def slow_to_confirm(model: PartModel) -> bool:
    """Whether fTetWild makes the first mesh, or it has more than CONFIRMING_ELEMENTS; no edges are stated.

    Raises
    ------
    DesignError : as `PartModel.is_swept`.
    """
    if model.states_edges:
        return False
    if not model.is_swept:
        return True

    def is_large() -> bool:
        try:
            PartMeshes(model, most_of_first=CONFIRMING_ELEMENTS).coarsened(FIRST_ELEMENTS)
        except TooManyElementsError:
            return True
        return False

    inputs = {**model.geometry_key, "mesher": model.mesher, "most": CONFIRMING_ELEMENTS}
    return model.context.cache.get("large_first_mesh", inputs, is_large)[0]


def twisted(
    model: PartModel,
    tolerance: float,
    kinds: tuple[MeshKind, ...] = KINDS,
    most_of_first: float = inf,
    seconds: float = SOLID_SECONDS,
    second_s: float = MESHER_SECONDS,
) -> TwistedPart:
    """Turn by 1 rad; refine until half of the bounds' distance is `tolerance`·K or `seconds` have passed.

    `second_s`: of fTetWild for a mesh with longer edges.

    Where a kind's coarse mesh passes its checks and a finer one fails, the next kind makes all instead.
    Where the first mesh fails, or fTetWild is slow, and nobody has stated its edges, they are
    COARSER_FIRST times as long; a slow machine is then the `shortfall` of what met its tolerance too. Where
    fTetWild's meshes need only tell what cuts change, they are so from the first mesh on, and as usual where
    that fails a check.

    Raises
    ------
    TooManyElementsError : the first mesh has more than `most_of_first`.
    SolidError, MemoryError : of the first mesh.
    """
    meshes = PartMeshes(model, kinds, most_of_first)
    first = _first_spec(meshes, tolerance)
    again = not model.states_edges and model.mesher != "swept"
    if again:
        limit_s = ENCLOSED_SECONDS if tolerance == inf else FIRST_SECONDS
        first = replace(first, time_limit_s=limit_s)
    begun_coarse = again and not model.is_swept and _cuts_alone(model)
    if begun_coarse:
        first = first.scaled(COARSER_FIRST)
    slow = MET
    while True:
        try:
            solved = _refined(meshes, first, tolerance, seconds)
            short = solved.stiffness.shortfall or slow
            return replace(solved, stiffness=replace(solved.stiffness, shortfall=short))
        except OtherKindError as other:
            later = kinds[kinds.index(other.kind) :] if other.kind in kinds else ()
            if not later or later == kinds:
                raise SolidError(f"a swept mesh of the {model.name} fails a check") from None
            model.context.progress.note(f"  {model.name}: all meshes are made again, {other.kind}")
            kinds, first = later, replace(model.first_spec, time_limit_s=first.time_limit_s)
            begun_coarse = False
            meshes = PartMeshes(model, kinds, most_of_first)
        except SolidError as fault:
            if not again:
                raise
            finer = begun_coarse and not isinstance(fault, MesherTimeError)
            which = "shorter" if finer else "longer"
            model.context.progress.note(f"  {model.name}: made again with {which} edges, {fault}")
            again = False
            if isinstance(fault, MesherTimeError):
                slow = Shortfall(f"{fault.reason}: the mesh has longer edges", of_the_machine=True)
            by = 1 / COARSER_FIRST if finer else COARSER_FIRST
            first = replace(first.scaled(by), time_limit_s=second_s)


def _first_spec(meshes: PartMeshes, tolerance: float) -> MeshSpec:
    """Of the first mesh; errors as of `PartMeshes.coarsened`."""
    alone = _cuts_alone(meshes.model)
    if alone and meshes.model.name == "flexspline" and meshes.model.is_swept:
        return meshes.coarsened(FLEXSPLINE_FIRST_ELEMENTS)
    if tolerance < COARSE_TOLERANCE or not alone:
        return meshes.coarsened(FIRST_ELEMENTS)
    coarse = meshes.coarsened(COARSE_FIRST_ELEMENTS)
    try:
        few = meshes.model.is_swept and meshes.meshed(coarse).mesh.elements < LEAST_COARSE_ELEMENTS
    except (SolidError, OtherKindError):  # it comes again where the mesh is asked for
        few = False
    return meshes.coarsened(FIRST_ELEMENTS) if few else coarse


def _cuts_alone(model: PartModel) -> bool:
    """Whether the meshes need only tell what holes and keyway change of the part without them.

    Not where a model is chosen by name; nor where hole and keyway are one cut, from the held face to the
    driven one: the walls tell the energy of cuts that touch one of these.
    """
    by_name = model.context.design.solver.model != "auto"
    part = model.part
    return not (by_name or part.is_revolved or part.cuts_meet)


def _field(model: PartModel, tolerance: float) -> TorsionSolver:
    """What the cuts change, where `_cuts_alone` and the part without them can be solved; else all of it."""
    full = FullTorsion(model.material, model.part.driven)
    if not _cuts_alone(model):
        return full
    part, whole = model.part, model.part.without_holes()
    width = WHOLE_SHARE * min(tolerance, model.tolerance)
    solutions = solved_torsions(
        whole.meridian, model.material, whole.driven, width, at_cuts(part), Deadline(STAGE_SECONDS)
    )
    wholes = (WholeTurned(part, finer, coarser) for coarser, finer in pairwise(solutions))
    with model.context.progress.stage(f"torsion of the {model.name} without {part.cuts}"):
        try:
            first = next(wholes)
        except (ComputationError, StopIteration) as fault:
            model.context.progress.note(
                f"  {model.name}: not solved without its {part.cuts}, {fault}"
            )
            return full
    return TorsionCorrection(full.material, full.driven, part.cuts, chain([first], wholes))


def _refined(meshes: PartMeshes, first: MeshSpec, tolerance: float, seconds: float) -> TwistedPart:
    model = meshes.model
    made: list[MeshedPart] = []

    def mesher(spec: MeshSpec) -> TetMesh:
        made.append(meshes.meshed(spec))
        if made[-1].kind != made[0].kind:
            raise OtherKindError(made[-1].kind)
        if line := long_solve(model, made[-1].mesh.elements):
            model.context.progress.note(f"  {model.name}: {line}")
        return made[-1].mesh

    def halved(mesh: TetMesh) -> TypeGuard[BisectableMesh]:
        """Whether the next mesh follows this one's errors: no specification says where holes cause them."""
        return isinstance(mesh, BisectableMesh) and not model.part.is_revolved

    def by_error(mesh: TetMesh, error: np.ndarray) -> TetMesh | None:
        if not halved(mesh):
            return None
        most = max(HALVED_LEAST * mesh.elements, HALVED_ELEMENTS)
        with model.context.progress.stage(f"mesh of the {model.name}"):
            # other edges are halved for fewer elements
            for elements in (min(HALVED_TIMES * mesh.elements, most), HALVED_LEAST * mesh.elements):
                try:
                    return finer_by_error(model.part, mesh, error, elements)
                except MeshQualityError as fault:
                    failed = fault
        if mesh is made[0].mesh:
            return None  # a finer one of its kind may be made, or another kind makes all
        raise failed

    def most(mesh: TetMesh) -> float:
        return HALVED_ELEMENTS if halved(mesh) else max(UNHALVED_LAST, mesh.elements)

    refined = solid_stiffness(
        MeshSequence(mesher, first, by_error, most),
        _field(model, tolerance),
        tolerance,
        model.sector.label,
        lambda text: model.context.progress.note(f"  {model.name}: {text}"),
        Deadline(seconds),
    )
    meshed = [replace(made[0], mesh=mesh) for mesh in refined.meshes]
    rim = max(1, sum(fits_rim(model, m.mesh.elements) for m in meshed)) - 1
    turned = None if refined.turned is None else TurnedField.of(refined.turned)
    short = refined.stiffness.shortfall
    if short:
        short = replace(short, words=f"{short}; {remedy(model)}")
    stiffness = replace(refined.stiffness, shortfall=short)
    return TwistedPart(stiffness, meshed[-1], turned, meshed[rim], refined.change)
