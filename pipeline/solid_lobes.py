"""The lobe cases of a flexspline with bolt holes: which solid meshes they are solved on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from flexspline.fea.solid.errors import SolidError, TooManyElementsError
from flexspline.fea.solid.lobes import finer_mesh, lobe_stiffness
from flexspline.fea.solid.stiffness import USUAL_EFFICIENCY
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.types import Stiffness, TetMesh
from flexspline.geometry.symmetry import Sector, sector_of
from flexspline.pipeline.part_meshes import PartMeshes
from flexspline.pipeline.part_stiffness import (
    RIM_ELEMENTS,
    SOLID_SECONDS,
    copies_in_rim,
    rim_mesh,
    twisted_part,
)
from flexspline.pipeline.parts import PartModel, is_lasting

MOST_ELEMENTS = 100_000
"""Of the quarter or half: 450 000 unknowns, a minute."""
MESHES = 3
"""Made for the case at most."""
COARSE_SCALE = 3.1
"""True over estimated error of a free rim on steps of 10°: 2.1 to 4.4 on four parts; the bounds hold up to
twice this."""


def solid_lobes(flexspline: PartModel, supported: bool) -> Stiffness:
    """K_b under the lobe load; `supported`: the seat may not move radially, else it is free.

    A rim that is held deforms as in torsion, and is solved on that mesh first; a free one begins with a mesh
    of its own. A part that is not swept has the torsion mesh alone.

    Raises
    ------
    ComputationError, MemoryError
    """
    context = flexspline.context
    tolerance = context.design.solver.tolerance_pct / 100
    sector = sector_of(flexspline.part, "lobes")

    def make() -> Stiffness:
        with context.progress.stage("lobes" if supported else "lobes, rim unsupported"):
            return lobe_stiffness(
                _meshes(flexspline, sector, supported),
                flexspline.material,
                supported,
                tolerance,
                sector.label,
                lambda text: context.progress.note(f"  {text}"),
                SOLID_SECONDS,
            )

    inputs: dict[str, Any] = {**flexspline.torsion_key, "supported": supported}
    return context.cache.get("lobes", inputs, make, is_lasting)[0]


def _meshes(
    flexspline: PartModel, sector: Sector, supported: bool
) -> Iterator[tuple[TetMesh, float]]:
    """Coarse to fine, of the whole sector, at least one; each with its scale of the error estimate.

    Raises
    ------
    SolidError : the next one would be too large, or fails a check.
    """
    own = range(MESHES if flexspline.is_swept else 0)
    if supported or not own:
        yield _of_torsion(flexspline, sector, supported)
    for number in own:
        try:
            mesh = _finer(flexspline, sector, number)
        except SolidError:
            if number == 0 and not supported:
                yield _of_torsion(flexspline, sector, supported)
            raise
        yield mesh, USUAL_EFFICIENCY


def _of_torsion(flexspline: PartModel, sector: Sector, supported: bool) -> tuple[TetMesh, float]:
    twisted = twisted_part(flexspline)
    scale = twisted.stiffness.error_scale if supported else COARSE_SCALE
    return unfolded(rim_mesh(flexspline).mesh, sector.degrees), scale


def _finer(flexspline: PartModel, sector: Sector, number: int) -> TetMesh:
    design = flexspline.context.design
    f, tolerance = design.flexspline, design.solver.tolerance_pct / 100
    finer = finer_mesh(f.wall_thickness_mm, f.inner_radius, flexspline.material, tolerance, number)
    meshes, spec = PartMeshes(flexspline), flexspline.first_spec
    if number == 0:
        spec = meshes.coarsened(RIM_ELEMENTS / copies_in_rim(flexspline))
    copies = sector.degrees / flexspline.sector.degrees
    try:
        swept = meshes.swept(spec, finer, MOST_ELEMENTS / copies)
    except TooManyElementsError as fault:
        size = fault.elements * copies
        raise SolidError(f"it would have {size:.0f} elements, at most {MOST_ELEMENTS}") from None
    if swept is None:
        raise SolidError("the swept mesh fails a check")
    return unfolded(swept.mesh, sector.degrees)
