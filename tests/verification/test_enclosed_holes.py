"""K_b of parts with bolt holes between two bodies of revolution, against models that have the holes.

Two ways to know that the enclosure is right, both from the tetrahedra of the part itself:

- Its own K, with the error that it says. Another discretisation, another formulation, the holes drawn.
- The proof, carried out on its field. What is left of that field in the cut body is admissible there, so its
  energy there is at least the cut body's; what is left of the whole body's field in the part with its holes
  is admissible in that, so its energy there is at least the part's.
"""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.elements import basis_of, displacement_gradient
from flexspline.fea.solid.field_solver import FULL_SCALES
from flexspline.fea.solid.load_cases import lobes, torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.solved import Solved, SolvedStiffness
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.types import Elastic, Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.part import Part
from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline import revolved
from flexspline.pipeline.enclosure import two_bodies

FINE = 2e-4
"""Of the meridian's bounds: a tenth of what the holes do to xb1-40."""
SPLIT = 2e-3
"""What a cut through elements may do to an integral over their quadrature points: the split elements hold a
few hundredths of the energy, and their points miss the cut volume by a few hundredths."""
CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "cup, six holes": ("xb1-40.toml", {}),
    "cup, four large holes": (
        "xb1-40.toml", {"bolt_count": 4, "bolt_hole_diameter_mm": 4.0},
    ),
    "cup, eight holes in a thin boss": (
        "xb1-40.toml",
        {"bolt_count": 8, "boss_thickness_mm": 0.9, "boss_diameter_mm": 20.0,
         "bolt_circle_diameter_mm": 15.0, "bolt_hole_diameter_mm": 3.0},
    ),
    "hat, twelve holes": ("hat-25.toml", {}),
    "hat, six large holes in a thin flange": (
        "hat-25.toml",
        {"bolt_count": 6, "bolt_hole_diameter_mm": 7.0, "flange_thickness_mm": 1.0},
    ),
}  # fmt: skip
FINEST_KNOWN = 31_322.0
"""N·m/rad of xb1-40, the the finest mesh known, good to 0.02 %."""


def design_of(case: str) -> Design:
    file, changes = CASES[case]
    data = tomllib.loads((EXAMPLES / file).read_text(encoding="utf-8"))
    data["flexspline"] |= changes
    return design_from(data)


@cache
def model_of(case: str, whole: bool, degrees: float | None = None) -> Model:
    """The tetrahedra of the part or of its whole body, swept; the torsion sector or that of `degrees`."""
    part = design_of(case).part("flexspline")
    sector = sector_of(part, "torsion").degrees
    if whole:
        part = nested_bodies(part).whole
    mesh = swept_mesh(part, sector, first_spec(part))
    assert mesh is not None
    return Model.of(mesh if degrees is None else unfolded(mesh, degrees), Elastic.of(part.material))


@cache
def twisted(case: str, whole: bool = False) -> SolvedStiffness:
    return torsion(model_of(case, whole), "mesh")


def exact(body: Part) -> Stiffness:
    return revolved.torsion(body, FINE)


def energy_K(solved: Solved, material: Elastic, keep: Any) -> float:
    """K [N·m/rad] of the field where `keep` says so of points (m, q, 3), by quadrature, whole part."""
    mesh = solved.mesh
    basis = basis_of(mesh.curved.mesh)
    grad = displacement_gradient(basis, solved.displacement[mesh.cells])
    strain = (grad + grad.swapaxes(2, 3)) / 2
    trace = np.trace(strain, axis1=2, axis2=3)
    density = 2 * material.mu * (strain**2).sum((2, 3)) + material.lam * trace**2
    places = np.moveaxis(np.asarray(basis.global_coordinates()), 0, -1)
    return float((density * basis.dx)[keep(places)].sum() * 360 / mesh.sector_deg / 1000)


OFTEN_LIKE = ("cup, four large holes", "hat, six large holes in a thin flange")
"""Cups and hats with other holes stay by default."""


@pytest.mark.parametrize(
    "case", [pytest.param(c, marks=[pytest.mark.long] * (c in OFTEN_LIKE)) for c in CASES]
)
def test_the_solid_part_lies_between(case: str, record) -> None:
    part = design_of(case).part("flexspline")
    found = two_bodies(part, exact).enclosure()
    solved, material = twisted(case), Elastic.of(part.material)
    error = energy_error(solved.mesh, solved.displacement, material).relative
    record(
        f"K_b of {case}, one coarse mesh", "middle of the enclosure", found.K_Nm_per_rad,
        solved.K_energy * (1 - FULL_SCALES.usual * error), "N·m/rad",
    )  # fmt: skip
    assert found.guaranteed
    assert solved.K_energy > found.lower_Nm_per_rad  # prescribed rotation: from above
    assert solved.K_energy * (1 - 2 * FULL_SCALES.usual * error) < found.upper_Nm_per_rad


@pytest.mark.parametrize("case", CASES)
def test_what_is_left_of_the_field_in_the_cut_body_is_admissible_there(case: str) -> None:
    part = design_of(case).part("flexspline")
    solved, material, bolts = twisted(case), Elastic.of(part.material), part.bolts
    assert bolts is not None
    all_of_it = energy_K(solved, material, lambda xyz: np.ones(xyz.shape[:2], bool))
    assert all_of_it == pytest.approx(solved.K_energy, rel=1e-6)  # the forms of the solver
    cup = part.shape.kind == "cup"
    edge = bolts.radius + bolts.hole_radius if cup else bolts.radius - bolts.hole_radius

    def kept(xyz: np.ndarray) -> np.ndarray:
        r = np.hypot(xyz[..., 0], xyz[..., 1])
        return r > edge if cup else r < edge

    left = energy_K(solved, material, kept)
    assert left >= exact(nested_bodies(part).cut).lower_Nm_per_rad * (1 - SPLIT)
    assert left < solved.K_energy


@pytest.mark.parametrize("case", CASES)
def test_what_is_left_of_the_whole_field_in_the_part_is_admissible_there(case: str) -> None:
    part = design_of(case).part("flexspline")
    solved, material, bolts = twisted(case, whole=True), Elastic.of(part.material), part.bolts
    assert bolts is not None

    def solid(xyz: np.ndarray) -> np.ndarray:
        away = np.linalg.norm(xyz[..., None, :2] - np.array(bolts.centres), axis=-1).min(-1)
        return (away > bolts.hole_radius) | (xyz[..., 2] > part.hole_depth)

    left = energy_K(solved, material, solid)
    own = twisted(case)
    error = energy_error(own.mesh, own.displacement, material).relative
    assert left * (1 + SPLIT) > own.K_energy * (1 - 2 * FULL_SCALES.usual * error)
    assert left > exact(nested_bodies(part).cut).lower_Nm_per_rad
    assert left < solved.K_energy


@pytest.mark.parametrize(
    "case", ["cup, six holes", pytest.param("hat, twelve holes", marks=pytest.mark.long)]
)
def test_the_lobe_load_on_the_part_lies_between(case: str, record) -> None:
    """A load's work 2L(u) − a(u, u) is largest at the solution, so a coarse mesh gives too large a K."""
    part = design_of(case).part("flexspline")
    degrees = sector_of(part, "lobes").degrees
    found = two_bodies(part, lambda body: revolved.lobes(body, True, 0.002)).enclosure()
    solved, material = lobes(model_of(case, False, degrees), True), Elastic.of(part.material)
    error = energy_error(solved.mesh, solved.displacement, material).relative
    record(
        f"K_b of {case}, lobes, one coarse mesh", "middle of the enclosure", found.K_Nm_per_rad,
        solved.K_energy * (1 - FULL_SCALES.usual * error), "N·m/rad",
    )  # fmt: skip
    assert not found.guaranteed
    assert solved.K_energy > found.lower_Nm_per_rad
    assert solved.K_energy * (1 - 2 * FULL_SCALES.usual * error) < found.upper_Nm_per_rad


def test_the_finest_known_answer_lies_within(record) -> None:
    found = two_bodies(design_of("cup, six holes").part("flexspline"), exact).enclosure()
    record(
        "K_b of xb1-40 by two bodies of revolution", "the finest mesh known",
        FINEST_KNOWN, found.K_Nm_per_rad, "N·m/rad",
    )  # fmt: skip
    assert found.lower_Nm_per_rad < FINEST_KNOWN < found.upper_Nm_per_rad
    assert found.half_width < 0.0008  # ± 0.08 %, of which the holes are 0.06 %
