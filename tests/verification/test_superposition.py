"""What holes and keyways change, solved alone on a coarse mesh, against models that solve all of the part.

Three ways to know that it is right:

- The solid model of the same part on a finer mesh, with the error that it says: there is no u₀ in it.
- Both fields lie above K, and nearer on a finer mesh: v_h stores less than v, and the part's own field u_h
  stores more than u.
- Betti's theorem: K = K₀ + ∫ (σ₀ n)·u over the walls, of a keyway with u less the turn of its mouth. With
  u_h in place of u this is off by a(v − v_h, u − u_h), so by less than the root of both fields' errors, and
  knows nothing of v_h.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from functools import cache
from itertools import islice
from math import sqrt
from typing import Any

import numpy as np
import pytest
from example_files import EXAMPLES
from skfem import Basis

from flexspline.fea.axisymmetric.recovery import R_THETA, THETA_Z
from flexspline.fea.axisymmetric.torsion import SolvedTorsion, solved_torsions
from flexspline.fea.cylindrical import TANGENTIAL
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.field_solver import CORRECTION_SCALES, FULL_SCALES
from flexspline.fea.solid.load_cases import torsion_and_correction, torsion_correction
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.solved import SolvedCorrection, SolvedStiffness
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.superposition import (
    Walls,
    WholeTurned,
    at_cuts,
    turned_walls,
    wall_facets,
)
from flexspline.fea.solid.sweeps import goes_about_axis
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.types import NMM_PER_NM, Elastic, TetMesh
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import part_surfaces
from flexspline.geometry.symmetry import sector_of

WIDTH = 2e-5
"""Of K₀'s bounds, relative."""
LAYERS = 4.0
"""Edges of a mesh in layers over those of a swept one, where no sweep about the axis makes the part."""
COARSE, FINER = 1.4, 0.7
"""Edges of the two meshes over those of a first one: half as long on the finer."""
FAR_MM, FAR_WIDTH = 100.0, 0.01
"""Longest edges at the cuts and bounds' relative width of a body without holes that is solved coarsely."""
BOTH_DOUBTS = ("hat, six large holes in a thin flange", "shaft, holes and a wide keyway")
"""Cases, quick to solve, whose doubt by the body's last two meshes is computed too."""
CASES: dict[str, tuple[str, str, dict[str, Any]]] = {
    "cup, two large holes": (
        "xb1-40.toml", "flexspline",
        {"bolt_count": 2, "bolt_hole_diameter_mm": 4.4, "diaphragm_thickness_mm": 1.5},
    ),
    "hat, six large holes in a thin flange": (
        "hat-25.toml", "flexspline",
        {"bolt_count": 6, "bolt_hole_diameter_mm": 7.0, "flange_thickness_mm": 1.0},
    ),
    "shaft, its own holes": ("xb1-40.toml", "shaft", {}),
    "shaft, a keyway beyond its grip": ("keyed-shaft.toml", "shaft", {"grip_length_mm": 8.0}),
    "shaft, holes and a wide keyway": (
        "keyed-shaft.toml", "shaft",
        {
            "bolt_count": 4, "bolt_circle_diameter_mm": 13.0, "bolt_hole_diameter_mm": 2.0,
            "grip_length_mm": 8.0, "fillet_mm": 0.0,
            "keyway": {"width_mm": 10.0, "depth_mm": 3.0, "length_mm": 14.0},
        },
    ),
}  # fmt: skip

SOLVED = [
    pytest.param(
        case,
        marks=[pytest.mark.long]
        * (case in ("hat, six large holes in a thin flange", "shaft, its own holes")),
    )
    for case in CASES
]
"""By default a cup with holes, a shaft with a keyway, one with both. Walls, and the energy in the cuts, which
need no solve, are looked at in all."""


@cache
def part_of(case: str) -> Part:
    file, name, changes = CASES[case]
    data = tomllib.loads((EXAMPLES / file).read_text(encoding="utf-8"))
    data[name] |= changes
    return design_from(data).part(name)  # type: ignore[arg-type]


@cache
def whole_of(case: str) -> WholeTurned:
    part, body = part_of(case), part_of(case).without_holes()
    solves = solved_torsions(
        body.meridian, Elastic.of(part.material), body.driven, WIDTH, at_cuts(part)
    )
    coarser, finer = islice(solves, 2)
    return WholeTurned(part, finer, coarser)


@cache
def coarsely_of(case: str) -> SolvedTorsion:
    """Of the body without holes."""
    part = part_of(case)
    return next(
        solved_torsions(
            part.without_holes().meridian, Elastic.of(part.material), part.driven, FAR_WIDTH,
            [replace(box, longest_mm=FAR_MM) for box in at_cuts(part)],
        )
    )  # fmt: skip


@cache
def mesh_of(case: str, edges: float) -> TetMesh:
    part = part_of(case)
    spec = first_spec(part).scaled(edges if goes_about_axis(part) else LAYERS * edges)
    mesh = swept_mesh(part, sector_of(part, "torsion").degrees, spec)
    assert mesh is not None
    return mesh


def model_of(case: str, edges: float) -> Model:
    return Model.of(mesh_of(case, edges), Elastic.of(part_of(case).material))


@cache
def solved(case: str, edges: float) -> tuple[SolvedStiffness, SolvedCorrection]:
    """Its doubt is by the body that is solved coarsely."""
    part, finer = part_of(case), whole_of(case).solved
    whole = WholeTurned(part, finer, coarsely_of(case))
    return torsion_and_correction(model_of(case, edges), part.driven, whole)


def superposed(case: str, edges: float) -> tuple[float, float]:
    """K by v_h, and its estimated error, unscaled [N·m/rad]."""
    _, correction = solved(case, edges)
    K = whole_of(case).solved.stiffness.K_Nm_per_rad - correction.lost / NMM_PER_NM
    error = energy_error(
        correction.mesh, correction.displacement, Elastic.of(part_of(case).material)
    )
    return K, float(error.error.sum()) * 360 / correction.mesh.sector_deg / NMM_PER_NM


@pytest.mark.parametrize("case", SOLVED)
def test_a_coarse_mesh_knows_more_of_the_holes_than_a_fine_one_of_the_part(
    case: str, record
) -> None:
    K, error = superposed(case, COARSE)
    fine, fine_error = superposed(case, FINER)
    own, _ = solved(case, FINER)
    material = Elastic.of(part_of(case).material)
    relative = FULL_SCALES.usual * energy_error(own.mesh, own.displacement, material).relative
    record(
        f"K of {case}, what they change on a coarse mesh", "all of the part on a finer mesh",
        own.K_energy * (1 - relative), K - CORRECTION_SCALES.usual * error, "N·m/rad",
    )  # fmt: skip
    assert own.K_energy * (1 - 2 * relative) < K - CORRECTION_SCALES.usual * error < own.K_energy
    whole = whole_of(case).solved.stiffness
    assert fine < K < whole.upper_Nm_per_rad  # from above
    assert fine > K - 2 * CORRECTION_SCALES.usual * error  # within the bounds of one mesh
    assert fine_error < error
    coarse_own, _ = solved(case, COARSE)
    assert fine < own.K_energy < coarse_own.K_energy
    assert coarse_own.K_energy > K
    # the reason for it all: the coarse mesh's own K is off by ten times as much, and more; beside a keyway,
    # whose floor has sharp corners, twice
    times = 10 if part_of(case).keyway is None else 2
    assert coarse_own.K_energy - fine > times * (K - fine)


@pytest.mark.parametrize("case", SOLVED)
def test_by_Bettis_theorem_it_is_the_same(case: str) -> None:
    whole, mesh = whole_of(case), mesh_of(case, COARSE)
    own, _ = solved(case, COARSE)
    walls, turn, material = (
        Walls.of(mesh, whole.part),
        whole.solved.turn,
        Elastic.of(whole.part.material),
    )
    psi = walls.places(turn.space).see(turn.psi)
    shear = material.mu * walls.r.ravel() * psi.grad
    pull = walls.pull({R_THETA: shear[0], THETA_Z: shear[1]})
    moved = np.einsum("aq,kad,cdkq->ckq", walls.shapes, own.displacement[walls.facets], walls.axes)
    moved[TANGENTIAL] -= walls.r * walls.of_slot[:, None]  # the slot's mouth is no longer turned
    work = float(np.sum(pull * moved)) * 360 / mesh.sector_deg / NMM_PER_NM
    by_betti = whole.solved.stiffness.K_Nm_per_rad + work
    K, _ = superposed(case, COARSE)
    best = superposed(case, FINER)
    limit = best[0] - 2 * CORRECTION_SCALES.usual * best[1]
    # K₀ and u₀ are off by WIDTH themselves
    allowed = sqrt((K - limit) * (own.K_energy - limit)) + 2 * WIDTH * K
    assert by_betti == pytest.approx(K, abs=allowed)
    if whole.part.keyway is None:
        assert allowed < own.K_energy - K  # less than what it would be off by alone


@pytest.mark.parametrize("case", SOLVED)
def test_the_doubt_is_how_far_a_coarser_body_without_holes_moves_it(case: str) -> None:
    """To first order: what is left out is the square of it."""
    part, far, model = part_of(case), coarsely_of(case), model_of(case, COARSE)
    _, fine = solved(case, COARSE)
    coarse = torsion_correction(model, part.driven, WholeTurned(part, far, far))
    assert coarse.doubt == 0
    moved, lost = abs(coarse.lost - fine.lost), fine.lost
    # of a keyway at the end of the grip, where u₀ is singular, the second order is 2 % at once
    assert fine.doubt == pytest.approx(moved, rel=0.03, abs=10 * moved**2 / lost + 1e-9 * lost)
    if case in BOTH_DOUBTS:
        usual = torsion_correction(model, part.driven, whole_of(case))
        assert usual.doubt <= fine.doubt


def width_rad(part: Part, r: np.ndarray, z: np.ndarray) -> np.ndarray:
    """How much of the circle through r, z lies in the cuts."""
    found = np.zeros_like(r)
    if (bolts := part.bolts) is not None:
        cosine = (r**2 + bolts.radius**2 - bolts.hole_radius**2) / (2 * r * bolts.radius)
        each = 2 * np.arccos(np.clip(cosine, -1, 1))
        found += np.where(z < part.hole_depth, bolts.count * each, 0.0)
    if (slot := part.keyway) is not None:
        half = np.minimum(
            np.arcsin(np.clip(slot.half_width / r, 0, 1)), np.arccos(np.clip(slot.floor / r, 0, 1))
        )
        found += np.where(z > slot.start, 2 * half, 0.0)
    return found


@pytest.mark.parametrize("case", CASES)
def test_the_work_on_the_walls_is_the_energy_in_the_cuts(case: str) -> None:
    """Of the body without them, integrated over its meridian."""
    whole = whole_of(case)
    turn, material = whole.solved.turn, Elastic.of(whole.part.material)
    basis = Basis(turn.space.basis.mesh, turn.space.basis.elem, intorder=12)
    r, z = np.asarray(basis.global_coordinates())
    slope = basis.interpolate(turn.psi).grad
    density = material.mu * r**3 * (slope**2).sum(axis=0) * width_rad(whole.part, r, z)
    walls = turned_walls(Walls.of(mesh_of(case, COARSE), whole.part), whole.solved, material)
    # the cuts' walls cross the meridian's triangles: points see them or not
    assert float((density * basis.dx).sum()) == pytest.approx(walls.energy, rel=0.01)


@pytest.mark.parametrize("case", CASES)
def test_the_walls_are_those_of_the_cuts(case: str) -> None:
    part, mesh = part_of(case), mesh_of(case, COARSE)
    facets = wall_facets(mesh, part)
    walls = Walls.of(mesh, part)
    assert len(facets) == len(walls.facets)
    assert not np.isin(facets, mesh.on("mount")).all(axis=1).any()
    assert np.abs(walls.area[TANGENTIAL]).max() > 0
    x, y = walls.r * np.cos(walls.phi), walls.r * np.sin(walls.phi)
    area = np.linalg.norm(walls.area, axis=0)
    normal = np.einsum("ckq,cdkq->dkq", walls.area, walls.axes) / area
    copies = 360 / mesh.sector_deg
    slots = np.broadcast_to(walls.of_slot[:, None], area.shape)
    if (bolts := part.bolts) is not None:
        wall, floor = (~slots & (np.abs(normal[2]) < 0.5), ~slots & (np.abs(normal[2]) > 0.5))
        away = np.min([np.hypot(x - a, y - b) for a, b in bolts.centres], axis=0)
        assert away[wall] == pytest.approx(bolts.hole_radius, rel=2e-3)  # parabolas for arcs
        assert walls.z[floor] == pytest.approx(part.hole_depth)
        sizes = 2 * np.pi * bolts.hole_radius * part.hole_depth, np.pi * bolts.hole_radius**2
        for mine, size in zip((wall, floor), sizes, strict=True):
            if mine.any():  # the floor of a blind hole
                found = float(area[mine].sum()) * copies
                assert found == pytest.approx(bolts.count * size, rel=2e-3)
        # the normal leaves the material: into the hole, so on the far side of it back to the axis
        outer = wall & (walls.r > bolts.radius + bolts.hole_radius / 2)
        assert (walls.area[0][outer] < 0).all()
    if (slot := part.keyway) is not None:
        # out of the material: from the floor outwards, to the free end, and from the side at y > 0 back
        planes = (normal[0], -normal[1], normal[2])
        areas = [float(area[slots & (along > 0.999)].sum()) * copies for along in planes]
        r = max(s.start[0] for s in part.meridian.segments if s.start[1] > slot.start)
        side, end = sqrt(r**2 - slot.half_width**2) - slot.floor, slot.section_mm2(r)
        sizes = 2 * slot.half_width * slot.length, 2 * side * slot.length, end
        assert areas == pytest.approx(sizes, rel=1e-3)
    assert (slots.any(), (~slots).any()) == (part.keyway is not None, part.bolts is not None)


def test_a_fillet_that_a_slot_s_plane_would_cross_far_from_it_is_no_wall() -> None:
    """Its curved facets' middles are a little off it, and one may be nearer to that plane."""
    keyed = part_of("shaft, a keyway beyond its grip")
    body = keyed.without_holes()
    mesh = swept_mesh(body, sector_of(body, "torsion").degrees, first_spec(body))
    assert mesh is not None
    centres = mesh.nodes[mesh.facets[mesh.facet_patch == mesh.patches.index("")]].mean(axis=1)
    off = np.min(
        [np.linalg.norm(s.project(centres) - centres, axis=1)
         for s in part_surfaces(body, mesh.sector_deg)], axis=0,
    )  # fmt: skip
    on_fillet = centres[off.argmax()]
    assert off.max() > 1e-5
    shape = keyed.shape.model_dump() | {"keyway": {
        "width_mm": 2 * float(on_fillet[1]), "depth_mm": 3.0, "length_mm": 16.0,
    }}  # fmt: skip
    other = replace(keyed, shape=type(keyed.shape)(**shape))
    assert other.keyway is not None
    middles = mesh.nodes[wall_facets(mesh, other)].mean(axis=1)
    assert (middles[:, 2] > other.keyway.start).all()


def test_a_mesh_without_walls_is_refused() -> None:
    """Of the part without holes: that would make K the whole body's, and nothing would tell."""
    part = part_of("cup, two large holes")
    whole = part.without_holes()
    mesh = swept_mesh(whole, sector_of(part, "torsion").degrees, first_spec(part))
    assert mesh is not None
    with pytest.raises(MeshQualityError, match="no facet"):
        Walls.of(mesh, part)
