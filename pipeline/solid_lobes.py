"""The lobe cases of a flexspline with bolt holes: which solid meshes they are solved on."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import Any

from flexspline.fea.errors import NoBetterMeshError, SolidError, TooManyElementsError
from flexspline.fea.solid.lobes import finer_mesh, lobe_stiffness, promised
from flexspline.fea.solid.stiffness import USUAL_ERROR_SCALE
from flexspline.fea.types import Stiffness, TetMesh
from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline.part_meshes import PartMeshes
from flexspline.pipeline.part_stiffness import rim_mesh, twisted_part
from flexspline.pipeline.parts import PartModel, is_lasting
from flexspline.pipeline.solid_torsion import RIM_ELEMENTS, SOLID_SECONDS, copies_in_rim

MOST_LOBE_ELEMENTS = 100_000
"""Of the quarter or half: 450 000 unknowns. On a thick hat 89 928 took 18 s of the processor for each of the
two cases, and gave ± 0.05 % where 0.1 % was asked."""
COARSER_MESH = -1
"""Number of the mesh of its own that is tried where the first one, 0, would have more elements."""
WORTH_SHARE = 0.65
"""Of the bounds that are there already: what a mesh of its own that cannot meet the tolerance must promise.
Two of 91 512 and 95 370 elements, 20 and 30 s of the processor, promised ± 0.23 % where ± 0.32 and 0.13 %
were known, and gave ± 0.62 and 0.19 %. Torsion's mesh is there and takes 4 s: it need only promise what
is known. One promised ± 0.17 % where ± 0.23 % was known, and gave ± 0.26 %."""
SMALL_ELEMENTS = 10_000
"""Of the quarter or half, which are solved whatever bounds are expected, in 0.7 s. A hat whose ring stands
on its flange was known to ± 10 % in torsion, whose error is in the corner of the turned ring, to ± 1.75 % by
that, and to ± 0.40 % by 6 672 elements under the lobes, of which ± 23 % were expected."""
MESHES = 3
"""Made for the case at most."""
USUAL_OVER_TORSION = 1.8
"""Relative bounds of K of a held rim over those of torsion on the same mesh: 0.9, 1.6, 1.8, 2.1, 3.1 on five
random cups and hats."""
USUAL_OF_FREE = 0.035
"""Those of a free rim on torsion's mesh, whatever torsion's are: ± 1.5, 3.5 and 4.1 % on three of them."""
COARSE_SCALE = 3.1
"""True over estimated error of a free rim on steps of 10°: 2.1 to 4.4 on four parts; the bounds hold up to
twice this."""


def solid_lobes(flexspline: PartModel, supported: bool, known: float = inf) -> Stiffness:
    """K_b under the lobe load; `supported`: the seat may not move radially, else it is free.

    A rim that is held deforms as in torsion, and is solved on that mesh first where that promises the
    tolerance; else, and where it is free, it begins with a mesh of its own. A part that is not swept has the
    torsion mesh alone. `known`: relative half-width of bounds that are there already.

    Raises
    ------
    NoBetterMeshError : the torsion mesh is all there is, and it is not worth its solve.
    ComputationError, MemoryError
    """
    context = flexspline.context
    sector = sector_of(flexspline.part, "lobes")

    def make() -> Stiffness:
        with context.progress.stage("lobes" if supported else "lobes, rim unsupported"):
            return lobe_stiffness(
                lobe_meshes(flexspline, supported, known),
                flexspline.material,
                supported,
                flexspline.tolerance,
                sector.label,
                lambda text: context.progress.note(f"  {text}"),
                SOLID_SECONDS,
            )

    inputs: dict[str, Any] = {**flexspline.torsion_key, "supported": supported, "known": known}
    return context.cache.get("lobes", inputs, make, is_lasting)[0]


def lobe_meshes(
    flexspline: PartModel, supported: bool, known: float
) -> Iterator[tuple[TetMesh, float]]:
    """Coarse to fine, of half a repeat, at least one; each with its scale of the error estimate.

    Raises
    ------
    SolidError : the next one would be too large, or fails a check; or as `solid_lobes`.
    """
    own = range(MESHES if flexspline.is_swept else 0)
    begins = not own or (supported and _usual_of_held(flexspline) <= flexspline.tolerance)
    if begins:
        yield _of_torsion(flexspline, supported, inf if own else known)
    for number in own:
        try:
            mesh = _own(flexspline, number, begins, known)
        except SolidError as fault:
            if number == 0 and not begins:
                expected = fault.expected if isinstance(fault, NoBetterMeshError) else inf
                yield _of_torsion(flexspline, supported, known, expected)
            raise
        yield mesh, USUAL_ERROR_SCALE


def _usual_of_held(flexspline: PartModel) -> float:
    """Relative bounds ± that a held rim usually has on the mesh of `rim_mesh`; that mesh is made for it."""
    found, elements = twisted_part(flexspline).stiffness, rim_mesh(flexspline).mesh.elements
    level = max((m for m in found.levels if m.elements <= elements), default=found.levels[0],
                key=lambda m: m.elements)  # fmt: skip
    return USUAL_OVER_TORSION * (level.K_Nm_per_rad / found.K_Nm_per_rad - 1)


def _of_torsion(
    flexspline: PartModel, supported: bool, known: float, other: float = inf
) -> tuple[TetMesh, float]:
    """The mesh of torsion with its scale; `other`: bounds expected of one that was not worth its solve."""
    usual = _usual_of_held(flexspline) if supported else USUAL_OF_FREE
    if usual > max(flexspline.tolerance, known) and not _is_small(flexspline):
        raise NoBetterMeshError(min(usual, other), known)
    twisted = twisted_part(flexspline)
    scale = twisted.stiffness.error_scale if supported else COARSE_SCALE
    return rim_mesh(flexspline).mesh, scale


def _is_small(flexspline: PartModel) -> bool:
    """Whether the torsion mesh, of a part that is swept, takes less than a guess at its bounds is worth."""
    if not flexspline.is_swept:
        return False
    return rim_mesh(flexspline).mesh.elements * copies_in_rim(flexspline) <= SMALL_ELEMENTS


def _own(flexspline: PartModel, number: int, begun: bool, known: float) -> TetMesh:
    """The mesh of that number; the first of all may be coarser, where it promises enough.

    Raises
    ------
    SolidError : as `lobe_meshes`.
    """
    expected = promised(flexspline.tolerance, COARSER_MESH)
    first, worth = number == 0 and not begun, expected <= WORTH_SHARE * known
    for tried in (number, COARSER_MESH) if first and worth else (number,):
        try:
            return _numbered_mesh(flexspline, tried)
        except TooManyElementsError as fault:
            elements = fault.elements
    if first and not worth:
        raise NoBetterMeshError(expected, known)
    raise SolidError(f"it would have {elements:.0f} elements, at most {MOST_LOBE_ELEMENTS}")


def _numbered_mesh(flexspline: PartModel, number: int) -> TetMesh:
    f, material = flexspline.context.design.flexspline, flexspline.material
    finer = finer_mesh(f.wall_thickness_mm, f.inner_radius, material, flexspline.tolerance, number)
    meshes, spec = PartMeshes(flexspline), flexspline.first_spec
    if number <= 0:
        spec = meshes.coarsened(RIM_ELEMENTS / copies_in_rim(flexspline))
    copies = copies_in_rim(flexspline)
    try:
        swept = meshes.swept(spec, finer, MOST_LOBE_ELEMENTS / copies)
    except TooManyElementsError as fault:
        raise TooManyElementsError(fault.elements * copies, MOST_LOBE_ELEMENTS) from None
    if swept is None:
        raise SolidError("the swept mesh fails a check")
    return swept.mesh
