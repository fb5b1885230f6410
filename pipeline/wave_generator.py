"""The wave generator's ellipse imposed on a solid model, on a separate mesh."""

from __future__ import annotations

from dataclasses import replace
from math import dist, hypot, radians
from typing import Any

from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.errors import TooManyElementsError
from flexspline.fea.solid.alone import alone
from flexspline.fea.solid.cyclic import half_repeat
from flexspline.fea.solid.load_cases import ellipse
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.peak import SharpEdges, stress_field
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.types import Shortfall, SolidField
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline.part_meshes import MeshedPart, PartMeshes
from flexspline.pipeline.part_stiffness import rim_mesh
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.rim_size import copies_in_rim

LARGEST_ELLIPSE_STEP = radians(5)
"""Of elements about the axis [rad]: with the two below, what the peak needs."""
EDGE_WALLS, REACH_WALLS = 0.5, 1.5
"""Edges of the meridian beside the peak, and how far around it, in wall thicknesses.

Against the axisymmetric peak of parts without holes these three leave 0.3 to 0.8 %; steps of 7.5° or
edges of a wall leave 1 to 2 % (docs/decisions.md)."""
ELSEWHERE = 2.0
"""Edges away from the peak, in those of the first mesh for K: the peak stays the same to 0.01 %."""
MOST_ELLIPSE_ELEMENTS = 60_000
"""Of the quarter or half: 270 000 unknowns, 20 s. On a hat 84 624 gave 296.3 MPa, edges 1.5 times as long
(56 376) 297.0, and the mesh that gave K, all that a limit of 40 000 would leave, 290.9."""
COARSER_RATIOS = (1.0, 1.5, 2.0)
"""Steps and edges are so many times as long where there would be more; where that does not help, the mesh
that gave K serves."""
UNREFINED = Shortfall("it is of the mesh that gave K alone, which is not refined at the peak")
"""Such peaks were 2 and 11 % low on a hat and on a cup whose fillets touch the holes."""
PLACE_TOLERANCE = 0.02
"""Of the hole-free peak that says where to refine; its place is good to a share of a wall by then."""


def solid_ellipse(flexspline: PartModel) -> SolidField:
    """Return the field of `ellipse` on the flexspline's quarter or half.

    A swept part is meshed again, fine where the peak of the part without its holes is; should the peak
    turn up elsewhere, there too. Any other part is solved on the mesh that gave K.
    """
    w0 = flexspline.context.design.w0_mm

    def make() -> SolidField:
        expected = _hole_free_peak(flexspline)
        fine = _refined_at(flexspline, expected) if expected else None
        if expected is None or fine is None:
            field = _solved(flexspline, rim_mesh(flexspline), w0)
            return replace(field, peak=replace(field.peak, shortfall=UNREFINED))
        field = _solved(flexspline, fine, w0)
        x, y, z = field.peak.at_mm
        peak_place = hypot(x, y), z
        if dist(peak_place, expected) < _reach_mm(flexspline):
            return field
        finer = _refined_at(flexspline, expected, peak_place)
        return _solved(flexspline, finer, w0) if finer else field

    inputs: dict[str, Any] = {**flexspline.torsion_key, "w0_mm": w0}
    return flexspline.context.cache.get("ellipse", inputs, make)[0]


def coarse_ellipse(flexspline: PartModel) -> SolidField:
    """Return the field on K's mesh or a coarser one, for pictures: another model gives the peak."""
    w0 = flexspline.context.design.w0_mm

    def make() -> SolidField:
        return _solved(flexspline, rim_mesh(flexspline), w0)

    inputs: dict[str, Any] = {**flexspline.torsion_key, "w0_mm": w0, "mesh": "for pictures"}
    return flexspline.context.cache.get("ellipse", inputs, make)[0]


def _hole_free_peak(flexspline: PartModel) -> tuple[float, float] | None:
    """Where (r, z) the stress is largest without the holes; None where no mesh can use or find it."""
    part, w0 = flexspline.part, flexspline.context.design.w0_mm
    if not flexspline.is_swept:
        return None
    try:
        field = ellipse_stress(
            part.meridian, flexspline.material, w0, part.exclusion_mm, PLACE_TOLERANCE
        )
        return field.peak_rz
    except ComputationError:
        return None


def _reach_mm(flexspline: PartModel) -> float:
    return REACH_WALLS * flexspline.context.design.flexspline.wall_thickness_mm


def _refined_at(flexspline: PartModel, *places: tuple[float, float]) -> MeshedPart | None:
    """The torsion sector swept with edges of the meridian that are short beside `places` (r, z) only.

    None where a check fails or the mesh would be larger than MOST_ELLIPSE_ELEMENTS at its coarsest.
    """
    design = flexspline.context.design
    spec = flexspline.first_spec
    far = spec.grading.far
    if not flexspline.states_edges:
        far *= ELSEWHERE
    even = replace(spec, grading=replace(spec.grading, near=far, far=far))
    edge = EDGE_WALLS * design.flexspline.wall_thickness_mm
    times = copies_in_rim(flexspline)
    with flexspline.context.progress.stage("mesh for the wave generator"):
        for coarser in COARSER_RATIOS:
            finer = Finer(
                coarser * LARGEST_ELLIPSE_STEP, places, _reach_mm(flexspline), coarser * edge
            )
            try:
                return PartMeshes(flexspline).swept(even, finer, MOST_ELLIPSE_ELEMENTS / times)
            except TooManyElementsError:
                continue
    return None


def _solved(flexspline: PartModel, meshed: MeshedPart, w0: float) -> SolidField:
    """The ellipse on a sector's mesh reflected to a quarter or half, and its peak that counts."""
    progress = flexspline.context.progress
    sector = sector_of(flexspline.part, "ellipse")
    with progress.stage("wave generator"):
        elements = meshed.mesh.elements * copies_in_rim(flexspline)
        progress.note(f"  {elements} elements, {sector.label} of the part")
        with alone(elements):
            solved = ellipse(Model.of(half_repeat(meshed.mesh), flexspline.material), w0)
            return stress_field(
                solved.mesh,
                solved.displacement,
                flexspline.material,
                ellipse_title(flexspline),
                sharp_edges(flexspline, meshed),
            )


def ellipse_title(flexspline: PartModel) -> str:
    """Return what fields of the ellipse are called."""
    return f"wave generator, w0 = {flexspline.context.design.w0_mm:g} mm"


def sharp_edges(model: PartModel, meshed: MeshedPart) -> SharpEdges:
    """Return the stress rule's edges and its distance."""
    return SharpEdges(meshed.sharp_edges, meshed.mesh.sector_deg, model.part.exclusion_mm)
