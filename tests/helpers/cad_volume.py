"""A part's volume from its profile and its holes, for comparison with the CAD kernel's."""

from __future__ import annotations

from math import pi

import pytest

from flexspline.geometry.cad import build_solid
from flexspline.geometry.cup import Cup
from flexspline.geometry.design import Design

VOLUME = 1e-7
"""Relative: the kernel integrates volumes to about 1e-8."""


def assert_volume(design: Design, part: str) -> None:
    """CAD volume = Pappus on the profile less the holes."""
    owner = design.shaft if part == "shaft" else design.flexspline
    holes = 0.0
    if owner.bolt_count:
        assert owner.bolt_hole_diameter_mm is not None
        hole = pi / 4 * owner.bolt_hole_diameter_mm**2
        holes = owner.bolt_count * hole * hole_depth(design, part)
    expected = design.part(part).meridian.volume - holes
    assert build_solid(design.part(part)).Volume() == pytest.approx(expected, rel=VOLUME)


def hole_depth(design: Design, part: str) -> float:
    """Material that a bolt hole crosses [mm]."""
    f = design.flexspline
    if part == "shaft":
        return design.shaft.segment[0].length_mm
    return f.boss_thickness_mm if isinstance(f, Cup) else f.flange_thickness_mm
