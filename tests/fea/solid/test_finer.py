"""Swept meshes made finer by their errors."""

from __future__ import annotations

import tomllib

from example_files import EXAMPLES

from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.finer import finer_by_error
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.torsion_field import FullTorsion
from flexspline.fea.types import Elastic, TetMesh
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part
from flexspline.geometry.symmetry import sector_of


def shaft_with_blind_holes() -> Part:
    """Their floors' edges are singular, and no corner of the meridian is near."""
    data = tomllib.loads((EXAMPLES / "xb1-40.toml").read_text(encoding="utf-8"))
    data["shaft"] |= {
        "fillet_mm": 0.0, "bolt_count": 6, "bolt_circle_diameter_mm": 20.0, "bolt_hole_diameter_mm": 6.0,
        "segment": [
            {"length_mm": 3.0, "outer_diameter_mm": 30.0, "inner_diameter_mm": 12.0},
            {"length_mm": 8.0, "outer_diameter_mm": 36.0, "inner_diameter_mm": 12.0},
        ],
    }  # fmt: skip
    return design_from(data).part("shaft")


def test_a_swept_mesh_by_its_errors_is_better_than_an_even_one() -> None:
    """K of each mesh is an upper bound of K, so that the smaller one is nearer to it."""
    part = shaft_with_blind_holes()
    degrees, first = sector_of(part, "torsion").degrees, first_spec(part).scaled(2.0)
    field = FullTorsion(Elastic.of(part.material), "grip")

    def swept(finer: float) -> TetMesh:
        mesh = swept_mesh(part, degrees, first.scaled(1 / finer))
        assert mesh is not None
        return mesh

    mesh = swept_mesh(part, degrees, first)
    assert mesh is not None
    assert not mesh.in_layers
    errors = field.solve(Model.of(mesh, field.material)).errors
    by_error = finer_by_error(part, mesh, errors, 2 * mesh.elements)
    assert 2 * mesh.elements <= by_error.elements
    even = swept(1.5)
    assert even.elements > by_error.elements
    K = [field.solve(Model.of(m, field.material)).K_Nm_per_rad for m in (mesh, by_error, even)]
    assert K[1] < K[2] < K[0]
