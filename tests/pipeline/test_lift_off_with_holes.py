"""Lift-off of a part whose two bodies of revolution lie far apart: K held of the part, times their ratio."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from example_files import EXAMPLES
from wrong_models import without_torsion

from flexspline.fea.types import Shortfall, Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.load import load_design
from flexspline.pipeline import load_cases
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.enclosed_part import TOO_FAR
from flexspline.pipeline.enclosure import two_bodies
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.lift_off_with_holes import RATIO_SPREAD, by_ratio
from flexspline.pipeline.load_cases import rim_stiffness
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.revolved import contact

WIDE = load_design(EXAMPLES / "xb1-40.toml").changed(
    {
        "flexspline.bolt_count": 6,
        "flexspline.bolt_hole_diameter_mm": 4.4,
        "flexspline.diaphragm_thickness_mm": 1.5,
        "solver.tolerance_pct": 2.0,
    }
)
"""With lift-off the two bodies are ± 2.2 % apart."""
DRAWN_RATIO = 0.8302
"""K resting over K held on tetrahedra with the holes drawn, of
tests/verification/test_lift_off_against_drawn_holes.py."""


def model(design: Design, folder: Path) -> PartModel:
    return AnalysisContext(design, Cache(folder), Progress()).part("flexspline")


def held(K: float, half: float, words: str = "") -> Stiffness:
    short = Shortfall(words)
    return Stiffness(K, K - half, K + half, False, "solid", "1/4", "estimate", (), 2.0, short)


def test_the_interval_by_hand() -> None:
    """Ratios 0.79 to 0.81 and 0.83 to 0.85: middles 0.04 apart."""
    found = by_ratio(held(1000.0, 10.0), [(0.79, 0.81), (0.83, 0.85)])
    low, high = 0.79 - RATIO_SPREAD * 0.04, 0.85 + RATIO_SPREAD * 0.04
    assert found.bounds_Nm_per_rad == pytest.approx((990 * low, 1010 * high))
    assert found.K_Nm_per_rad == pytest.approx(1000 * (low + high) / 2)
    assert not found.guaranteed


@pytest.mark.parametrize("solver", ["auto", pytest.param("solid", marks=pytest.mark.long)])
def test_it_is_narrower_than_the_enclosure_and_within(solver: str, suite_cache: Path) -> None:
    part = model(WIDE.changed({"solver.model": solver}), suite_cache)
    found, rests_on = rim_stiffness(part, "lobes_contact"), rim_stiffness(part, "lobes")
    bodies = two_bodies(part.part, lambda body: contact(body, 0.005)).enclosure()
    assert bodies.half_width > 0.02 > found.half_width
    assert bodies.lower_Nm_per_rad <= found.lower_Nm_per_rad * 1.005  # by the bodies' own bounds
    assert found.upper_Nm_per_rad <= bodies.upper_Nm_per_rad * 1.005
    assert found.lower_Nm_per_rad < DRAWN_RATIO * rests_on.K_Nm_per_rad < found.upper_Nm_per_rad
    assert not found.guaranteed
    assert not found.shortfall
    assert "what lift-off leaves of it" in found.method


def with_held(monkeypatch: pytest.MonkeyPatch, solve: object) -> None:
    """K held by `solve`, and not by torsion."""
    without_torsion(monkeypatch)
    case = replace(load_cases.CASES["lobes"], solid=solve, with_holes=solve)
    monkeypatch.setattr(load_cases, "CASES", {**load_cases.CASES, "lobes": case})


def test_what_it_misses_is_said(suite_cache: Path, monkeypatch) -> None:
    with_held(monkeypatch, lambda *_, **__: held(36190.0, 200.0, "no time"))
    asked = WIDE.changed({"solver.tolerance_pct": 1.0})
    found = rim_stiffness(model(asked, suite_cache), "lobes_contact")
    assert found.half_width > 0.01
    assert found.shortfall.words == f"{TOO_FAR}; with the seat held: no time"


def test_without_K_held_the_enclosure_stays(suite_cache: Path, monkeypatch) -> None:
    def fails(*given: object, **named: object) -> Stiffness:
        raise ComputationError("no mesh")

    with_held(monkeypatch, fails)
    for solver in ("auto", "solid"):
        part = model(WIDE.changed({"solver.model": solver}), suite_cache)
        found = rim_stiffness(part, "lobes_contact")
        assert found.half_width > 0.02
        assert TOO_FAR in found.shortfall.words
        assert "no mesh" in found.shortfall.words


def test_a_wrong_K_held_stops_it(suite_cache: Path, monkeypatch) -> None:
    case = load_cases.CASES["lobes"]

    def off(*given: object, **named: object) -> Stiffness:
        assert case.with_holes is not None
        return case.with_holes(*given, **named).times(1.3)

    with_held(monkeypatch, off)
    with pytest.raises(NestingError, match="the solid model"):
        rim_stiffness(model(WIDE, suite_cache), "lobes_contact")
