"""The lobe cases of a flexspline with bolt holes: the change caused by the holes, on coarse meshes."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import pairwise

from flexspline.fea.axisymmetric.lobes import solved_lobes
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.solid.field_solver import CORRECTION_SCALES
from flexspline.fea.solid.lobe_field import LobeCorrection
from flexspline.fea.solid.superposition import WholeUnderLobes, at_cuts
from flexspline.fea.types import Stiffness, TetMesh
from flexspline.pipeline.by_harmonics import rim_by_harmonics
from flexspline.pipeline.enclosed_part import without_holes
from flexspline.pipeline.part_stiffness import rim_mesh
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.rim_case import RimCase, free_rim, held_rim
from flexspline.pipeline.solid_lobes import first_rim_spec, on_meshes, swept_rim

FINER_EDGES = (0.6, 0.36)
"""Edges of the second and third mesh over those of the first: each has 4.6 times the elements before."""
FIELD_WIDTH = 4.0
"""Of the tolerance, for the bounds of K by the harmonics whose stress is taken off the walls: how far off
these are there is told by itself (`SolvedCorrection.doubt`)."""


def lobes_with_holes(flexspline: PartModel, supported: bool) -> Stiffness:
    """Return K_b under the lobe load; `supported`: the seat may not move radially, else it is free.

    Raises
    ------
    ComputationError, MemoryError
    """
    field = LobeCorrection(
        flexspline.material, supported, flexspline.tolerance, _wholes(flexspline, supported)
    )
    return on_meshes("lobes with holes", flexspline, field, _meshes(flexspline))


def _wholes(flexspline: PartModel, supported: bool) -> Iterator[WholeUnderLobes]:
    """The part without its holes: K as the enclosure has it, its fields better and better."""
    part = flexspline.part
    case: RimCase = "lobes" if supported else "lobes_unsupported"
    solve = held_rim if supported else free_rim
    K = without_holes(flexspline, partial(rim_by_harmonics, case=case, solve=solve))
    solutions = solved_lobes(
        part.without_holes().meridian, flexspline.material, supported,
        FIELD_WIDTH * flexspline.tolerance, at_cuts(part), Deadline(STAGE_SECONDS),
    )  # fmt: skip
    for coarser, finer in pairwise(solutions):
        yield WholeUnderLobes(part, K, finer, coarser)


def _meshes(flexspline: PartModel) -> Iterator[tuple[TetMesh, float]]:
    """Coarse to fine, of half a repeat; each with its scale of the error estimate.

    Raises
    ------
    SolidError : the next one would be too large, or fails a check.
    """
    yield rim_mesh(flexspline).mesh, CORRECTION_SCALES.usual
    if not flexspline.is_swept:
        return
    first = first_rim_spec(flexspline)
    for edges in FINER_EDGES:
        yield swept_rim(flexspline, first.scaled(edges)), CORRECTION_SCALES.usual
