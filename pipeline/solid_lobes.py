"""The lobe cases of a flexspline with bolt holes: which solid meshes they are solved on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from flexspline.fea.errors import SolidError, TooManyElementsError
from flexspline.fea.solid.field_solver import FULL_SCALES
from flexspline.fea.solid.lobe_field import FullLobes, LobeSolver
from flexspline.fea.solid.lobes import finer_mesh, lobe_stiffness
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.types import Stiffness, TetMesh
from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline.part_meshes import PartMeshes
from flexspline.pipeline.part_stiffness import rim_mesh, twisted_part
from flexspline.pipeline.parts import PartModel, is_lasting
from flexspline.pipeline.rim_size import copies_in_rim, most_in_sector
from flexspline.pipeline.solid_torsion import SOLID_SECONDS

MOST_LOBE_ELEMENTS = 100_000
"""Of the quarter or half: 450 000 unknowns. On a thick hat 89 928 took 18 s of the processor for each of the
two cases, and gave ± 0.05 % where 0.1 % was asked."""
MESHES = 3
"""Made for the case at most."""
USUAL_OVER_TORSION = 1.8
"""Relative bounds of K of a held rim over those of torsion on the same mesh: 0.9, 1.6, 1.8, 2.1, 3.1 on five
random cups and hats."""
COARSE_SCALE = 3.1
"""True over estimated error of a free rim on steps of 10°: 2.1 to 4.4 on four parts; the bounds hold up to
twice this."""


def solid_lobes(flexspline: PartModel, supported: bool) -> Stiffness:
    """Return K_b under the lobe load by the solid model alone; `supported`: the seat may not move radially.

    A rim that is held deforms as in torsion, and is solved on that mesh first where that promises the
    tolerance; else, and where it is free, it begins with a mesh of its own. A part that is not swept has the
    torsion mesh alone.

    Raises
    ------
    ComputationError, MemoryError
    """
    field = FullLobes(flexspline.material, supported)
    return on_meshes("lobes", flexspline, field, lobe_meshes(flexspline, supported))


def on_meshes(
    kept_as: str,
    flexspline: PartModel,
    field: LobeSolver,
    meshes: Iterator[tuple[TetMesh, float]],
) -> Stiffness:
    """Return K_b by a field on the meshes of `lobe_meshes`, cached under that name.

    Raises
    ------
    ComputationError, MemoryError : of the first mesh.
    """
    context = flexspline.context

    def make() -> Stiffness:
        with context.progress.stage("lobes" if field.supported else "lobes, rim unsupported"):
            return lobe_stiffness(
                meshes,
                field,
                flexspline.tolerance,
                sector_of(flexspline.part, "lobes").label,
                lambda text: context.progress.note(f"  {text}"),
                SOLID_SECONDS,
            )

    inputs: dict[str, Any] = {**flexspline.torsion_key, "supported": field.supported}
    return context.cache.get(kept_as, inputs, make, is_lasting)[0]


def lobe_meshes(flexspline: PartModel, supported: bool) -> Iterator[tuple[TetMesh, float]]:
    """Yield at least one mesh of half a repeat, coarse to fine, each with its scale of the error estimate.

    Raises
    ------
    SolidError : the next one would be too large, or fails a check; or as `solid_lobes`.
    """
    numbers = range(MESHES if flexspline.is_swept else 0)
    begins = not numbers or (supported and _usual_of_held(flexspline) <= flexspline.tolerance)
    if begins:
        yield _of_torsion(flexspline, supported)
    for number in numbers:
        try:
            mesh = _numbered_mesh(flexspline, number)
        except SolidError:
            if number == 0 and not begins:
                yield _of_torsion(flexspline, supported)
            raise
        yield mesh, FULL_SCALES.usual


def _usual_of_held(flexspline: PartModel) -> float:
    """Relative bounds ± that a held rim usually has on the mesh of `rim_mesh`; that mesh is made for it."""
    torsion, elements = twisted_part(flexspline).stiffness, rim_mesh(flexspline).mesh.elements
    level = max((m for m in torsion.levels if m.elements <= elements), default=torsion.levels[0],
                key=lambda m: m.elements)  # fmt: skip
    return USUAL_OVER_TORSION * (level.K_Nm_per_rad / torsion.K_Nm_per_rad - 1)


def _of_torsion(flexspline: PartModel, supported: bool) -> tuple[TetMesh, float]:
    """The mesh of torsion with its scale."""
    scale = twisted_part(flexspline).stiffness.error_scale if supported else COARSE_SCALE
    return rim_mesh(flexspline).mesh, scale


def _numbered_mesh(flexspline: PartModel, number: int) -> TetMesh:
    f, material = flexspline.context.design.flexspline, flexspline.material
    finer = finer_mesh(f.wall_thickness_mm, f.inner_radius, material, flexspline.tolerance, number)
    spec = first_rim_spec(flexspline) if number == 0 else flexspline.first_spec
    return swept_rim(flexspline, spec, finer)


def first_rim_spec(flexspline: PartModel) -> MeshSpec:
    """Return the first rim mesh's specification, of `most_in_sector` elements where it may be coarser."""
    return PartMeshes(flexspline).coarsened(most_in_sector(flexspline))


def swept_rim(flexspline: PartModel, spec: MeshSpec, finer: Finer | None = None) -> TetMesh:
    """Return a swept mesh of half a repeat.

    Raises
    ------
    SolidError : it would be larger than MOST_LOBE_ELEMENTS, or fails a check.
    """
    copies = copies_in_rim(flexspline)
    try:
        swept = PartMeshes(flexspline).swept(spec, finer, MOST_LOBE_ELEMENTS / copies)
    except TooManyElementsError as fault:
        raise SolidError(
            f"it would have {fault.elements * copies:.0f} elements, at most {MOST_LOBE_ELEMENTS}"
        ) from None
    if swept is None:
        raise SolidError("the swept mesh fails a check")
    return swept.mesh
