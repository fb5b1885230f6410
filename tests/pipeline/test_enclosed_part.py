"""K_b of a design with bolt holes: one coarse solid mesh within an enclosure, and what happens without."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from example_files import EXAMPLES
from wrong_models import stiffen_solid_model, without_torsion

from flexspline.fea.types import Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.load import load_design
from flexspline.pipeline import load_cases, part_stiffness, solid_torsion
from flexspline.pipeline.analysis import stiffnesses
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.enclosed_part import FAR_BOUNDS_PCT, TOO_FAR, bounds_pct, enclosure_of
from flexspline.pipeline.enclosure import two_bodies
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.load_cases import rim_stiffness
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.revolved import rim
from flexspline.pipeline.rim_case import RIM_CASES, held_rim

CUP = load_design(EXAMPLES / "xb1-40.toml")
FINE = CUP.changed({"solver.tolerance_pct": 0.2})
"""The enclosure is ± 0.1 % wide."""
KNOWN_TO = 1e-4
"""Bounds of each body, relative, beside 0.1 % asked."""
WIDE = CUP.changed(
    {
        "flexspline.bolt_count": 6,
        "flexspline.bolt_hole_diameter_mm": 4.4,
        "flexspline.diaphragm_thickness_mm": 1.5,
        "solver.tolerance_pct": 2.0,
    }
)
"""Large holes that leave 0.3 mm of the boss beside them: the two bodies are 5 % apart."""


def model(design: Design, folder: Path) -> PartModel:
    """Its solves are kept in `folder`: the suite's cache where they are those of the program as it is."""
    context = AnalysisContext(design, Cache(folder), Progress())
    return context.part("flexspline")


def test_where_the_enclosure_is_narrow_one_mesh_is_enough(suite_cache: Path) -> None:
    part = model(FINE, suite_cache)
    found = part_stiffness.part_stiffness(part)
    assert len(found.levels) == 1
    assert found.guaranteed
    assert found.half_width <= 0.002
    assert not found.shortfall
    assert found.lower_Nm_per_rad <= found.K_Nm_per_rad <= found.upper_Nm_per_rad


NGSOLVE_Nm_per_rad = 31_322.2
"""K_b of the example cup by NGSolve on its finest mesh (benchmarks/results.json)."""


def test_within_the_enclosure_K_is_that_of_the_part_with_its_holes(suite_cache: Path) -> None:
    """One mesh of the whole field left K 0.03 % low here."""
    found = part_stiffness.part_stiffness(model(CUP, suite_cache))
    assert found.guaranteed
    assert found.K_Nm_per_rad == pytest.approx(NGSOLVE_Nm_per_rad, rel=1e-4)


def test_K_does_not_step_where_the_enclosure_becomes_too_wide(tmp_path: Path) -> None:
    """K of 0.5 % asked: within the enclosure up to holes of 4.1 mm, without it from there on.

    One mesh of the whole field gave 31 344 with holes of 3.8 mm, more than with smaller ones.
    """
    found, fine = (
        [
            part_stiffness.part_stiffness(
                model(
                    CUP.changed(
                        {"flexspline.bolt_hole_diameter_mm": hole, "solver.tolerance_pct": pct}
                    ),
                    tmp_path,
                )
            )
            for hole in (3.8, 4.2)
        ]
        for pct in (0.5, 0.03)
    )
    assert [K.guaranteed for K in found] == [True, False]
    for K, known in zip(found, fine, strict=True):
        assert K.lower_Nm_per_rad <= known.K_Nm_per_rad <= K.upper_Nm_per_rad
        assert K.K_Nm_per_rad == pytest.approx(known.K_Nm_per_rad, rel=2e-4)  # of 0.03 % asked


def test_the_solid_model_by_name_is_refined_as_ever(suite_cache: Path) -> None:
    asked = {"solver.model": "solid", "solver.tolerance_pct": 0.25}
    found = part_stiffness.part_stiffness(model(CUP.changed(asked), suite_cache))
    assert len(found.levels) > 1
    assert not found.guaranteed
    assert found.proven_Nm_per_rad is not None
    lower, upper = found.proven_Nm_per_rad
    assert lower < found.K_Nm_per_rad < upper


def test_every_case_of_the_rim_is_answered(suite_cache: Path, monkeypatch) -> None:
    """On the meridian alone: within the tolerance no tetrahedra are made for them."""

    def never(*given: object) -> None:
        raise AssertionError("a solid model was solved")

    cases = dict(load_cases.CASES)
    for case, by in load_cases.CASES.items():
        monkeypatch.setitem(cases, case, replace(by, with_holes=never) if by.solid else by)
    monkeypatch.setattr(load_cases, "CASES", cases)
    part = model(CUP, suite_cache)
    K = {case: rim_stiffness(part, case) for case in RIM_CASES}
    assert all(k.half_width <= 0.005 and not k.shortfall for k in K.values())
    assert not any(k.guaranteed for k in K.values())
    assert K["lobes_unsupported"].K_Nm_per_rad < K["lobes_contact"].K_Nm_per_rad
    assert K["lobes_contact"].K_Nm_per_rad < K["lobes"].K_Nm_per_rad


@pytest.mark.parametrize("solver", ["auto", "solid"])
def test_a_case_without_a_solid_model_is_enclosed(
    solver: str, suite_cache: Path, monkeypatch
) -> None:
    """A new load case is a solve on a meridian: parts with holes have their figure too, near or wide."""
    alone = load_cases.by_itself("lobes", held_rim)
    monkeypatch.setattr(load_cases, "CASES", {**load_cases.CASES, "lobes": alone})
    near, wide = (
        rim_stiffness(model(part.changed({"solver.model": solver}), suite_cache), "lobes")
        for part in (CUP, WIDE)
    )
    assert near.model == wide.model == "axisymmetric"
    assert near.half_width <= 0.005
    assert not near.shortfall
    assert wide.half_width > 0.02
    assert wide.shortfall.words == TOO_FAR


@pytest.mark.parametrize("by_torsion", [True, False])
def test_a_wide_enclosure_leaves_it_to_the_solid_model(
    by_torsion: bool, suite_cache: Path, monkeypatch
) -> None:
    """K_b and the held rim by tetrahedra, within the enclosure."""
    part = model(WIDE, suite_cache)
    K_b = part_stiffness.part_stiffness(part)
    if not by_torsion:
        without_torsion(monkeypatch)
    lobes = rim_stiffness(part, "lobes")
    assert ("what they add in torsion" in lobes.method) == by_torsion
    for found in (K_b, lobes):
        assert found.model == "solid"
        assert not found.guaranteed
        assert found.half_width < 0.02


def test_where_the_solid_model_fails_the_enclosure_stays(suite_cache: Path, monkeypatch) -> None:
    def fails(*given: object, **named: object) -> None:
        raise ComputationError("no mesh")

    case = replace(load_cases.CASES["lobes"], with_holes=fails)
    monkeypatch.setattr(load_cases, "CASES", {**load_cases.CASES, "lobes": case})
    by_torsion = rim_stiffness(model(WIDE, suite_cache), "lobes")
    assert by_torsion.half_width < 0.02
    assert not by_torsion.shortfall
    without_torsion(monkeypatch)
    found = rim_stiffness(model(WIDE, suite_cache), "lobes")
    assert found.half_width > 0.02
    assert TOO_FAR in found.shortfall.words
    assert "no mesh" in found.shortfall.words


def test_where_no_mesh_can_be_made_K_b_is_the_enclosures(tmp_path: Path, monkeypatch) -> None:
    def fails(*given: object, **named: object) -> None:
        raise ComputationError("no mesh")

    monkeypatch.setattr(solid_torsion, "solid_stiffness", fails)
    narrow = part_stiffness.part_stiffness(model(CUP, tmp_path))
    assert narrow.guaranteed
    assert not narrow.shortfall
    wide = part_stiffness.part_stiffness(model(WIDE, tmp_path))
    assert TOO_FAR in wide.shortfall.words
    assert "no mesh" in wide.shortfall.words
    with pytest.raises(ComputationError, match="no mesh"):
        part_stiffness.part_stiffness(model(CUP.changed({"solver.model": "solid"}), tmp_path))


def test_where_the_enclosure_fails_the_solid_model_stays(tmp_path: Path, monkeypatch) -> None:
    def fails(*given: object) -> None:
        raise ComputationError("a land narrower than any triangle")

    monkeypatch.setattr(part_stiffness, "torsional_stiffness", fails)
    said: list[str] = []
    context = AnalysisContext(CUP, Cache(tmp_path), Progress(said.append))
    found = part_stiffness.part_stiffness(context.part("flexspline"))
    assert not found.guaranteed
    assert found.half_width <= 0.005
    assert any("a land narrower than any triangle" in line for line in said)


@pytest.mark.parametrize("solver", ["auto", "solid"])
def test_a_wrong_solid_model_is_found_out(solver: str, tmp_path: Path, monkeypatch) -> None:
    """K is 5 % off where ± 0.3 % is claimed, and nothing is answered."""
    stiffen_solid_model(monkeypatch)
    with pytest.raises(NestingError, match="the solid model"):
        part_stiffness.part_stiffness(model(CUP.changed({"solver.model": solver}), tmp_path))


@pytest.mark.parametrize("solver", ["auto", pytest.param("solid", marks=pytest.mark.long)])
def test_a_wrong_solid_model_of_the_lobes_is_found_out(
    solver: str, suite_cache: Path, monkeypatch
) -> None:
    """With the solid model asked for by name too: K 30 % off is no answer."""
    without_torsion(monkeypatch)
    case, field = load_cases.CASES["lobes"], {"auto": "with_holes", "solid": "solid"}[solver]
    solve = getattr(case, field)

    def off(part: PartModel) -> Stiffness:
        return solve(part).times(1.3)

    wrong = replace(case, **{field: off})
    monkeypatch.setattr(load_cases, "CASES", {**load_cases.CASES, "lobes": wrong})
    with pytest.raises(NestingError, match="the solid model"):
        rim_stiffness(model(WIDE.changed({"solver.model": solver}), suite_cache), "lobes")


def test_a_wrong_K_b_in_torsion_is_found_out_under_the_lobes(
    suite_cache: Path, monkeypatch
) -> None:
    solve = load_cases.part_stiffness
    monkeypatch.setattr(load_cases, "part_stiffness", lambda part: solve(part).times(0.9))
    with pytest.raises(NestingError):
        rim_stiffness(model(WIDE, suite_cache), "lobes")


@pytest.mark.long
def test_lift_off_that_the_solid_model_cannot_solve_is_said(suite_cache: Path) -> None:
    """Without holes no two bodies of revolution answer in its place."""
    asked = {"solver.model": "solid", "solver.tolerance_pct": 5.0, "flexspline.bolt_count": 0}
    context = AnalysisContext(CUP.changed(asked), Cache(suite_cache), Progress())
    found = stiffnesses(context, shaft=False)
    assert set(found.missing) == {"K_b_lobes_contact"}
    assert "meridian only" in found.missing["K_b_lobes_contact"].words


@pytest.mark.parametrize(("design", "far"), [(WIDE, True), (CUP, False)])
def test_a_cut_body_that_is_too_far_off_is_not_solved_finely(
    design: Design, far: bool, suite_cache: Path
) -> None:
    """At 0.1 %: what the holes take off K stays, however well that body is known."""
    part = model(design.changed({"solver.tolerance_pct": 0.1}), suite_cache)
    bodies = load_cases.CASES["lobes"].bodies(part)
    fine = bounds_pct(part) / 100 / 2
    assert bodies.whole.half_width <= fine
    assert bodies.cut.half_width <= (FAR_BOUNDS_PCT / 100 / 2 if far else fine)
    assert (bodies.cut.half_width > fine) is far
    found = enclosure_of(part, bodies)
    assert (found.shortfall.words == TOO_FAR) is far
    finest = two_bodies(part.part, lambda body: rim(body, held_rim, KNOWN_TO)).enclosure()
    assert found.bounds_Nm_per_rad == pytest.approx(
        finest.bounds_Nm_per_rad, rel=FAR_BOUNDS_PCT / 100
    )
