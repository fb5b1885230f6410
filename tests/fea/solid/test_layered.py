"""Shafts meshed in layers: closed, exact, the same twice, and as stiff as theory and the mesher say."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import pi, radians
from typing import Any

import numpy as np
import pytest
from example_files import EXAMPLES
from one_mesh_bounds import one_mesh_bounds
from scipy.spatial import cKDTree

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.deadline import Deadline
from flexspline.fea.solid.bisect import PAIRS, Simplices, halved
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.defaults import first_spec, surface_to_mesh
from flexspline.fea.solid.elements import jacobian_ratio
from flexspline.fea.solid.finer import finer_by_error
from flexspline.fea.solid.layer_sizes import volume
from flexspline.fea.solid.layered import layered_mesh
from flexspline.fea.solid.layers import Layers
from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.plan import triangulated
from flexspline.fea.solid.plan_curves import Arc, Line
from flexspline.fea.solid.quadratic import boundary_faces
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.solid.stiffness import MeshSequence, solid_stiffness
from flexspline.fea.solid.sweeps import goes_about_axis
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.swept_edges import swept_edges
from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.fea.solid.torsion_field import FullTorsion
from flexspline.fea.types import Elastic, TetMesh
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START
from flexspline.geometry.symmetry import sector_of
from flexspline.geometry.tagged import TaggedSurface, tagged_surface

EDGE_SPACING = 0.1
"""Of points along sharp edges [mm]."""
COARSER = 2.5
"""Edges of a mesh that need not be good, over those of a first one."""


def segments(*rows: tuple[float, float, float]) -> list[dict[str, float]]:
    """Length, outer and inner diameter [mm]."""
    keys = ("length_mm", "outer_diameter_mm", "inner_diameter_mm")
    return [dict(zip(keys, row, strict=True)) for row in rows]


def keyway(width: float, depth: float, length: float) -> dict[str, float]:
    return {"width_mm": width, "depth_mm": depth, "length_mm": length}


HOLED, KEYED = "xb1-40.toml", "keyed-shaft.toml"
SHAFTS: dict[str, tuple[str, dict[str, Any]]] = {
    "step over the holes": (
        HOLED, {"segment": segments((4, 20, 6), (24, 15, 6)), "fillet_mm": 0.0},
    ),
    "fillet over the holes": (HOLED, {"segment": segments((4, 20, 6), (24, 13, 6))}),
    "step at the holes' rim": (HOLED, {"segment": segments((4, 20, 6), (24, 14.8, 6))}),
    "bore over the holes": (
        HOLED, {"segment": segments((4, 20, 6), (24, 18, 13)), "fillet_mm": 0.0},
    ),
    "steps on both sides of the holes": (
        HOLED, {"segment": segments((4, 20, 6), (24, 18, 10)), "fillet_mm": 0.0},
    ),
    "flange beyond a neck, to the axis": (
        HOLED, {"segment": segments((4, 20, 0), (10, 12, 0), (12, 18, 6))},
    ),
    "keyway over a step": (KEYED, {"keyway": keyway(5.0, 3.0, 22.0)}),
    "keyway up to the rim": (KEYED, {"keyway": keyway(10.4, 2.0, 16.0)}),
    "keyway from a narrower step": (
        KEYED,
        {
            "keyway": keyway(5.0, 3.0, 20.0),
            "segment": segments((4, 20, 6), (12, 15, 6), (20, 16, 6)),
        },
    ),
    "keyway and holes under a step": (
        KEYED,
        {
            "bolt_count": 4, "bolt_circle_diameter_mm": 17.0, "bolt_hole_diameter_mm": 2.5,
            "segment": segments((4, 24, 6), (12, 18, 6), (20, 16, 6)),
        },
    ),
}  # fmt: skip
OFTEN_LIKE = (
    "fillet over the holes", "step at the holes' rim", "steps on both sides of the holes",
    "keyway over a step", "keyway from a narrower step",
)  # fmt: skip
"""Shafts of whose kind another stays by default."""


def shaft_of(name: str) -> Part:
    file, changes = SHAFTS[name]
    data = tomllib.loads((EXAMPLES / file).read_text(encoding="utf-8"))
    data["shaft"] |= changes
    return design_from(data).part("shaft")


def meshed(part: Part, finer: float = 1.0) -> TetMesh:
    spec = first_spec(part)
    g = spec.grading
    spec = replace(spec, grading=Grading(g.near, g.far, g.growth).scaled(1.5 * finer))
    return layered_mesh(part, sector_of(part, "torsion").degrees, spec)


@pytest.fixture(
    scope="module",
    params=[pytest.param(s, marks=[pytest.mark.long] * (s in OFTEN_LIKE)) for s in SHAFTS],
)
def made(request: pytest.FixtureRequest) -> tuple[Part, TetMesh]:
    part = shaft_of(request.param)
    return part, meshed(part, COARSER)


@pytest.fixture(scope="module")
def cad(made: tuple[Part, TetMesh]) -> TaggedSurface:
    """The same sector of the CAD solid."""
    part, mesh = made
    return tagged_surface(part, mesh.sector_deg, 0.05, edge_spacing=EDGE_SPACING)


def test_no_sweep_about_the_axis_makes_them(made: tuple[Part, TetMesh]) -> None:
    part, mesh = made
    assert not goes_about_axis(part)
    coarse = first_spec(part).scaled(2 * COARSER)
    assert swept_mesh(part, mesh.sector_deg, coarse) is not None


def test_surface_is_closed(made: tuple[Part, TetMesh]) -> None:
    """Tetrahedra cut differently on a shared face would leave facets inside, and open edges."""
    facets = made[1].facets[:, :3]
    sides = np.vstack([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]])
    there = {tuple(s) for s in sides.tolist()}
    assert len(there) == len(sides)
    assert {(b, a) for a, b in there} == there
    assert len(boundary_faces(made[1].cells[:, :4])) == len(facets)


def test_volume_and_patches_are_the_cads(made: tuple[Part, TetMesh], cad: TaggedSurface) -> None:
    mesh = made[1]
    # a few edges of a hole's or a fillet's surface may be straight where a thin element asks for that:
    # an arc of 22° loses 2 % of the hole's area there
    assert SolidSpace.of(mesh).volumes.sum() == pytest.approx(cad.volume, rel=3e-4)
    there = {mesh.patches[i] for i in np.unique(mesh.facet_patch)}
    assert set(cad.patch_areas) == there - {""}
    for patch, area in cad.patch_areas.items():
        assert SolidSpace.of(mesh).areas(patch).sum() == pytest.approx(area, rel=1e-3)


def test_what_the_mesh_is_checked_against_is_the_cads_volume(
    made: tuple[Part, TetMesh], cad: TaggedSurface
) -> None:
    part, mesh = made
    # the kernel's own integrals hold 1e-6
    assert volume(Layers.of(part, radians(mesh.sector_deg))) == pytest.approx(cad.volume, rel=1e-5)


def test_elements_are_positive_and_little_bent(made: tuple[Part, TetMesh]) -> None:
    mesh = made[1]
    assert (signed_volumes(mesh.nodes, mesh.cells[:, :4]) > 0).all()
    assert jacobian_ratio(mesh.nodes, mesh.cells).min() >= 0.3


def test_symmetry_planes_are_planes(made: tuple[Part, TetMesh]) -> None:
    mesh = made[1]
    start, end = (mesh.nodes[mesh.nodes_on(p)] for p in (SYMMETRY_START, SYMMETRY_END))
    angle = np.radians(mesh.sector_deg)
    # of a rotation by the sector's angle, rounded, 20 mm off the axis
    assert np.abs(start[:, 1]).max() < 1e-12
    off = end[:, 1] * np.cos(angle) - end[:, 0] * np.sin(angle)
    assert np.abs(off).max(initial=0.0) < 1e-12


def test_the_grip_is_on_its_cylinder(made: tuple[Part, TetMesh]) -> None:
    """Corners and middle nodes: quadratic elements follow the circle."""
    part, mesh = made
    nodes = mesh.nodes[mesh.nodes_on("grip")]
    radius = part.meridian.segments[0].start[0]
    radii = [s.start[0] for s in part.meridian.segments if s.patch == "grip"]
    away = np.abs(np.hypot(nodes[:, 0], nodes[:, 1])[:, None] - radii).min(axis=1)
    ends = np.isclose(nodes[:, 2], part.length)
    # rounding; on the end face nodes of its circle
    assert away[~ends].max() < 1e-9
    assert radius >= 0


def test_sharp_edges_are_the_cads(made: tuple[Part, TetMesh], cad: TaggedSurface) -> None:
    part, mesh = made
    ours, theirs = swept_edges(part, mesh.sector_deg, EDGE_SPACING), cad.sharp_edges
    for one, other in ((ours, theirs), (theirs, ours)):
        # both are points along the same curves
        assert cKDTree(one).query(other)[0].max() < EDGE_SPACING


def test_same_shaft_gives_the_same_mesh() -> None:
    part = shaft_of("step over the holes")
    one, other = meshed(part), meshed(part)
    assert (one.nodes == other.nodes).all()
    assert (one.cells == other.cells).all()


@pytest.mark.parametrize(
    "rows",
    [
        pytest.param(segments((4, 20, 6), (24, 13, 6)), id="bored", marks=pytest.mark.long),
        pytest.param(segments((6, 13, 0), (8, 20, 0), (14, 15, 0)), id="to the axis"),
    ],
)
def test_a_plain_shaft_is_as_stiff_as_two_sided_bounds_say(rows: list[dict[str, float]]) -> None:
    """Without holes and keyway a shaft is a body of revolution, whose K lies between theorems.

    K_h comes from above; the error is proportional to the edge length at the singular edges.
    """
    data = tomllib.loads((EXAMPLES / HOLED).read_text(encoding="utf-8"))
    data["shaft"] |= {"segment": rows, "bolt_count": 0, "fillet_mm": 0.8}
    part = design_from(data).part("shaft")
    material = Elastic.of(part.material)
    exact = torsional_stiffness(part.meridian, material, "grip", 2e-4)
    K = [torsion(Model.of(meshed(part, f), material), "grip").K_energy for f in (1.2, 0.8, 0.5)]
    errors = np.array(K) / exact.K_Nm_per_rad - 1
    assert K[0] > K[1] > K[2] > exact.lower_Nm_per_rad
    # edges less than half as long; of each halving, an edge in two may be on either side of what is asked
    assert errors[2] < 0.5 * errors[0]
    assert errors[0] < 0.02


@pytest.mark.parametrize(
    "name",
    # a keyway on the mesher's mesh by default: test_swept.py
    ["step over the holes", pytest.param("keyway over a step", marks=pytest.mark.long)],
)
def test_a_shaft_is_as_stiff_as_on_the_meshers_mesh(name: str) -> None:
    part = shaft_of(name)
    degrees = sector_of(part, "torsion").degrees
    material, coarse = Elastic.of(part.material), first_spec(part).scaled(4.0)
    surface = surface_to_mesh(part, coarse, degrees, edge_spacing=EDGE_SPACING)
    both = (meshed(part, 2.0), mesh_surface(surface, coarse))
    (a, b), (c, d) = (one_mesh_bounds(mesh, material) for mesh in both)
    assert a < d
    assert c < b
    assert (b - a) / b < 0.06  # and ours says something


@pytest.mark.long
def test_holes_and_keyway_make_a_shaft_softer() -> None:
    """A theorem: K is the least energy of a turn, and less material has less."""
    part = shaft_of("keyway and holes under a step")
    material = Elastic.of(part.material)
    without = torsional_stiffness(part.without_holes().meridian, material, "grip", 2e-3)
    K = torsion(Model.of(meshed(part, 1.5), material), "grip").K_energy
    assert without.upper_Nm_per_rad > K


def test_halved_tetrahedra_fill_what_they_filled() -> None:
    """Whichever edges are asked for: conforming, positive, of the same volume, their facets the boundary."""
    rng = np.random.default_rng(5)
    corner = np.array(
        [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float
    )  # a cube's six tetrahedra about its diagonal (Kuhn)
    tets = np.array(
        [[0, 4, 6, 7], [0, 6, 2, 7], [0, 2, 3, 7], [0, 3, 1, 7], [0, 1, 5, 7], [0, 5, 4, 7]]
    )
    tets[signed_volumes(corner, tets) < 0] = tets[signed_volumes(corner, tets) < 0][:, [0, 2, 1, 3]]
    faces = boundary_faces(tets)
    mesh, points = Simplices(8, tets, faces, np.arange(len(faces))), corner
    for _ in range(4):
        edges = mesh.edges()
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        mesh, cut = halved(mesh, edges, lengths, rng.random(len(edges)) < 0.3)
        points = np.vstack([points, points[cut].mean(axis=1)])
        volumes = signed_volumes(points, mesh.tets)
        assert volumes.min() > 0
        assert volumes.sum() == pytest.approx(1.0, rel=1e-12)  # rounding
        assert {tuple(sorted(f)) for f in boundary_faces(mesh.tets).tolist()} == {
            tuple(sorted(f)) for f in mesh.facets.tolist()
        }
        assert set(mesh.facet_surface.tolist()) == set(range(len(faces)))
    assert len(mesh.edges()) == len(np.unique(np.sort(mesh.tets[:, PAIRS].reshape(-1, 2)), axis=0))


def test_a_plan_has_its_lines_as_edges() -> None:
    """A ring, a hole across it and a line through both: triangles fill the sector and each region of it."""
    sector, bore, outer, ring, circle, hole = pi / 2, 2.0, 10.0, 6.3, 6.0, 1.0
    curves = [
        Line((bore, 0.0), (outer, 0.0)),
        Line((0.0, bore), (0.0, outer)),
        *(Arc((0.0, 0.0), r, 0.0, sector, 1 / 90) for r in (bore, ring, outer)),  # steps of 1°
        Arc((circle, 0.0), hole, 0.0, pi, 1 / 180),
        Line((circle, 0.0), (circle, 2.0)),
    ]
    plan = triangulated(curves, sector, 0.5)
    r, phi = plan.points.T
    xy = np.column_stack([r * np.cos(phi), r * np.sin(phi)])
    u, v = (xy[plan.triangles[:, k]] - xy[plan.triangles[:, 0]] for k in (1, 2))
    area = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    assert area.min() > 0
    within = r[plan.triangles].mean(axis=1) < ring
    off = np.hypot(xy[:, 0] - circle, xy[:, 1])[plan.triangles].mean(axis=1)
    # chords of 1° lose 5e-5 of a circle's area
    assert area[within].sum() == pytest.approx(sector / 2 * (ring**2 - bore**2), rel=1e-4)
    assert area[off < hole + 1e-9].sum() == pytest.approx(pi / 2 * hole**2, rel=1e-4)


def test_a_mesh_is_finer_where_its_error_is_and_nowhere_else() -> None:
    """All of the error below the step."""
    part = shaft_of("step over the holes")
    mesh = meshed(part)
    z = mesh.nodes[mesh.cells[:, :4], 2]
    step = part.hole_depth
    error = np.where(z.max(axis=1) < step + 1e-9, 1.0, 0.0)
    assert (error > 0).mean() > 0.05  # more than one round halves
    finer = finer_by_error(part, mesh, error, 2 * mesh.elements)
    # the last round's neighbours are cut too
    assert 2 * mesh.elements <= finer.elements < 2.5 * mesh.elements
    both = [m.nodes[m.cells[:, :4], 2] for m in (mesh, finer)]
    # neighbours are cut at the edges that they share with the lowest, and reach over one layer
    low = step + np.ptp(z, axis=1).max()
    kept, new = (int((b.min(axis=1) > low).sum()) for b in both)
    assert new == kept > 100
    volumes = [SolidSpace.of(m).volumes.sum() for m in (mesh, finer)]
    assert volumes[1] == pytest.approx(volumes[0], rel=3e-4)  # as against the CAD
    assert jacobian_ratio(finer.nodes, finer.cells).min() >= 0.3
    sides = np.sort(finer.facets[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(sides, axis=0, return_counts=True)[1] == 2).all()


def test_a_narrow_neck_is_found_by_its_error() -> None:
    """A thin last segment of a thick shaft turns most, and its first mesh is the thick one's.

    Without holes and keyway K lies between theorems, far nearer to each other than what is asked.
    """
    data = tomllib.loads((EXAMPLES / HOLED).read_text(encoding="utf-8"))
    rows = segments((14, 36, 5), (6, 34, 5), (10, 38, 5), (8, 10.5, 5))
    data["shaft"] |= {"segment": rows, "bolt_count": 0, "fillet_mm": 0.0, "grip_length_mm": 3.0}
    part = design_from(data).part("shaft")
    material = Elastic.of(part.material)
    exact = torsional_stiffness(part.meridian, material, "grip", 2e-4)
    degrees, first = sector_of(part, "torsion").degrees, first_spec(part).scaled(4.0)

    def by_error(mesh: TetMesh, error: np.ndarray) -> TetMesh:
        assert isinstance(mesh, BisectableMesh)
        return finer_by_error(part, mesh, error, 2 * mesh.elements)

    def mesher(spec: MeshSpec) -> TetMesh:
        return layered_mesh(part, degrees, spec)

    wanted = 0.01
    meshes = MeshSequence(mesher, first, by_error)
    found = solid_stiffness(meshes, FullTorsion(material, "grip"), wanted, "", print).stiffness
    assert not found.shortfall
    assert found.half_width <= wanted
    assert len(found.levels) > 1
    assert found.lower_Nm_per_rad < exact.lower_Nm_per_rad
    assert exact.upper_Nm_per_rad < found.upper_Nm_per_rad
    K = [level.K_Nm_per_rad for level in found.levels]
    # each mesh holds the last one's displacements but for curved edges' middles
    assert sorted(K, reverse=True) == K


def test_a_busy_machine_costs_a_shaft_in_layers_no_mesh() -> None:
    """Each mesh takes 25 s on the clock, where 74 s are allowed, but the processor works 5 s of them."""
    part = shaft_of("step over the holes")
    clock, worked = [0.0], [0.0]

    def mesher(spec: MeshSpec) -> TetMesh:
        return later(layered_mesh(part, sector_of(part, "torsion").degrees, spec))

    def by_error(mesh: TetMesh, error: np.ndarray) -> TetMesh:
        assert isinstance(mesh, BisectableMesh)
        return later(finer_by_error(part, mesh, error, 2 * mesh.elements))

    def later(mesh: TetMesh) -> TetMesh:
        clock[0] += 25.0
        worked[0] += 5.0
        return mesh

    deadline = Deadline(74.0, lambda: clock[0], lambda: worked[0])
    meshes = MeshSequence(mesher, first_spec(part).scaled(4.0), by_error)
    found = solid_stiffness(
        meshes, FullTorsion(Elastic.of(part.material), "grip"), 1e-9, "", print, deadline
    ).stiffness
    assert len(found.levels) == 2  # the third would begin at 75 s
    assert "74 s" in found.shortfall.words
