"""A study's row where a mesh may not be refined any more: K with its bounds, and no peak that might move."""

from __future__ import annotations

import tomllib

import pytest
from example_files import EXAMPLES

from flexspline.pipeline.study.evaluate import Task, evaluate

EXAMPLE = EXAMPLES / "xb1-40.toml"
VALUES = {
    "flexspline.wall_thickness_mm": 0.4321,
    "flexspline.ring_thickness_mm": 0.5432,
    "shaft.segment[1].outer_diameter_mm": 17.123,
}
"""Parts of their own: solved parts are remembered."""


@pytest.fixture
def few_triangles(monkeypatch) -> None:
    for module in ("torsion", "peak_refinement"):
        monkeypatch.setattr(f"flexspline.fea.axisymmetric.{module}.MOST_TRIANGLES", 10)


@pytest.mark.parametrize("solve", ["ellipse", "torque"])
def test_an_unsettled_peak_is_a_reason(solve, few_triangles) -> None:
    tables = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    row = evaluate(Task(tables, VALUES, (solve,)))
    assert not [key for key in row.figures if "mises" in key]
    assert "a mesh of more than 10 elements is not refined" in row.reason


def test_a_solve_that_fails_leaves_the_others_figures(few_triangles) -> None:
    tables = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    row = evaluate(Task(tables, VALUES, ("ellipse", "torsion")))
    assert row.figures["K_b_Nm_per_rad"] > 0
    assert row.figures["backlash_arcsec.total"] > 0
    assert row.figures["flexspline_mass_g"] > 0
    assert row.reason.startswith("wave_generator_peak: ")
    assert "wave_generator_peak_mises_MPa" not in row.figures


def test_a_stiffness_comes_with_its_bounds(few_triangles) -> None:
    tables = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    row = evaluate(Task(tables, VALUES, ("torsion",)))
    lower, upper = (row.figures[f"K_b_bounds_Nm_per_rad[{end}]"] for end in (0, 1))
    assert lower < row.figures["K_b_Nm_per_rad"] < upper
    assert (upper - lower) / lower > 2e-3  # wider than studies ask for, and in the row
