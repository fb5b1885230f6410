"""K_e of a hat's shaft, held on its whole first face: by how much it is too large, and where that is said."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace

import pytest
from example_files import EXAMPLES
from study_bench import study_of

import flexspline
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline.first_face import (
    LEAST_SHARE,
    excess,
    held_beyond_flange,
    too_large_lines,
    touches,
)
from flexspline.pipeline.given import DesignWarning
from flexspline.pipeline.revolved import torsion
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.slope import Slope
from flexspline.results.limit_words import stiffness_notes
from flexspline.results.studio.answer import agreement, design_warnings_shown, without
from flexspline.results.study.design_warnings import design_warnings
from flexspline.results.study.sensitivity import record

THICKNESS = "shaft.segment[0].length_mm"
STUDY = f"""
design = "hat-25.toml"
[vary]
"{THICKNESS}" = {{ values = [4.0, 8.0, 12.0] }}
[objective]
"K_e_Nm_per_rad" = "maximize"
[run]
method = "grid"
"""
HAT = load_design(EXAMPLES / "hat-25.toml")
CUP = load_design(EXAMPLES / "xb1-40.toml")


def with_face_hollowed(design: Design, depth_mm: float) -> Design:
    """The remedy: the first segment split, its first part hollow up to the flange."""
    first, *others = design.shaft.segment
    inner = design.flexspline.size(design.flexspline.land.inner)
    split = [
        first.model_copy(update={"length_mm": depth_mm, "inner_diameter_mm": inner}),
        first.model_copy(update={"length_mm": first.length_mm - depth_mm}),
    ]
    shaft = design.shaft.model_copy(update={"segment": (*split, *others)})
    return design.model_copy(update={"shaft": shaft})


@pytest.mark.parametrize("thick", [4.0, 8.0, 12.0])
def test_the_excess_is_that_of_a_shaft_with_its_face_hollowed_to_the_flange(thick: float) -> None:
    """Another outline, with no other patch: hollowed by 0.02 mm, the limit of the remedy. It twists by
    0.02 mm of a ring more, 1 % of the shaft's twist at the most."""
    whole = HAT.changed({THICKNESS: thick})
    K, K_hollow = (
        torsion(d.part("shaft").without_holes(), 0.002).K_Nm_per_rad
        for d in (whole, with_face_hollowed(whole, 0.02))
    )
    found = excess(whole)
    assert found is not None
    assert 1 + found == pytest.approx(K / K_hollow, rel=0.01)


def test_it_is_the_more_too_large_the_thinner_the_flange() -> None:
    """Held under the flange alone, a thicker disc is stiffer; held on the whole face, it only lengthens."""
    found = [excess(HAT.changed({THICKNESS: thick})) or 0.0 for thick in (4.0, 8.0, 12.0, 40.0)]
    assert found == sorted(found, reverse=True)
    assert found[0] > 0.5
    assert found[-1] < 0.02  # of what it is at 4 mm, a thirtieth: thicker than the flange is wide


def test_the_warning_says_how_much_and_its_remedy_ends_it() -> None:
    (line,) = too_large_lines(HAT)
    assert re.search(r"too large by about 22 %", line)
    assert "length_mm = 0.5 and inner_diameter_mm = 78" in line
    assert THICKNESS in line
    remedied = with_face_hollowed(HAT, 0.5)
    assert not too_large_lines(Design.model_validate(remedied.tables))
    assert not too_large_lines(CUP)


def with_face(inner_mm: float, outer_mm: float) -> Design:
    """Of the hat's shaft, whose hub is 46 mm and the flange from 78 to 96 mm."""
    wide = {"shaft.segment[1].outer_diameter_mm": 110.0} if inner_mm > 46.0 else {}
    return HAT.changed({
        "shaft.bolt_count": 0,
        "flexspline.bolt_count": 0,
        "shaft.segment[0].inner_diameter_mm": inner_mm,
        "shaft.segment[0].outer_diameter_mm": outer_mm,
        **wide,
    })  # fmt: skip


@pytest.mark.parametrize("outer_mm", [60.0, 78.0, 78.0001, 78.1])
def test_where_the_flange_does_not_touch_the_shaft_the_remedy_makes_it(outer_mm: float) -> None:
    """Two sharp edges, each broken by up to 0.05 mm (ISO 13715), leave nothing of a ring of 0.05 mm."""
    apart = with_face(30.0, outer_mm)
    assert held_beyond_flange(apart)
    assert not touches(apart)
    assert excess(apart) is None
    (line,) = too_large_lines(apart)
    assert "which the hat's flange does not touch" in line
    assert "inner_diameter_mm = 78" not in line
    (key, value) = re.findall(r"Remedy: (shaft\S+) = (\S+)$", line)[0]
    remedied = apart.changed({key: float(value)})
    assert touches(remedied)
    assert "too large by about" in too_large_lines(remedied)[0]


def test_a_face_outside_the_flange_does_not_touch_it_either() -> None:
    outside = with_face(97.0, 120.0)
    (line,) = too_large_lines(outside)
    assert line.endswith("Remedy: shaft.segment[0].inner_diameter_mm = 78")
    assert not too_large_lines(with_face(78.0, 120.0))


def test_a_ring_wider_than_two_broken_edges_touches() -> None:
    assert "too large by about" in too_large_lines(with_face(30.0, 78.3))[0]


def test_nothing_is_said_below_the_estimates_accuracy() -> None:
    """A shaft as wide as the flange, held 0.5 mm beyond it: the twist is all along the shaft."""
    tube = with_face(77.0, 96.0)
    share = excess(tube)
    assert share is not None
    assert abs(share) < LEAST_SHARE
    assert held_beyond_flange(tube)
    assert not too_large_lines(tube)
    assert not stiffness_notes(tube)
    assert not held_beyond_flange(with_face(77.9, 96.0))
    assert held_beyond_flange(with_face(77.7, 96.0))


def test_a_study_says_it_of_its_best_design() -> None:
    study = study_of(STUDY)
    rows = tuple(
        Row(i, {THICKNESS: t}, Outcome({"K_e_Nm_per_rad": 1e6 / t}))
        for i, t in enumerate((4.0, 8.0, 12.0))
    )
    (line,) = design_warnings(StudyResult(study, rows))
    assert line.startswith("design 0 (in 3 of 3 designs): K_e is too large by about 65 %")
    unsolved = replace(study, design=HAT)
    (line,) = design_warnings(StudyResult(unsolved, ()))
    assert "K_e is too large by about 22 %" in line


def test_a_sensitivity_says_it() -> None:
    slope = Slope(THICKNESS, "shaft", 8.0, -1.0, -1.0, 0.1, 6e5, None)
    assert record(HAT, [slope])["warnings"] == list(too_large_lines(HAT))
    assert record(CUP, [slope])["warnings"] == []


def test_the_live_page_says_it_at_once() -> None:
    assert any("K_e is too large" in line for line in design_warnings_shown(HAT))
    assert "K_e is too large" in agreement(HAT)
    assert without("K_e", HAT).endswith("too large")
    assert not any("K_e" in line for line in design_warnings_shown(CUP))
    assert "too large" not in agreement(CUP) + without("K_e", CUP)


def test_python_warns_of_it() -> None:
    plain = HAT.changed({"shaft.bolt_count": 0, "flexspline.bolt_count": 0})
    with pytest.warns(DesignWarning, match="K_e is too large") as caught:
        flexspline.stiffness(plain, "shaft")
    assert caught[0].filename == __file__
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        flexspline.stiffness(plain, "flexspline")
        flexspline.backlash(plain, K_b=1e5, K_e=1e5)
    assert not [w for w in told if "K_e" in str(w.message)]
