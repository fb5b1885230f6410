"""cadquery solids of the parts, whole or as a symmetric sector, with every face's surface named."""

from __future__ import annotations

from math import radians
from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.geometry.design import Cup, Design
from flexspline.geometry.errors import GeometryError
from flexspline.geometry.kernel import load_kernel
from flexspline.geometry.meridian import meridian
from flexspline.geometry.outline import Meridian, Segment

if TYPE_CHECKING:
    import cadquery as cq

WHOLE = 360.0


def build_solid(design: Design, part: str, sector_deg: float = WHOLE) -> cq.Solid:
    """The part's solid [mm], or its piece between angle 0 and `sector_deg` about z.

    Raises
    ------
    GeometryError : the kernel cannot be loaded, or left no single valid solid.
    """
    load_kernel()
    body: cq.Shape = _revolve(meridian(design, part), sector_deg)
    tools = [*bolt_cylinders(design, part), *_keyway_boxes(design, part)]
    if tools:
        body = body.cut(*tools)
    solids = body.Solids()
    if len(solids) != 1 or not solids[0].isValid():
        raise GeometryError(
            f"the CAD kernel made {len(solids)} solids of the {part}, expected one valid solid"
        )
    return solids[0]


def bolt_cylinders(design: Design, part: str) -> list[cq.Solid]:
    """The bolt holes as solids, the first at angle 0."""
    load_kernel()
    import cadquery as cq

    bolts = (design.shaft if part == "shaft" else design.flexspline).bolts
    if bolts is None:
        return []
    below, top = bolt_depth(design, part)
    return [
        cq.Solid.makeCylinder(
            bolts.hole_radius, top + below, cq.Vector(x, y, -below), cq.Vector(0, 0, 1)
        )
        for x, y in bolts.centres
    ]


def bolt_depth(design: Design, part: str) -> tuple[float, float]:
    """How far a hole's tool starts below z = 0 and where it ends [mm]."""
    over = 0.01  # beyond the face, so that the cut has no coplanar cap; less than any gap above
    if part == "shaft":
        segments = design.shaft.segment
        first = segments[0].length_mm
        return over, first + (over if len(segments) == 1 else 0.0)
    f = design.flexspline
    return over, (f.boss_thickness_mm if isinstance(f, Cup) else f.flange_thickness_mm) + over


def _keyway_boxes(design: Design, part: str) -> list[cq.Solid]:
    import cadquery as cq

    key = design.shaft.keyway
    if part != "shaft" or key is None:
        return []
    floor = design.shaft.segment[-1].outer_diameter_mm / 2 - key.depth_mm
    reach = max(s.outer_diameter_mm for s in design.shaft.segment)
    return [
        cq.Solid.makeBox(
            reach,
            key.width_mm,
            key.length_mm + 1.0,
            cq.Vector(floor, -key.width_mm / 2, design.shaft.length - key.length_mm),
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


def write_step(solid: cq.Solid, path: Path) -> None:
    """STEP AP214 of the solid, in mm."""
    solid.exportStep(str(path))


def write_stl(solid: cq.Solid, path: Path, chord_error: float) -> None:
    """Binary STL of the solid within `chord_error` [mm]."""
    solid.exportStl(str(path), tolerance=chord_error, angularTolerance=radians(10))
