"""Whatever `geometry.checks` accepts, the CAD kernel builds, with the right volume and patches."""

from __future__ import annotations

import pytest
from cad_volume import assert_volume
from example_files import EXAMPLES
from hypothesis import HealthCheck, assume, given, settings
from random_parts import Segments, cups, hats, shafts
from shaft_of import shaft_of

from flexspline.geometry.cad import build_solid
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import load_design
from flexspline.geometry.tagged import tagged_surface

SHORT = settings(max_examples=6, deadline=None, derandomize=True)
LONG = settings(
    max_examples=300, deadline=None, suppress_health_check=[HealthCheck.filter_too_much]
)
AREA = 1e-6
"""Relative: the kernel integrates areas to about 1e-8; a lost face is a hundredth at least."""


def flexspline_builds(example: str, changes: dict[str, float]) -> None:
    try:
        design = load_design(EXAMPLES / f"{example}.toml").changed(changes)
    except DesignError:
        assume(False)
    assert_volume(design, "flexspline")
    assert_patches(design, "flexspline", ("mesh", "seat"))


def shaft_builds(segments: Segments, text: str, fillet: float) -> None:
    try:
        design = shaft_of(segments, text, fillet)
    except DesignError:
        assume(False)
    if design.shaft.keyway:
        assert build_solid(design.part("shaft")).Volume() < design.part("shaft").meridian.volume
        assert tagged_surface(design.part("shaft"), 360.0, 0.05, 1.0).patch_areas["grip"] > 0
    else:
        assert_volume(design, "shaft")
        assert_patches(design, "shaft", ("grip", "mount"))


def assert_patches(design: Design, part: str, patches: tuple[str, ...]) -> None:
    areas = tagged_surface(design.part(part), 360.0, 0.05, 1.0).patch_areas
    for patch in patches:
        assert areas[patch] == pytest.approx(design.part(part).meridian.patch_area(patch), rel=AREA)


@given(cups())
@SHORT
def test_cups_build(changes: dict[str, float]) -> None:
    flexspline_builds("xb1-40", changes)


@given(hats())
@SHORT
def test_hats_build(changes: dict[str, float]) -> None:
    flexspline_builds("hat-25", changes)


@given(shafts())
@SHORT
def test_shafts_build(case: tuple[Segments, str, float]) -> None:
    shaft_builds(*case)


@pytest.mark.long
@given(cups())
@LONG
def test_three_hundred_cups_build(changes: dict[str, float]) -> None:
    flexspline_builds("xb1-40", changes)


@pytest.mark.long
@given(hats())
@LONG
def test_three_hundred_hats_build(changes: dict[str, float]) -> None:
    flexspline_builds("hat-25", changes)


@pytest.mark.long
@given(shafts())
@LONG
def test_three_hundred_shafts_build(case: tuple[Segments, str, float]) -> None:
    shaft_builds(*case)
