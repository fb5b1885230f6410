"""Meshes of bodies of revolution with bolt holes, without a mesher: triangles swept into prisms.

The meridian's triangles are swept about the axis, those of the bolt holes' plan along it
(`fea.solid.column`), and every prism is cut into three tetrahedra. Nodes lie on the exact surfaces,
patch edges are mesh edges, elements are long around the part and short along its meridian, and the
same design gives the same mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import ceil, inf, radians

import numpy as np

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.errors import MeshQualityError, TooManyElementsError
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.column import INTERFACE, LARGEST_ARC, HoledColumn, column_of
from flexspline.fea.solid.facet_surfaces import patches_of, surfaces_of
from flexspline.fea.solid.layered import layered_mesh
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.mesh_checks import VOLUME, check_sizes
from flexspline.fea.solid.polar import cartesian, middles
from flexspline.fea.solid.prisms import along, cut, extruded, mirrored, revolved, unrolled_copies
from flexspline.fea.solid.quadratic import boundary_faces, straightened, with_middles
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.slot import SlottedTube
from flexspline.fea.solid.snap import middles_on_surfaces
from flexspline.fea.solid.sweeps import bent_block, can_be_swept, goes_about_axis, half_holes
from flexspline.fea.solid.swept_sizing import (
    Finer,
    critical_points,
    graded_mesh,
    plan_mesh,
    refuse_beyond_memory,
)
from flexspline.geometry.outline import Meridian, SAME_mm
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import Surface, part_surfaces

STRAIGHT_OF_LAND = 0.05
"""Of the land between a keyway's floor and the bore: how far off its surface a straight edge may be. A land
of 0.05 mm came out 0.072 mm thick, and K was 1.7 % too high where ± 0.15 % was reported."""
LARGEST_SWEPT_STEP = radians(10)
"""Around the axis: a turn is not a polynomial, and quadratic elements follow it to 1e-5 of K here."""
PolarMap = Callable[[np.ndarray], np.ndarray]
"""Nodes (n, 3) as (r, φ, z) of the revolved mesh to those of the part's."""


def swept_mesh(
    part: Part,
    sector_deg: float,
    spec: MeshSpec,
    finer: Finer | None = None,
    most_elements: float = inf,
) -> BisectableMesh | None:
    """Return the mesh of the part's sector, graded as `spec` says; None for a part that is not swept.

    A shaft with holes that are not in a plain column, or a keyway that cannot be bent into place, is swept
    along the axis (`fea.solid.layered`); a flexspline with such holes needs a mesher. So does a part whose
    sweep fails a check: elements bent too far, a facet off every surface of the part, a volume or a patch
    area that is not its own, a meridian that cannot be triangulated.

    Raises
    ------
    TooManyElementsError : the mesh would have more than `most_elements`. To find that out takes a tenth of
        the mesh's time or less.
    """
    if not can_be_swept(part):
        return None
    column = column_of(part)
    block = bent_block(part, column)
    try:
        if not goes_about_axis(part):
            return layered_mesh(part, sector_deg, spec, most_elements)
        copies = half_holes(part, sector_deg) if column else 1
        wedge = radians(sector_deg) / copies
        polar, tets, bend = _prisms(
            part.meridian, column, block, wedge, copies, spec.grading, finer
        )
        if len(tets) > most_elements:
            raise TooManyElementsError(len(tets), most_elements)
        return _curved(part, sector_deg, polar, tets, bend)
    except (MeshQualityError, MeshingError):
        return None


def _prisms(
    outline: Meridian,
    column: HoledColumn | None,
    block: SlottedTube | None,
    wedge: float,
    copies: int,
    grading: Grading,
    finer: Finer | None,
) -> tuple[np.ndarray, np.ndarray, PolarMap]:
    """Corners (n, 3) as (r, φ, z), tetrahedra (m, 4), positive, and how a keyway bends them.

    The sector is a wedge [rad] and its mirror images, `copies` in all.
    """
    rest_outline = outline if column is None else column.rest(outline)
    critical = critical_points(outline)
    if block is None:
        first = triangulate(rest_outline)
    else:
        first = triangulate(block.outline(rest_outline), block.edges)
        grading = block.grading(grading)
    rest = graded_mesh(first, critical, grading, finer if block is None else block.finer(grading))
    step = LARGEST_SWEPT_STEP if finer is None else finer.step_rad
    if column is None:
        if block is None:
            angles = np.linspace(0, wedge, ceil(wedge / step) + 1)
        else:
            angles = block.angles(wedge, grading.far)
        refuse_beyond_memory(len(rest.triangles) * (len(angles) - 1))
        polar, prisms = revolved(rest, angles)
    else:
        if finer is None:
            arc = LARGEST_ARC if block is None else block.step_rad(grading.far)
            plan = plan_mesh(column, wedge, grading.far, arc)
        elif finer.even:
            plan = plan_mesh(column, wedge, grading.far, 2 * step)  # an arc begins as two chords
        else:
            plan = plan_mesh(column, wedge, min(grading.far, step * column.interface))
        seam = along(plan, INTERFACE)
        angle = np.arctan2(plan.points[seam, 1], plan.points[seam, 0])
        seam, angles = seam[np.argsort(angle)], np.sort(angle)
        angles[[0, -1]] = 0.0, wedge
        refuse_beyond_memory(len(rest.triangles) * (len(angles) - 1))
        polar, prisms = revolved(rest, angles)
        above, more = extruded(plan, column, rest, seam, len(polar))
        polar, prisms = np.vstack([polar, above]), np.vstack([prisms, more])
    if copies > 1:
        polar, prisms = unrolled_copies(polar, prisms, wedge, copies)
    bend: PolarMap = _unbent
    if block is not None:
        side = block.side(np.concatenate([mirrored(angles, wedge, k) for k in range(copies)]))
        prisms = prisms[~block.holds(polar[prisms].mean(axis=1), side)]
        bend = partial(block.bent, side=side, sector=wedge * copies)
    tets = cut(prisms)
    used, compact = np.unique(tets, return_inverse=True)
    return polar[used], compact.reshape(tets.shape), bend


def _curved(
    part: Part,
    sector_deg: float,
    polar: np.ndarray,
    tets: np.ndarray,
    bend: PolarMap,
) -> BisectableMesh:
    """Ten-node tetrahedra: middle nodes follow the angle, those of the surface lie on it."""
    corners = cartesian(bend(polar))
    faces = boundary_faces(tets)
    surfaces = part_surfaces(part, sector_deg)
    facet_surface = surfaces_of(corners, faces, surfaces)
    edges, cells, facets = with_middles(corners, tets, faces)
    turned = cartesian(bend(middles(polar[edges])))
    nodes = middles_on_surfaces(corners, turned, edges, facets, facet_surface, surfaces)
    nodes = straightened(nodes, cells, edges, facets)
    patches = patches_of(facet_surface, surfaces)
    mesh = BisectableMesh(
        nodes, cells, facets, *patches, sector_deg, facet_surface, in_layers=False
    )
    check_swept(mesh, part)
    return mesh


def check_swept(mesh: BisectableMesh, part: Part) -> None:
    """Compare volume and patch areas with Pappus' theorems, and a keyway's land.

    Raises
    ------
    MeshQualityError : one of them is off.
    """
    column = column_of(part)
    block = bent_block(part, column)
    if block is not None:
        _refuse_thick_land(mesh, part_surfaces(part, mesh.sector_deg), block)
    check_sizes(mesh, _sizes(part, mesh.sector_deg, column, block))


def _refuse_thick_land(
    mesh: BisectableMesh, surfaces: Sequence[Surface], block: SlottedTube
) -> None:
    """Raise MeshQualityError where straight edges change the land between floor and bore; those farther out
    are told by volume and areas."""
    for number, surface in enumerate(surfaces):
        mine = mesh.nodes[np.unique(mesh.facets[mesh.facet_surface == number])]
        mine = mine[np.hypot(mine[:, 0], mine[:, 1]) <= block.corner + SAME_mm]
        off = np.linalg.norm(surface.project(mine) - mine, axis=1).max(initial=0.0)
        if off > STRAIGHT_OF_LAND * block.land:
            raise MeshQualityError(
                f"a straight edge is {off:.3g} mm off a land of {block.land:.3g} mm"
            )


def _unbent(polar: np.ndarray) -> np.ndarray:
    return polar


def _sizes(
    part: Part, sector_deg: float, column: HoledColumn | None, block: SlottedTube | None
) -> dict[str, float]:
    """Volume and patch areas by Pappus' theorems, less holes, which start in `mount`, and slot."""
    share = sector_deg / 360
    outline = part.meridian
    holes = 0.0
    if column is not None:
        holes = half_holes(part, sector_deg) * np.pi / 2 * column.hole_radius**2
    depth = 0.0 if column is None else column.depth - column.low
    slot = block.half_volume if block else 0.0
    sizes = {VOLUME: outline.volume * share - holes * depth - slot}
    for patch in {s.patch for s in outline.segments if s.patch}:
        area = outline.patch_area(patch) * share - (holes if patch == "mount" else 0.0)
        if block is not None:
            area -= block.half_mouth(outline, patch)
        sizes[patch] = area
    return sizes
