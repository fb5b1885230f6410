"""A half of a part that reaches its axis, against the whole part: one plane, on which the axis moves.

The whole is the same mesh mirrored, with no plane at all, so both must agree to rounding. A hole or a keyway
on one side only bends the part, and the axis goes sideways with it.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.types import Elastic
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part

STEEL = Elastic(206e3, 0.3)
ROUNDING = 1e-8
"""Of K: solutions are good to 1e-9."""


def shaft(bore_mm: float) -> Part:
    """One large hole beside the axis."""
    data = tomllib.loads((EXAMPLES / "xb1-40.toml").read_text(encoding="utf-8"))
    data["shaft"] = {
        "bolt_count": 1, "bolt_circle_diameter_mm": 11.0, "bolt_hole_diameter_mm": 4.0,
        "fillet_mm": 0.0, "grip_length_mm": 3.0,
        "segment": [{"length_mm": 12.0, "outer_diameter_mm": 20.0, "inner_diameter_mm": bore_mm}],
    }  # fmt: skip
    return design_from(data).part("shaft")


@pytest.mark.parametrize("bore_mm", [0.0, 3.0])
def test_half_and_whole_agree_in_torsion(bore_mm: float) -> None:
    part = shaft(bore_mm)
    mesh = swept_mesh(part, 180.0, replace(first_spec(part), grading=Grading(1.5, 4.0, 1.0)))
    assert mesh is not None
    half, whole = (
        torsion(replace(Model.of(m, STEEL), solve_by="direct"), "grip")
        for m in (mesh, unfolded(mesh, 360.0))
    )
    on_axis = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1]) == 0
    assert on_axis.any() == (bore_mm == 0)
    assert half.K_energy == pytest.approx(whole.K_energy, rel=ROUNDING)
    # per rad of turn
    assert np.all(half.displacement[on_axis][:, [0, 2]] == 0)
    if bore_mm == 0:
        assert np.abs(half.displacement[on_axis, 1]).max() > 0.01
