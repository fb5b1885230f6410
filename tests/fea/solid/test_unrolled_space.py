"""Which parts are meshed in unrolled space: rings, whose radii are far from 0."""

from __future__ import annotations

import pytest
from example_files import EXAMPLES

from flexspline.fea.solid.defaults import first_spec
from flexspline.geometry.load import load_design

CUP, SHAFT = load_design(EXAMPLES / "xb1-40.toml"), {"shaft.bolt_count": 0}
SOLID = {f"shaft.segment.{i}.inner_diameter_mm": 0.0 for i in (0, 1)}


@pytest.mark.parametrize(
    ("part", "changed", "unrolled"),
    [
        ("flexspline", {}, True),
        ("flexspline", {"flexspline.bore_diameter_mm": 0.0}, False),
        ("shaft", SHAFT, True),
        ("shaft", SHAFT | {"shaft.segment.1.inner_diameter_mm": 0.0}, False),
        ("shaft", SHAFT | SOLID, False),
    ],
)
def test_what_reaches_the_axis_is_meshed_in_its_own_space(part, changed, unrolled: bool) -> None:
    design = CUP.changed(changed) if changed else CUP
    assert (first_spec(design.part(part)).unrolled_radius > 0) == unrolled
