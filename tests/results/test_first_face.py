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
from flexspline.pipeline.first_face import excess, held_beyond_flange, too_large_lines
from flexspline.pipeline.given import DesignWarning
from flexspline.pipeline.revolved import torsion
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.slope import Slope
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


def test_where_the_flange_does_not_reach_the_shaft_no_figure_is_said() -> None:
    first = HAT.shaft.segment[0].model_copy(update={"outer_diameter_mm": 70.0})
    shaft = HAT.shaft.model_copy(update={"segment": (first, *HAT.shaft.segment[1:])})
    narrow = HAT.model_copy(update={"shaft": shaft})
    assert held_beyond_flange(narrow)
    assert excess(narrow) is None
    assert "too large:" in too_large_lines(narrow)[0]


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
