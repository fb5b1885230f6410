"""Solid K against two-sided axisymmetric bounds (Michell 1899) on hole-free parts.

The references come from another discretisation, another formulation and another mesher.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from fea.axisymmetric.torsion import torsional_stiffness
from fea.solid.cases import Model, torsion
from fea.solid.defaults import CHORD_PER_ENVELOPE, first_spec
from fea.solid.mesh import mesh_surface
from fea.solid.sizing import Grading
from fea.solid.stiffness import solid_stiffness
from fea.solid.stress import energy_error
from fea.types import Elastic
from geometry.design import Design
from geometry.load import design_from
from geometry.meridian import meridian
from geometry.symmetry import sector_of
from geometry.tagged import tagged_surface

EXAMPLES = Path(__file__).parents[2] / "examples"
DRIVEN = {"flexspline": "mesh", "shaft": "grip"}

CASES: dict[str, tuple[str, str, dict[str, Any]]] = {
    "cup, short and thick": (
        "xb1-40.toml", "flexspline",
        {"length_mm": 18.0, "wall_thickness_mm": 0.9, "ring_thickness_mm": 1.2,
         "diaphragm_thickness_mm": 1.2, "ring_width_mm": 6.0},
    ),
    "cup, long and thin": (
        "xb1-40.toml", "flexspline",
        {"length_mm": 44.0, "wall_thickness_mm": 0.25, "ring_thickness_mm": 0.4,
         "diaphragm_thickness_mm": 0.4, "boss_diameter_mm": 22.0},
    ),
    "cup, ring inboard": ("xb1-40.toml", "flexspline", {"ring_offset_mm": 3.0}),
    "hat": ("hat-25.toml", "flexspline", {}),
    "hat, sharp corners": (
        "hat-25.toml", "flexspline", {"inner_fillet_mm": 0.0, "outer_fillet_mm": 0.0},
    ),
    "hat, thick diaphragm": ("hat-25.toml", "flexspline", {"diaphragm_thickness_mm": 1.2}),
    "shaft, hollow, one step": ("xb1-40.toml", "shaft", {}),
    "shaft, slender": ("xb1-40.toml", "shaft", {"segment": [
        {"length_mm": 3.0, "outer_diameter_mm": 24.0, "inner_diameter_mm": 8.0},
        {"length_mm": 40.0, "outer_diameter_mm": 14.0, "inner_diameter_mm": 8.0}]}),
    "shaft, solid, two steps": ("xb1-40.toml", "shaft", {"segment": [
        {"length_mm": 4.0, "outer_diameter_mm": 26.0, "inner_diameter_mm": 0.0},
        {"length_mm": 10.0, "outer_diameter_mm": 16.0, "inner_diameter_mm": 0.0},
        {"length_mm": 14.0, "outer_diameter_mm": 12.0, "inner_diameter_mm": 0.0}]}),
}  # fmt: skip


def hole_free(file: str, part: str, changes: dict[str, Any]) -> Design:
    data = tomllib.loads((EXAMPLES / file).read_text(encoding="utf-8"))
    data["flexspline"]["bolt_count"] = data["shaft"]["bolt_count"] = 0
    data["shaft"].pop("keyway", None)
    data[part] |= changes
    return design_from(data)


@pytest.mark.parametrize("name", CASES)
def test_solid_stiffness_lies_within_its_bounds(name: str) -> None:
    file, part, changes = CASES[name]
    design = hole_free(file, part, changes)
    material = Elastic.of(design.material.flexspline)
    spec = first_spec(design, part)
    sector = sector_of(design, part, "torsion")
    surface = tagged_surface(
        design, part, sector.degrees, CHORD_PER_ENVELOPE * spec.envelope, edge_spacing=0.1
    )
    found = solid_stiffness(
        lambda s: mesh_surface(surface, s), spec, material, DRIVEN[part], 0.005, "1/12", print
    ).stiffness
    # ten times narrower than what is tested
    exact = torsional_stiffness(meridian(design, part), material, DRIVEN[part], 5e-4)
    assert found.K_Nm_per_rad == pytest.approx(exact.K_Nm_per_rad, rel=0.006)  # the demand
    assert found.lower_Nm_per_rad < exact.upper_Nm_per_rad
    assert found.upper_Nm_per_rad > exact.lower_Nm_per_rad
    for level in found.levels:
        assert level.K_Nm_per_rad > exact.lower_Nm_per_rad  # prescribed rotation: from above
        assert level.K_reaction_Nm_per_rad == pytest.approx(level.K_Nm_per_rad, rel=1e-6)


def test_wedge_agrees_with_the_full_model() -> None:
    """Six holes: 1/12 with antisymmetry against the whole cup, meshed apart (the issue: 0.3 %)."""
    design = design_from(tomllib.loads((EXAMPLES / "xb1-40.toml").read_text(encoding="utf-8")))
    material = Elastic.of(design.material.flexspline)
    first = first_spec(design, "flexspline")
    K = {}
    for degrees, unrolled in ((30.0, first.unrolled_radius), (360.0, 0.0)):
        surface = tagged_surface(design, "flexspline", degrees, 0.03, edge_spacing=0.1)
        from dataclasses import replace

        spec = replace(first, unrolled_radius=unrolled, grading=Grading(0.4, 2.0, 1.0))
        mesh = mesh_surface(surface, spec)
        solved = torsion(Model.of(mesh, material), "mesh")
        error = energy_error(mesh, solved.displacement, material).relative
        # both meshes are coarse: compare with the estimated error taken off, scaled alike (1.9)
        K[degrees] = solved.K_energy * (1 - 1.9 * error)
    assert K[30.0] == pytest.approx(K[360.0], rel=0.003)
