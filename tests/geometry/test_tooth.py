"""The drawn tooth against what defines its flank, and the teeth that cannot be drawn."""

from __future__ import annotations

from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
from example_files import EXAMPLES
from toothed import toothed

from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import load_design
from flexspline.geometry.tooth import half_thickness, tip_radius, tooth_cell

PITCH, ALPHA, HALF_PITCH = 20.0, radians(20), pi / 200
FLANKS = ("involute", "trapezoid")


@pytest.mark.parametrize("flank", FLANKS)
def test_half_a_pitch_thick_on_the_pitch_circle_and_inclined_by_alpha(flank: str) -> None:
    psi = half_thickness(toothed(flank))
    assert psi(PITCH) == pytest.approx(HALF_PITCH / 2, rel=1e-13)
    step = 1e-5  # central difference: its own error is of order 1e-10
    slope = (psi(PITCH + step) - psi(PITCH - step)) / (2 * step)
    assert -PITCH * slope == pytest.approx(tan(ALPHA), rel=1e-6)


def test_normals_of_the_involute_touch_the_base_circle() -> None:
    psi, base = half_thickness(toothed("involute")), PITCH * cos(ALPHA)
    for r in (19.75, 19.9, 20.2):
        step = 1e-5
        slope = r * (psi(r + step) - psi(r - step)) / (2 * step)
        # flank and radius enclose α_r, and r cos α_r is the normal's distance from the centre
        assert r * cos(np.arctan(-slope)) == pytest.approx(base, rel=1e-8)


def test_involute_is_radial_below_its_base_circle() -> None:
    few = toothed(
        "involute",
        {
            "gear.module_mm": 2.0,
            "gear.teeth_flexspline": 20,
            "gear.teeth_circular_spline": 22,
            "flexspline.inner_diameter_mm": 34.0,
        },
    )
    psi = half_thickness(few)
    assert psi(17.5) == psi(18.5) == psi(20 * cos(ALPHA))
    assert psi(19.5) < psi(18.5)


def test_trapezoid_is_straight() -> None:
    psi = half_thickness(toothed("trapezoid"))
    (ax, ay), (bx, by), (cx, cy) = ((r * cos(psi(r)), r * sin(psi(r))) for r in (19.75, 20.0, 20.2))
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    assert abs(area) < 1e-12  # rounding of products of 20 mm


@pytest.mark.parametrize("flank", FLANKS)
def test_cell_reaches_from_tip_to_root_and_is_closed(flank: str) -> None:
    design = toothed(flank)
    cell = tooth_cell(design)
    assert cell.tip == tip_radius(design) == pytest.approx(20.2)
    assert cell.root == pytest.approx(19.75)
    radii, angles = np.array(cell.flank).T
    assert (np.diff(radii) < 0).all()
    assert (np.diff(angles) > 0).all()
    segments = cell.outline.segments
    ends = [s.end for s in segments]
    assert ends == [s.start for s in (*segments[1:], segments[0])]
    assert {s.patch for s in segments} == {"tooth", "space", "seat", None}


@pytest.mark.parametrize("flank", FLANKS)
def test_area_of_the_cell(flank: str) -> None:
    """Polygon in (r, ρφ) with weight r/ρ against ∫ r ψ(r) dr by a fine rule."""
    cell = tooth_cell(toothed(flank))
    psi = half_thickness(toothed(flank))
    r, w = np.polynomial.legendre.leggauss(12)
    half = (cell.tip - cell.root) / 2
    radii = cell.root + half * (r + 1)
    tooth = half * sum(wi * ri * psi(ri) for wi, ri in zip(w, radii, strict=True))
    points = np.array([s.start for s in cell.outline.segments])
    (r0, s0), (r1, s1) = points.T, np.roll(points, -1, axis=0).T
    # ∮ (r²/2ρ) ds, exact along straight lines
    drawn = ((r0**2 + r0 * r1 + r1**2) * (s1 - s0)).sum() / (6 * cell.unroll)
    rim = (cell.root**2 - cell.inner**2) / 2 * HALF_PITCH
    # chords are at most 3e-4 modules off a flank of 2.25
    assert drawn - rim == pytest.approx(tooth, abs=3e-4 * 0.2 * 0.45)


@pytest.mark.parametrize(
    ("changes", "key", "limit"),
    [
        # root circle at 20.2, pitch circle at 20: at most 0.8 less 2 % of a module
        ({"flexspline.ring_thickness_mm": 1.0}, "flexspline.ring_thickness_mm", "0.795999"),
        # pitch circle at 10, inside the tube of outer radius 19.6: 19.6 / (100 - 0.02)
        ({"gear.module_mm": 0.1, "bearing.radial_clearance_um": 5.0},
         "gear.module_mm", "0.196"),
        # 40°: 1.25 tan 40° = 1.05 modules are more than a quarter pitch, 0.785
        ({"gear.pressure_angle_deg": 40.0}, "flexspline.ring_thickness_mm", "0.619"),
    ],
)  # fmt: skip
def test_teeth_that_cannot_be_drawn_are_refused(changes: dict, key: str, limit: str) -> None:
    with pytest.raises(DesignError) as refused:
        toothed("trapezoid", changes)
    assert refused.value.key == key
    assert limit in str(refused.value)
    assert "drawn" in str(refused.value)


def test_pointed_teeth_are_refused() -> None:
    """Half a tooth is π/4 modules thick at the pitch: straight flanks meet where tan α ≈ π/4."""
    changes = {"gear.pressure_angle_deg": 40.0, "flexspline.ring_thickness_mm": 0.7}
    with pytest.raises(DesignError) as refused:
        toothed("trapezoid", changes)
    assert refused.value.key == "gear.pressure_angle_deg"
    limit = float(str(refused.value).partition("from 5 to ")[2].split()[0])
    # 0.02 modules of land, and the gap's circle is curved by 0.45° over half a pitch
    assert limit == pytest.approx(np.degrees(np.arctan(pi / 4 - 0.02)), abs=0.5)


def test_bad_teeth_do_not_matter_where_none_are_drawn() -> None:
    thick = load_design(EXAMPLES / "xb1-40.toml").changed({"flexspline.ring_thickness_mm": 1.0})
    assert thick.flexspline.ring_thickness_mm == 1.0
