"""The sum for a design, its spread, the other play model, and the torque-angle line."""

from __future__ import annotations

import doctest
import tomllib
from dataclasses import FrozenInstanceError
from math import hypot, radians, sin

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.play_limit import play_limit
from flexspline.pipeline import backlash as sums
from flexspline.pipeline import bearing_play
from flexspline.pipeline.backlash import (
    ARCSEC_PER_RAD,
    StiffnessValueError,
    angle_rad,
    backlash,
    gap_rad,
    play_clearance,
)
from flexspline.pipeline.bearing_play import (
    BearingPlayDomainError,
    involute_clearance,
    involute_clearance_slope,
)
from flexspline.pipeline.play_spread import play_spread

EXAMPLE = EXAMPLES / "xb1-40.toml"
K_B, K_E = 4.0e4, 3.0e4
A, ALPHA = 0.2, radians(20)
C_MAX_UM = play_limit(A, ALPHA) * 1e3


def design_with(**tables: dict) -> Design:
    """xb1-40 with keys of its tables replaced; beyond `geometry.checks` on purpose."""
    data = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    for name, keys in tables.items():
        data[name] = data.get(name, {}) | keys
    return Design.model_validate(data)


def test_terms_of_the_nominal_gear() -> None:
    b = backlash(design_with(), K_B, K_E)
    # by hand: 2·0.5/K · 206264.8; 3 · 10.975; 12 µm between table 4's 33.63 and 46.94
    assert b.shaft_arcsec == pytest.approx(206264.806 / 3e4, rel=1e-8)
    assert b.flexspline_arcsec == pytest.approx(206264.806 / 4e4, rel=1e-8)
    assert b.flank_clearance_arcsec == pytest.approx(32.93, abs=0.005)
    assert 33.63 < b.bearing_play_arcsec < 46.94
    parts = (b.shaft_arcsec, b.flexspline_arcsec, b.flank_clearance_arcsec, b.bearing_play_arcsec)
    assert b.total_arcsec == pytest.approx(sum(parts), rel=1e-12)
    with pytest.raises(FrozenInstanceError):
        b.total_arcsec = 0.0  # type: ignore[misc]


def test_spread_is_that_of_a_sampled_sum() -> None:
    """200 000 gears drawn from [uncertainty], each evaluated by the whole sum's own terms."""
    design = design_with()
    b = backlash(design, K_B, K_E)
    rng = np.random.default_rng(1)
    n = 200_000
    E, j, c = 1 + 0.02 * rng.standard_normal(n), rng.normal(3, 1, n), rng.normal(12, 2.5, n)
    grid = np.linspace(-5, C_MAX_UM, 2000)
    opened = [involute_clearance(x * 1e-3, A, ALPHA) * 1e3 for x in grid]
    gap = (j + np.interp(c, grid, opened)) * 1e-3 * 2 / (0.2 * 200 * np.cos(ALPHA))
    total = ((1 / K_B + 1 / K_E) / E + gap) * ARCSEC_PER_RAD
    # a sample's deviation scatters by 1/√(2n) = 0.16 %; three times that, and 1/E's curvature
    assert b.std_arcsec == pytest.approx(total.std(), rel=0.006)


def test_spread_by_source_adds_up_and_is_linear_where_the_sum_is() -> None:
    b = backlash(design_with(), K_B, K_E)
    by = b.std_by_source_arcsec
    assert set(by) == {"youngs_modulus", "flank_clearance", "radial_clearance"}
    assert b.std_arcsec == pytest.approx(hypot(*by.values()), rel=1e-12)
    # one modulus for both parts: the two compliances add before they are squared
    assert by["youngs_modulus"] == pytest.approx(0.02 * (b.shaft_arcsec + b.flexspline_arcsec))
    assert by["flank_clearance"] == pytest.approx(b.flank_clearance_arcsec / 3, rel=1e-12)


@pytest.mark.parametrize("c_um", [0.0, 5.0, 12.0, 20.0])
def test_play_spread_is_linear_far_from_the_limit(c_um: float) -> None:
    design = design_with(bearing={"radial_clearance_um": c_um})
    std, beyond = play_spread(design.gear, design.bearing, 0.01)
    # next order: (j''/j')·s = 1e-2 mm⁻¹·… < 1e-3 for s = 0.01 µm
    assert std == pytest.approx(1e-5 * involute_clearance_slope(c_um * 1e-3, A, ALPHA), rel=1e-3)
    assert beyond == 0.0


def test_nominal_play_spread_as_the_theory_page_states_it() -> None:
    """0.2 % below the linear rule, 6e-7 of the probability beyond c_max: to the digit printed."""
    design = design_with()
    std, beyond = play_spread(design.gear, design.bearing, 2.5)
    linear = 2.5e-3 * involute_clearance_slope(0.012, A, ALPHA)
    assert 1 - std / linear == pytest.approx(0.002, abs=0.0005)
    assert beyond == pytest.approx(6e-7, abs=0.5e-7)


def test_play_spread_at_the_limit_is_not_certainty() -> None:
    """There the slope is 0: a linear rule would say that play cannot matter."""
    design = design_with(bearing={"radial_clearance_um": C_MAX_UM})
    std, beyond = play_spread(design.gear, design.bearing, 2.5)
    below = involute_clearance(C_MAX_UM * 1e-3, A, ALPHA) - involute_clearance(
        (C_MAX_UM - 2.5) * 1e-3, A, ALPHA
    )
    assert involute_clearance_slope(C_MAX_UM * 1e-3, A, ALPHA) < 1e-7
    assert 0.5 * below < std < 2 * below  # of the order of one deviation's effect
    assert beyond == pytest.approx(0.5, abs=1e-9)


def test_play_spread_has_no_jump_towards_the_limit() -> None:
    at = [
        play_spread(d.gear, d.bearing, 2.5)[0]
        for c in np.linspace(10, C_MAX_UM, 100)
        for d in [design_with(bearing={"radial_clearance_um": float(c)})]
    ]
    assert np.abs(np.diff(at)).max() < 0.02 * max(at)  # 100 steps over the whole fall


def test_beyond_the_limit_is_refused_with_both_numbers() -> None:
    with pytest.raises(BearingPlayDomainError, match=r"30 µm .* 24.12 µm"):
        backlash(design_with(bearing={"radial_clearance_um": 30.0}), K_B, K_E)


@pytest.mark.parametrize("model", ["involute", "small_displacement"])
@pytest.mark.parametrize("alpha_deg", [14.5, 20.0, 25.0, 30.0])
def test_without_clearance_there_is_no_gap(model: str, alpha_deg: float) -> None:
    """Exactly none, in either model of the play, whatever the pressure angle's cosine rounds to."""
    design = design_with(
        bearing={"bearing_play_model": model, "radial_clearance_um": 0.0},
        gear={"flank_clearance_um": 0.0, "pressure_angle_deg": alpha_deg},
    )
    b = backlash(design, K_B, K_E)
    assert (b.bearing_play_arcsec, b.model_form_arcsec, b.gap_arcsec) == (0.0, 0.0, 0.0)


def test_small_displacement_model() -> None:
    small = {"bearing_play_model": "small_displacement"}
    design = design_with(bearing=small)
    b, involute = backlash(design, K_B, K_E), backlash(design_with(), K_B, K_E)
    assert play_clearance(design) == pytest.approx(0.012 * sin(ALPHA), rel=1e-12)
    assert b.std_by_source_arcsec["radial_clearance"] == pytest.approx(
        b.bearing_play_arcsec * 2.5 / 12, rel=1e-12
    )
    assert b.play_beyond_limit == 0.0
    # each names the other's total as the error of the model's form
    assert b.total_arcsec + b.model_form_arcsec == pytest.approx(involute.total_arcsec)
    assert involute.total_arcsec + involute.model_form_arcsec == pytest.approx(b.total_arcsec)
    beyond = design_with(bearing=small | {"radial_clearance_um": 30.0})
    assert backlash(beyond, K_B, K_E).model_form_arcsec is None


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan"), float("inf")])
def test_stiffness_must_be_positive(bad: float) -> None:
    with pytest.raises(StiffnessValueError, match="K_b = "):
        backlash(design_with(), bad, K_E)
    with pytest.raises(StiffnessValueError, match="K_e = "):
        angle_rad(design_with(), 0.5, K_B, bad)


def test_line_ends_are_the_sum_apart() -> None:
    design = design_with()
    b = backlash(design, K_B, K_E)
    up, down = angle_rad(design, np.array([0.5, -0.5]), K_B, K_E)
    assert (up - down) * ARCSEC_PER_RAD == pytest.approx(b.total_arcsec, rel=1e-12)
    clear = b.flank_clearance_arcsec + b.bearing_play_arcsec
    assert gap_rad(design) * ARCSEC_PER_RAD == pytest.approx(clear, rel=1e-12)
    assert angle_rad(design, 0.0, K_B, K_E) == 0.0
    slope = (angle_rad(design, 0.5, K_B, K_E) - angle_rad(design, 0.3, K_B, K_E)) / 0.2
    assert slope == pytest.approx(1 / K_B + 1 / K_E, rel=1e-9)


@pytest.mark.parametrize("module", [sums, bearing_play])
def test_docstring_examples(module) -> None:
    found = doctest.testmod(module)
    assert found.attempted > 1
    assert found.failed == 0
