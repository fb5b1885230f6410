"""The equivalent ring where reasoning alone says what must come out."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest
from toothed import toothed

from flexspline.fea.toothed_ring import equivalent, plain
from flexspline.fea.toothed_ring.cell import ToothedRingError
from flexspline.fea.toothed_ring.equivalent import (
    LARGEST_CHANGE,
    SMALLEST_CHANGE,
    EquivalentRing,
    equivalent_ring,
)
from flexspline.geometry.tooth import ToothCell, tooth_cell

RIM, HALF_PITCH, INNER = 0.55, pi / 200, 19.2
ROOT = INNER + RIM


def three(ring: EquivalentRing) -> tuple[float, float, float]:
    return ring.bending_mm, ring.membrane_mm, ring.torsion_mm


@pytest.fixture(scope="module")
def involute() -> EquivalentRing:
    return equivalent_ring(tooth_cell(toothed("involute")), 0.3)


@pytest.fixture(scope="module")
def trapezoid() -> EquivalentRing:
    return equivalent_ring(tooth_cell(toothed("trapezoid")), 0.3)


def block(height: float, share: float) -> ToothCell:
    """A tooth with radial flanks that fills a share of the pitch."""
    edge = share * HALF_PITCH
    return ToothCell(INNER, HALF_PITCH, ((ROOT + height, edge), (ROOT, edge)))


def test_teeth_without_height_leave_the_rim() -> None:
    height = 1e-3
    for t in three(equivalent_ring(block(height, 0.5), 0.3)):
        assert RIM < t < RIM + height + SMALLEST_CHANGE * RIM


def test_teeth_without_gaps_are_a_full_ring() -> None:
    full = ToothCell(INNER, HALF_PITCH, ((ROOT + 0.45, HALF_PITCH),))
    for t in three(equivalent_ring(full, 0.3)):
        assert t == pytest.approx(RIM + 0.45, rel=SMALLEST_CHANGE)


def test_real_teeth_lie_between(involute: EquivalentRing) -> None:
    for t in three(involute):
        assert RIM < t < RIM + 0.45
    # between slits of no width, 0.0886 and ln 2/π pitches, and teeth of no width, nothing at all
    pitch = 2 * HALF_PITCH * ROOT
    assert involute.membrane_mm < RIM + 0.0886 * pitch
    assert involute.torsion_mm < RIM + 0.2206 * pitch


def test_wider_teeth_are_stiffer(monkeypatch: pytest.MonkeyPatch) -> None:
    """A third wider each: by much more than what the last, coarse mesh of each may be off."""
    monkeypatch.setattr(equivalent, "SMALLEST_CHANGE", 5 * SMALLEST_CHANGE)
    rings = [three(equivalent_ring(block(0.45, share), 0.3)) for share in (0.3, 0.6, 0.9)]
    for narrow, middle, wide in zip(*rings, strict=True):
        assert narrow < middle < wide
        assert wide - narrow > 20 * SMALLEST_CHANGE * middle


def test_flanks_differ_little(involute: EquivalentRing, trapezoid: EquivalentRing) -> None:
    """Same thickness and slope on the pitch circle: they part by 6 µm at the root, gap 140 µm."""
    for ours, theirs in zip(three(involute), three(trapezoid), strict=True):
        # 4 % of the gap moves the teeth's share, a tenth of the thickness at most, by about as much
        assert ours == pytest.approx(theirs, rel=0.005)
        assert abs(ours - theirs) > SMALLEST_CHANGE * ours


def test_bending_and_torsion_know_no_material(involute: EquivalentRing) -> None:
    """A body free of forces and cut open obeys Michell's theorem: stress over E' has no ν."""
    other = equivalent_ring(tooth_cell(toothed("involute")), 0.45)
    # each within its own mesh error
    assert other.bending_mm == pytest.approx(involute.bending_mm, rel=2 * SMALLEST_CHANGE)
    assert other.torsion_mm == pytest.approx(involute.torsion_mm, rel=1e-9)


def test_theory_page_prints_these_thicknesses(
    involute: EquivalentRing, trapezoid: EquivalentRing
) -> None:
    """The page against the program, not the program against a source."""
    page = (Path(__file__).parents[3] / "docs" / "theory.md").read_text(encoding="utf-8")
    for flank, ring in (("involute", involute), ("trapezoid", trapezoid)):
        assert f"| {flank} | " + " | ".join(f"{t:.3f} mm" for t in three(ring)) + " |" in page


def test_thickness_is_the_inverse_of_the_closed_forms() -> None:
    for form in (plain.bending, plain.torsion, lambda a, b: plain.membrane(a, b, 0.3)):
        for t in (1e-3, 0.5, 30.0):
            found = plain.thickness(form, INNER, form(INNER, INNER + t))
            assert found == pytest.approx(t, rel=1e-9)  # rounding of a + t at t/a = 5e-5


def test_thin_ring_bends_as_a_plate() -> None:
    t = 1e-4 * INNER
    # the closed form itself differs from t³/12R by the order of (t/R)²
    assert plain.bending(INNER, INNER + t) == pytest.approx(t**3 / 12 / (INNER + t / 2), rel=1e-7)


def test_a_thin_rim_under_wide_teeth_is_answered_without_a_huge_mesh(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Rim 0.06 of the pitch: each halving gains little, and the last would take minutes.

    The mesh is stopped earlier here than in earnest, to save the time.
    """
    monkeypatch.setattr(equivalent, "MOST_TRIANGLES", 10_000)
    inner, rim, half_pitch = 97.13, 1.16, pi / 30
    root, edge = inner + rim, 0.7 * half_pitch
    cell = ToothCell(inner, half_pitch, ((root + 16.0, 0.3 * half_pitch), (root, edge)))
    found = equivalent_ring(cell, 0.3)
    assert found.elements <= 10_000
    assert SMALLEST_CHANGE < found.change < LARGEST_CHANGE
    assert rim < found.bending_mm < rim + 16.0


def test_a_ring_that_does_not_settle_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(equivalent, "MOST_TRIANGLES", 200)
    with pytest.raises(ToothedRingError, match=r"still changes by .* wanted 1e-03"):
        equivalent_ring(block(0.2, 0.5), 0.3)
