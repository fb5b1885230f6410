"""Solid K against two-sided axisymmetric bounds (Michell 1899) on hole-free parts.

The references come from another discretisation, another formulation and another mesher.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace

import pytest
from hole_free import CASES, EXAMPLES, solved

from fea.solid.cases import Model, torsion
from fea.solid.defaults import first_spec
from fea.solid.mesh import mesh_surface
from fea.solid.sizing import Grading
from fea.solid.stress import energy_error
from fea.types import Elastic
from geometry.load import design_from
from geometry.tagged import tagged_surface


@pytest.mark.parametrize("name", CASES)
def test_solid_stiffness_lies_within_its_bounds(name: str, record) -> None:
    pair = solved(name)
    found, exact = pair.solid, pair.exact
    record(
        f"K of {name}", "Michell 1899, bounds", exact.K_Nm_per_rad, found.K_Nm_per_rad, "N·m/rad"
    )
    assert found.K_Nm_per_rad == pytest.approx(exact.K_Nm_per_rad, rel=0.006)  # the demand
    assert found.lower_Nm_per_rad < exact.upper_Nm_per_rad
    assert found.upper_Nm_per_rad > exact.lower_Nm_per_rad
    for level in found.levels:
        assert level.K_Nm_per_rad > exact.lower_Nm_per_rad  # prescribed rotation: from above
        assert level.K_reaction_Nm_per_rad == pytest.approx(level.K_Nm_per_rad, rel=1e-6)


def test_wedge_agrees_with_the_full_model(record) -> None:
    """Six holes: 1/12 with antisymmetry against the whole cup, meshed apart (the issue: 0.3 %)."""
    design = design_from(tomllib.loads((EXAMPLES / "xb1-40.toml").read_text(encoding="utf-8")))
    material = Elastic.of(design.material.flexspline)
    first = first_spec(design, "flexspline")
    K = {}
    for degrees, unrolled in ((30.0, first.unrolled_radius), (360.0, 0.0)):
        surface = tagged_surface(design, "flexspline", degrees, 0.03, edge_spacing=0.1)
        spec = replace(first, unrolled_radius=unrolled, grading=Grading(0.4, 2.0, 1.0))
        mesh = mesh_surface(surface, spec)
        solved = torsion(Model.of(mesh, material), "mesh")
        error = energy_error(mesh, solved.displacement, material).relative
        # both meshes are coarse: compare with the estimated error taken off, scaled alike (1.9)
        K[degrees] = solved.K_energy * (1 - 1.9 * error)
    record("K of the six-hole cup, 1/12 against whole", "symmetry", K[360.0], K[30.0], "N·m/rad")
    assert K[30.0] == pytest.approx(K[360.0], rel=0.003)
