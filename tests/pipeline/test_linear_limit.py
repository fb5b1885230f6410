"""The torque beyond which the linear model is not valid, against closed forms written out here."""

from __future__ import annotations

from math import pi, sqrt

import pytest
from example_files import EXAMPLES

from flexspline.fea.types import StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import load_design
from flexspline.pipeline.linear_limit import linear_limit

SOFT, STIFF = 1.0, 1e9
"""N·m/rad: so soft that the twist decides, so stiff that it never does."""


def cup(**values: float) -> Design:
    return with_values(load_design(EXAMPLES / "xb1-40.toml"), values)


def test_the_twist_of_one_tooth() -> None:
    found = linear_limit(cup(), SOFT)
    assert found.torque_Nm == pytest.approx(SOFT * 2 * pi / 200)
    assert "one tooth, 360°/200" in found.reason


def test_the_diaphragm_at_the_boss() -> None:
    """Equilibrium: T = 2π r² h τ, von Mises √3 τ; boss of 18 mm, 0.6 mm thick, limit 500 MPa."""
    found = linear_limit(cup(), STIFF)
    assert found.torque_Nm == pytest.approx(2 * pi * 9**2 * 0.6 * 500 / sqrt(3) / 1000)
    assert "diaphragm at r = 9 mm" in found.reason
    assert "fatigue limit of 500 MPa" in found.reason


def test_the_tube() -> None:
    """Coulomb, outside of a tube of 19.2 to 19.4 mm, with a diaphragm thicker than it."""
    design = cup(**{"flexspline.wall_thickness_mm": 0.2, "flexspline.diaphragm_thickness_mm": 2.0})
    found = linear_limit(design, STIFF)
    polar = pi / 2 * (19.4**4 - 19.2**4)
    assert found.torque_Nm == pytest.approx(polar / 19.4 * 500 / sqrt(3) / 1000)
    assert "tube" in found.reason


def test_the_shaft() -> None:
    """Coulomb, outside of a shaft of 6 to 6.5 mm bore and 7 mm, the thinnest of its segments."""
    design = cup(**{"shaft.segment[1].outer_diameter_mm": 7.0, "shaft.fillet_mm": 0.1})
    found = linear_limit(design, STIFF)
    polar = pi / 2 * (3.5**4 - 3.0**4)
    assert found.torque_Nm == pytest.approx(polar / 3.5 * 500 / sqrt(3) / 1000)
    assert "shaft of 7 mm" in found.reason


@pytest.mark.parametrize(("border", "counts"), [(False, True), (True, False)])
def test_a_peak_counts_only_where_it_is_the_parts(border: bool, counts: bool) -> None:
    peak = StressPeak(100.0, (9.0, 0.0, 0.0), "near edges", 0.4, border, 90.0)
    found = linear_limit(cup(), STIFF, {"shaft_torque_peak": peak})
    # 100 MPa at the load torque of 0.5 N·m, limit 500 MPa
    assert (found.torque_Nm == pytest.approx(2.5)) == counts


def test_without_a_fatigue_limit_the_highest_strength_stands_in() -> None:
    steel = cup().material.flexspline.model_copy(update={"fatigue_limit_MPa": None})
    bare = cup().model_copy(
        update={"material": cup().material.model_copy(update={"flexspline": steel})}
    )
    stated, found = linear_limit(cup(), STIFF), linear_limit(bare, STIFF)
    assert found.torque_Nm == pytest.approx(stated.torque_Nm * 2000 / 500)
    assert "above the strength of any metal used in gears" in found.reason


def test_a_limit_beyond_every_metal_counts_no_further() -> None:
    stated = linear_limit(cup(), STIFF)
    lofty = linear_limit(cup(**{"material.flexspline.fatigue_limit_MPa": 4000.0}), STIFF)
    assert lofty.torque_Nm == pytest.approx(stated.torque_Nm * 2000 / 500)


def test_stresses_that_nobody_solved_are_said() -> None:
    assert "without the peak stress" in linear_limit(cup(), STIFF).reason
    assert "without the peak stress" not in linear_limit(cup(), STIFF, {}).reason


def test_a_load_torque_beyond_it_is_said() -> None:
    beyond, within = (cup(**{"load.torque_Nm": torque}) for torque in (5000.0, 0.5))
    (line,) = linear_limit(beyond, 1.8e4).passed(beyond)
    assert "load.torque_Nm = 5000 is beyond 88.2 N·m" in line
    assert list(linear_limit(within, 1.8e4).passed(within)) == []
