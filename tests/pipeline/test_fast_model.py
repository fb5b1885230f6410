"""A design while its dimensions move: the same answers as in one go, and a first one before them."""

from __future__ import annotations

import tomllib

import pytest

from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import design_from
from flexspline.geometry.template import template
from flexspline.pipeline import fast_model
from flexspline.pipeline.peak_with_holes import peak_tolerance
from flexspline.pipeline.revolved import revolved
from flexspline.pipeline.rim_case import RIM_CASES

HOLED = design_from(tomllib.loads(template("cup")))
CUP = revolved(HOLED)


def walled(wall_mm: float) -> Design:
    return with_values(CUP, {"flexspline.wall_thickness_mm": wall_mm})


def test_the_last_of_the_refinements_is_what_is_found_in_one_go() -> None:
    design = walled(0.4137)  # no other test asks for it, so its refinement has not begun
    own = design.material.flexspline
    first = fast_model.first_field(design)
    last = fast_model.field(design, "wave_generator")
    whole = ellipse_stress(
        design.part("flexspline").meridian, Elastic(own.youngs_modulus_GPa * 1e3, own.poissons_ratio),
        design.gear.centre_distance_mm, 0.4137, peak_tolerance(design.solver.tolerance),
    )  # fmt: skip
    assert len(first.levels) < len(last.levels) == len(whole.levels)
    # the page solves for 1 GPa and 1 mm and scales: equal but for rounding
    assert last.peak.mises_MPa == pytest.approx(whole.peak.mises_MPa, rel=1e-9)
    # two rounds of refinement change the peak by the tolerance at most; before them it is coarser
    assert first.peak.mises_MPa == pytest.approx(last.peak.mises_MPa, rel=0.15)


def test_a_first_answer_after_the_last_leaves_it_as_it_is() -> None:
    design, other = walled(0.42), walled(0.43)
    last = fast_model.field(design, "wave_generator")
    fast_model.first_field(other)
    assert fast_model.field(design, "wave_generator").peak == last.peak
    assert fast_model.field(other, "wave_generator").peak.mises_MPa != last.peak.mises_MPa


def test_refinements_cut_short_say_so(monkeypatch: pytest.MonkeyPatch) -> None:
    design = walled(0.4437)  # no other test asks for it, so it is not remembered
    monkeypatch.setattr("flexspline.fea.axisymmetric.peak_refinement.MOST_TRIANGLES", 10)
    assert fast_model.first_field(design).levels  # the first mesh is not refused
    ended = fast_model.field(design, "wave_generator")
    assert len(ended.levels) == 1
    assert "a mesh of more than 10 elements is not refined" in ended.peak.shortfall.words
    monkeypatch.undo()
    assert not fast_model.field(walled(0.4537), "wave_generator").peak.shortfall


def test_a_shaft_without_its_holes_and_teeth_as_a_ring_have_no_guaranteed_bounds() -> None:
    assert HOLED.flexspline.bolt_count
    assert HOLED.shaft.bolt_count
    kinds = [[k.guaranteed for k in fast_model.torsion(design)] for design in (CUP, HOLED)]
    assert kinds == [[True, True], [True, False]]
    toothed = with_values(CUP, {"flexspline.bolt_count": 0})
    drawn = toothed.flexspline.model_copy(update={"teeth": "drawn"})
    kinds = [
        k.guaranteed for k in fast_model.torsion(toothed.model_copy(update={"flexspline": drawn}))
    ]
    assert kinds == [False, True]


def test_lobe_cases_are_estimates() -> None:
    assert not any(fast_model.rim(CUP, case).guaranteed for case in RIM_CASES)


@pytest.mark.parametrize(("cup", "wall_mm"), [(CUP, 0.4237), (HOLED, 0.4337)])
def test_the_first_answer_at_the_lobes_holds_the_last(cup: Design, wall_mm: float) -> None:
    design = with_values(cup, {"flexspline.wall_thickness_mm": wall_mm})  # nobody asked for it
    first, last = fast_model.first_lobes(design), fast_model.rim(design, "lobes")
    assert len(first.levels) == 1 < len(last.levels)
    assert first.lower_Nm_per_rad < last.lower_Nm_per_rad < last.upper_Nm_per_rad
    assert last.upper_Nm_per_rad <= first.upper_Nm_per_rad
    assert last.half_width < design.solver.tolerance < first.half_width
