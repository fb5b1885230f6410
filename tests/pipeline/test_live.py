"""A design while its dimensions move: the same answers as in one go, and a first one before them."""

from __future__ import annotations

import tomllib

import pytest

from fea.axisymmetric.stress import ellipse_stress
from fea.axisymmetric.torsion import ToleranceError
from fea.types import Elastic
from geometry.design import Design
from geometry.load import design_from
from geometry.template import template
from pipeline import live
from pipeline.diagnosis.specimens.designs import with_values
from pipeline.rim import STRESS_TOLERANCE

CUP = live.revolved(design_from(tomllib.loads(template("cup"))))


def walled(wall_mm: float) -> Design:
    return with_values(CUP, {"flexspline.wall_thickness_mm": wall_mm})


def test_the_last_of_the_refinements_is_what_is_found_in_one_go() -> None:
    design = walled(0.41)
    own = design.material.flexspline
    first = live.first_field(design)
    last = live.field(design, "wave_generator")
    whole = ellipse_stress(
        live.outline(design.flexspline), Elastic(own.youngs_modulus_GPa * 1e3, own.poissons_ratio),
        design.gear.centre_distance_mm, 0.41, STRESS_TOLERANCE,
    )  # fmt: skip
    assert len(first.levels) == 1 < len(last.levels) == len(whole.levels)
    # the page solves for 1 GPa and 1 mm and scales: equal but for rounding
    assert last.peak.mises_MPa == pytest.approx(whole.peak.mises_MPa, rel=1e-9)
    # two rounds of refinement change the peak by the tolerance at most; before them it is coarser
    assert first.peak.mises_MPa == pytest.approx(last.peak.mises_MPa, rel=0.15)


def test_a_first_answer_after_the_last_leaves_it_as_it_is() -> None:
    design, other = walled(0.42), walled(0.43)
    last = live.field(design, "wave_generator")
    live.first_field(other)
    assert live.field(design, "wave_generator").peak == last.peak
    assert live.field(other, "wave_generator").peak.mises_MPa != last.peak.mises_MPa


def test_refinements_that_fail_are_never_taken_for_the_last(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    design = walled(0.44)
    monkeypatch.setattr("fea.axisymmetric.stress.MOST_TRIANGLES", 10)
    assert live.first_field(design).levels  # the first mesh is not refused
    for _ in range(2):
        with pytest.raises(ToleranceError):
            live.field(design, "wave_generator")
    monkeypatch.undo()
    assert len(live.field(design, "wave_generator").levels) > 1
