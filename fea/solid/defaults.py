"""Mesh settings for a part, from its own dimensions. Measured choices: docs/decisions.md."""

from __future__ import annotations

from math import hypot

from flexspline.fea.solid.mesh import ENVELOPES_PER_EDGE, MeshSpec
from flexspline.fea.solid.sizing import Grading, refuse_beyond
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.tagged import TaggedSurface, tagged_surface

CHORD_PER_ENVELOPE = 1.5
"""Chord error of the tessellation over the mesher's envelope: the nodes are put back onto the exact
surfaces afterwards, so neither limits accuracy, and coarse chords mesh faster."""
CUT_EDGES = 2.0
"""How far cuts reach from patch edges, in the first mesh's smallest edges. Beside the middle of a wide cut
the winding number is 1/2, and fTetWild's approximate filter then takes an element for outside: cuts across
thick walls became cracks."""
FAR_WALLS_OF_SHAFT, FAR_WALLS = 0.45, 5
"""Largest edge over the wall thickness: a shaft's wall gets two or more elements, a thin tube one layer of
long elements."""
NEAR_SHARE = 0.4
"""Smallest edge over the largest in shafts. In flexsplines the smallest edge is the wall thickness: on the
example's cup 0.4 → 2 mm, whose K is 0.7 % high (docs/decisions.md, Grading)."""
NEAR_OF_RADIUS = 50
"""Outer radius over the smallest edge of a flexspline, at least. It is that of the example cup's wall;
thicker walls are meshed as finely at their edges."""
LEAST_GRADING = 2
"""Largest over smallest edge of a flexspline, at least, so that in every flexspline edges grow with the
distance from singular edges."""
EDGE_GROWTH = 0.7
"""Growth of the edge length per distance from the singular edges, in the same mesh."""
ENVELOPES_PER_WALL, ENVELOPES_PER_FAR = 20, 100
"""Envelopes of the mesher in a flexspline's wall, and in a shaft's largest edge. The nodes are moved back
onto the surface afterwards."""
ENVELOPES_PER_LIGAMENT = 10
"""Envelopes of the mesher in the thinnest material beside a bolt hole. With 2.5 of them in 0.05 mm a cup had
31 092 and 31 186 N·m/rad in two runs, bounds ± 0.1 %; with 5 and 10 it has 30 972 and 30 968. NGSolve, from
above: 30 986."""
FINEST_SHARE = 20
"""Outer radius over the largest edge, at most. A wall of a hundredth of the radius then gets one layer of
long elements, and the part is not filled with short ones."""

LARGEST_BEND = 0.5
"""How far the middle of a keyway's floor may move relative to its corners, as a share of the material below
it. On a shaft of 16 mm with a bore of 6 mm the volume is right to 1e-4 up to this share; beyond, it is off by
0.1 to 0.9 %."""


def first_spec(part: Part, edge_length_mm: float | None = None) -> MeshSpec:
    """Return the specification of the first, coarse mesh; `edge_length_mm` fixes its largest edge.

    Raises
    ------
    SolidError : that edge asks for more points on a radian of the part's outside than any mesh may have.
    """
    # `far` also leaves six or eight edges along a short part, and three from the axis outwards in a thick one
    if isinstance(part.shape, Shaft):
        segments = part.shape.segment
        wall = min(s.outer_diameter_mm - s.inner_diameter_mm for s in segments) / 2
        outer = max(s.outer_diameter_mm for s in segments) / 2
        far = min(max(FAR_WALLS_OF_SHAFT * wall, outer / FINEST_SHARE), part.length / 8, outer / 3)
        near, envelope = NEAR_SHARE * far, far / ENVELOPES_PER_FAR
    else:
        f = part.shape
        wall, outer = min(f.wall_thickness_mm, f.diaphragm_thickness_mm), f.ring_radius
        far = min(max(FAR_WALLS * wall, outer / FINEST_SHARE), part.length / 6, outer / 3)
        near, envelope = (
            min(wall, far / LEAST_GRADING, outer / NEAR_OF_RADIUS),
            wall / ENVELOPES_PER_WALL,
        )
    if edge_length_mm is not None:
        far = edge_length_mm
        refuse_beyond(outer * part.length / far**2, far)  # before CAD makes chords as fine
        near = min(near, far)
    on_axis = any(s.on_axis for s in part.meridian.segments)
    envelope = min(envelope, near / ENVELOPES_PER_EDGE, part.ligament_mm / ENVELOPES_PER_LIGAMENT)
    return MeshSpec(
        grading=Grading(near, far, growth=EDGE_GROWTH),
        envelope=envelope,
        snap_limit=5 * envelope,
        # half the outer radius: elements twice as long around the tube, fair ones at the bolts
        unrolled_radius=0.0 if on_axis or _bends(part) else outer / 2,
    )


def _bends(part: Part) -> bool:
    """Whether unrolled space bends a keyway's floor too far: its plane becomes r = floor/cos φ."""
    slot, shape = part.keyway, part.shape
    if slot is None or not isinstance(shape, Shaft):
        return False
    bend = hypot(slot.floor, slot.half_width) - slot.floor
    below = slot.floor - shape.segment[-1].inner_diameter_mm / 2
    return bend > LARGEST_BEND * below


def surface_to_mesh(
    part: Part, first: MeshSpec, sector_deg: float, edge_spacing: float
) -> TaggedSurface:
    """Return the part's sector with the chords and cuts that `first_spec` and finer meshes need.

    Points along its edges are `edge_spacing` [mm] apart.

    Raises
    ------
    GeometryError : as `tagged_surface`.
    """
    chord_error, reach = CHORD_PER_ENVELOPE * first.envelope, CUT_EDGES * first.grading.near
    return tagged_surface(part, sector_deg, chord_error, edge_spacing, reach)
