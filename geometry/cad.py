"""cadquery solids of the parts, whole or as a symmetric sector, with every face's surface named."""

from __future__ import annotations

from math import radians
from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.geometry.errors import GeometryError
from flexspline.geometry.kernel import load_kernel
from flexspline.geometry.outline import Meridian, Segment
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft

if TYPE_CHECKING:
    import cadquery as cq

WHOLE = 360.0
"""[deg]"""
OVER_mm = 0.01
"""How far a hole's tool reaches beyond a face, so that the cut has no coplanar cap: less than any gap."""


def build_solid(part: Part, sector_deg: float = WHOLE) -> cq.Solid:
    """The part's solid [mm], or its piece between angle 0 and `sector_deg` about z.

    Raises
    ------
    GeometryError : the kernel cannot be loaded, or left no single valid solid.
    """
    load_kernel()
    body: cq.Shape = _revolve(part.meridian, sector_deg)
    tools = [*_bolt_cylinders(part), *_keyway_boxes(part)]
    if tools:
        body = body.cut(*tools)
    solids = body.Solids()
    if len(solids) != 1 or not solids[0].isValid():
        raise GeometryError(
            f"the CAD kernel made {len(solids)} solids of the {part.name}, expected one valid solid"
        )
    return solids[0]


def _bolt_cylinders(part: Part) -> list[cq.Solid]:
    """The bolt holes as solids, the first at angle 0."""
    import cadquery as cq

    if part.bolts is None:
        return []
    blind = isinstance(part.shape, Shaft) and len(part.shape.segment) > 1
    top = part.hole_depth + (0.0 if blind else OVER_mm)
    return [
        cq.Solid.makeCylinder(
            part.bolts.hole_radius, top + OVER_mm, cq.Vector(x, y, -OVER_mm), cq.Vector(0, 0, 1)
        )
        for x, y in part.bolts.centres
    ]


def _keyway_boxes(part: Part) -> list[cq.Solid]:
    import cadquery as cq

    slot = part.keyway
    if slot is None or not isinstance(part.shape, Shaft):
        return []
    reach = max(s.outer_diameter_mm for s in part.shape.segment)
    return [
        cq.Solid.makeBox(
            reach,
            2 * slot.half_width,
            slot.length + 1.0,
            cq.Vector(slot.floor, -slot.half_width, slot.start),
        )
    ]


def _revolve(outline: Meridian, sector_deg: float) -> cq.Solid:
    import cadquery as cq

    wire = cq.Wire.assembleEdges([_edge(s) for s in outline.segments])
    return cq.Solid.revolve(wire, [], sector_deg, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))


def _edge(s: Segment) -> cq.Edge:
    import cadquery as cq

    a, b = _in_plane(s.start), _in_plane(s.end)
    if s.centre is None:
        return cq.Edge.makeLine(a, b)
    return cq.Edge.makeThreePointArc(a, _in_plane(tuple(s.at(0.5))), b)


def _in_plane(p: tuple[float, ...]) -> cq.Vector:
    import cadquery as cq

    return cq.Vector(p[0], 0.0, p[1])


def partition_faces(
    solid: cq.Solid, outline: Meridian, sector_deg: float, reach_mm: float
) -> list[cq.Face]:
    """The cuts at patch edges, as far as `reach_mm` into the material, as faces trimmed to the solid."""
    import cadquery as cq
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt

    axis = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
    faces: list[cq.Face] = []
    for cut in outline.cuts_within(reach_mm):
        swept = BRepPrimAPI_MakeRevol(_edge(cut).wrapped, axis, radians(sector_deg)).Shape()
        faces += cq.Shape.cast(swept).intersect(solid).Faces()
    return faces


def write_step(solid: cq.Solid, path: Path, name: str) -> None:
    """STEP AP214 of the solid, in mm; `name`, of ASCII letters, is its product's."""
    import cadquery as cq

    # "fused": a product of its own, not an assembly of one part
    cq.Assembly(solid, name=name).export(str(path), exportType="STEP", mode="fused")


def write_stl(solid: cq.Solid, path: Path, chord_error: float) -> None:
    """Binary STL of the solid within `chord_error` [mm]."""
    turn = radians(10)  # 36 facets around a small hole, where the chords ask for fewer
    solid.exportStl(str(path), tolerance=chord_error, angularTolerance=turn)
