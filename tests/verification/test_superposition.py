"""What bolt holes change, solved alone on a coarse mesh, against models that solve all of the part.

Three ways to know that it is right:

- The solid model of the same part on a finer mesh, with the error that it says: there is no u₀ in it.
- Both fields lie above K, and nearer on a finer mesh: v_h stores less than v, and the part's own field u_h
  stores more than u.
- Betti's theorem: K = K₀ + ∫ (σ₀ n)·u over the walls. With u_h in place of u this is off by
  a(v − v_h, u − u_h), so by less than the root of both fields' errors, and knows nothing of v_h.
"""

from __future__ import annotations

import tomllib
from functools import cache
from itertools import islice
from math import sqrt
from typing import Any

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.recovery import R_THETA, THETA_Z
from flexspline.fea.axisymmetric.torsion import solved_torsions
from flexspline.fea.cylindrical import TANGENTIAL
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.field_solver import CORRECTION_SCALES, FULL_SCALES
from flexspline.fea.solid.load_cases import (
    SolvedCorrection,
    SolvedStiffness,
    torsion_and_correction,
)
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.superposition import Walls, WholeTurned, at_holes, wall_facets
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.types import NMM_PER_NM, Elastic, TetMesh
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import part_surfaces
from flexspline.geometry.symmetry import sector_of

WIDTH = 2e-5
"""Of K₀'s bounds, relative."""
FINER = 0.5
"""Edges of the finer mesh."""
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
}  # fmt: skip


@cache
def part_of(case: str) -> Part:
    file, name, changes = CASES[case]
    data = tomllib.loads((EXAMPLES / file).read_text(encoding="utf-8"))
    data[name] |= changes
    return design_from(data).part(name)  # type: ignore[arg-type]


@cache
def whole_of(case: str) -> WholeTurned:
    part, body = part_of(case), part_of(case).without_holes()
    box, longest_mm = at_holes(part)
    solves = solved_torsions(
        body.meridian, Elastic.of(part.material), body.driven, WIDTH, box, longest_mm
    )
    coarser, finer = islice(solves, 2)
    return WholeTurned(part, finer, coarser)


@cache
def mesh_of(case: str, edges: float) -> TetMesh:
    part = part_of(case)
    mesh = swept_mesh(part, sector_of(part, "torsion").degrees, first_spec(part).scaled(edges))
    assert mesh is not None
    return mesh


@cache
def solved(case: str, edges: float) -> tuple[SolvedStiffness, SolvedCorrection]:
    part = part_of(case)
    model = Model.of(mesh_of(case, edges), Elastic.of(part.material))
    return torsion_and_correction(model, part.driven, whole_of(case))


def superposed(case: str, edges: float) -> tuple[float, float]:
    """K by v_h, and its estimated error, unscaled [N·m/rad]."""
    _, correction = solved(case, edges)
    K = whole_of(case).solved.stiffness.K_Nm_per_rad - correction.lost / NMM_PER_NM
    error = energy_error(
        correction.mesh, correction.displacement, Elastic.of(part_of(case).material)
    )
    return K, float(error.error.sum()) * 360 / correction.mesh.sector_deg / NMM_PER_NM


@pytest.mark.parametrize("case", CASES)
def test_a_coarse_mesh_knows_more_of_the_holes_than_a_fine_one_of_the_part(
    case: str, record
) -> None:
    K, error = superposed(case, 1.0)
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
    coarse_own, _ = solved(case, 1.0)
    assert K < own.K_energy < coarse_own.K_energy
    # the reason for it all: the coarse mesh's own K is off by ten times as much, and more
    assert coarse_own.K_energy - fine > 10 * (K - fine)


@pytest.mark.parametrize("case", CASES)
def test_by_Bettis_theorem_it_is_the_same(case: str) -> None:
    whole, mesh = whole_of(case), mesh_of(case, 1.0)
    own, _ = solved(case, 1.0)
    walls, turn, material = (
        Walls.of(mesh, whole.part),
        whole.solved.turn,
        Elastic.of(whole.part.material),
    )
    psi = walls.places(turn.space).see(turn.psi)
    shear = material.mu * walls.r.ravel() * psi.grad
    pull = walls.pull({R_THETA: shear[0], THETA_Z: shear[1]})
    moved = np.einsum("aq,kad,cdkq->ckq", walls.shapes, own.displacement[walls.facets], walls.axes)
    work = float(np.sum(pull * moved)) * 360 / mesh.sector_deg / NMM_PER_NM
    by_betti = whole.solved.stiffness.K_Nm_per_rad + work
    K, _ = superposed(case, 1.0)
    best = superposed(case, FINER)
    limit = best[0] - 2 * CORRECTION_SCALES.usual * best[1]
    # K₀ and u₀ are off by WIDTH themselves
    allowed = sqrt((K - limit) * (own.K_energy - limit)) + 2 * WIDTH * K
    assert by_betti == pytest.approx(K, abs=allowed)
    assert allowed < own.K_energy - K  # less than what it would be off by alone


@pytest.mark.parametrize("case", CASES)
def test_the_doubt_is_how_far_a_coarser_body_without_holes_moves_it(case: str) -> None:
    """To first order: what is left out is the square of it."""
    whole, part = whole_of(case), part_of(case)
    far = next(
        solved_torsions(
            part.without_holes().meridian, Elastic.of(part.material), part.driven, 0.05,
            at_holes(part)[0], 100.0,
        )
    )  # fmt: skip
    model = Model.of(mesh_of(case, 1.0), Elastic.of(part.material))
    _, fine = torsion_and_correction(model, part.driven, WholeTurned(part, whole.solved, far))
    _, coarse = torsion_and_correction(model, part.driven, WholeTurned(part, far, far))
    assert coarse.doubt == 0
    moved, of_holes = abs(coarse.lost - fine.lost), fine.lost
    assert fine.doubt == pytest.approx(moved, abs=10 * moved**2 / of_holes + 1e-9 * of_holes)
    _, usual = solved(case, 1.0)
    assert usual.doubt <= fine.doubt


@pytest.mark.parametrize("case", CASES)
def test_the_walls_are_those_of_the_holes(case: str) -> None:
    part, mesh = part_of(case), mesh_of(case, 1.0)
    facets = wall_facets(mesh, part_surfaces(part, mesh.sector_deg))
    walls, bolts = Walls.of(mesh, part), part.bolts
    assert bolts is not None
    x, y = walls.r * np.cos(walls.phi), walls.r * np.sin(walls.phi)
    away = np.min([np.hypot(x - a, y - b) for a, b in bolts.centres], axis=0)
    wall = np.abs(away / bolts.hole_radius - 1) < 1e-3  # parabolas for arcs
    assert (walls.z[~wall] == pytest.approx(part.hole_depth)) if (~wall).any() else True
    area = np.linalg.norm(walls.area, axis=0)
    sizes = 2 * np.pi * bolts.hole_radius * part.hole_depth, np.pi * bolts.hole_radius**2
    for mine, size in zip((wall, ~wall), sizes, strict=True):
        if mine.any():  # the floor of a blind hole
            found = float(area[mine].sum()) * 360 / mesh.sector_deg
            assert found == pytest.approx(bolts.count * size, rel=1e-3)
    # the normal leaves the material: into the hole, so on the far side of it back to the axis
    outer = wall & (walls.r > bolts.radius + bolts.hole_radius / 2)
    assert (walls.area[0][outer] < 0).all()
    assert len(facets) == len(walls.facets)
    assert not np.isin(facets, mesh.on("mount")).all(axis=1).any()
    assert np.abs(walls.area[TANGENTIAL]).max() > 0


def test_a_mesh_without_walls_is_refused() -> None:
    """Of the part without holes: that would make K the whole body's, and nothing would tell."""
    part = part_of("cup, two large holes")
    whole = part.without_holes()
    mesh = swept_mesh(whole, sector_of(part, "torsion").degrees, first_spec(part))
    assert mesh is not None
    with pytest.raises(MeshQualityError, match="no facet"):
        Walls.of(mesh, part)
