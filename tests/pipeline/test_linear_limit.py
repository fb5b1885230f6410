"""The torque beyond which the linear model is not valid, against closed forms written out here."""

from __future__ import annotations

from math import pi, sqrt

import pytest
from example_files import EXAMPLES

from flexspline.fea.types import StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import load_design
from flexspline.pipeline.linear_limit import ReachedStress, ToothTwist, linear_limit
from flexspline.results.limit_words import reason

SOFT, STIFF = 1.0, 1e9
"""N·m/rad: so soft that the twist decides, so stiff that it never does."""


def cup(**values: float) -> Design:
    return with_values(load_design(EXAMPLES / "xb1-40.toml"), values)


def test_the_twist_of_one_tooth() -> None:
    found = linear_limit(cup(), SOFT)
    assert found.torque_Nm == pytest.approx(SOFT * 2 * pi / 200)
    assert found.why == ToothTwist(200)


def test_the_diaphragm_at_the_boss() -> None:
    """Equilibrium: T = 2π r² h τ, von Mises √3 τ; boss of 18 mm, 0.6 mm thick, limit 500 MPa."""
    found = linear_limit(cup(), STIFF)
    assert found.torque_Nm == pytest.approx(2 * pi * 9**2 * 0.6 * 500 / sqrt(3) / 1000)
    assert found.why == ReachedStress("flexspline", "diaphragm", 9.0, 500.0, is_fatigue_limit=True)


def test_the_tube() -> None:
    """Coulomb, outside of a tube of 19.2 to 19.4 mm, with a diaphragm thicker than it."""
    design = cup(**{"flexspline.wall_thickness_mm": 0.2, "flexspline.diaphragm_thickness_mm": 2.0})
    found = linear_limit(design, STIFF)
    polar = pi / 2 * (19.4**4 - 19.2**4)
    assert found.torque_Nm == pytest.approx(polar / 19.4 * 500 / sqrt(3) / 1000)
    assert found.why == ReachedStress("flexspline", "tube", None, 500.0, is_fatigue_limit=True)


def test_the_shaft() -> None:
    """Coulomb, outside of a shaft of 6 to 6.5 mm bore and 7 mm, the thinnest of its segments."""
    design = cup(**{"shaft.segment[1].outer_diameter_mm": 7.0, "shaft.fillet_mm": 0.1})
    found = linear_limit(design, STIFF)
    polar = pi / 2 * (3.5**4 - 3.0**4)
    assert found.torque_Nm == pytest.approx(polar / 3.5 * 500 / sqrt(3) / 1000)
    assert found.why == ReachedStress("shaft", "shaft", 7.0, 500.0, is_fatigue_limit=True)


@pytest.mark.parametrize(("border", "counts"), [(False, True), (True, False)])
def test_a_peak_counts_only_where_it_is_the_parts(border: bool, counts: bool) -> None:
    peak = StressPeak(100.0, (9.0, 0.0, 0.0), "near edges", 0.4, border, 90.0)
    found = linear_limit(cup(), STIFF, {"shaft_torque_peak": peak})
    # 100 MPa at the load torque of 0.5 N·m, limit 500 MPa
    assert (found.torque_Nm == pytest.approx(2.5)) == counts
    assert ("shaft" in found.not_counted) != counts
    assert ("not counted: the shaft's peak, at excluded border" in reason(found)) != counts


def test_without_a_fatigue_limit_the_highest_strength_stands_in() -> None:
    steel = cup().material.flexspline.model_copy(update={"fatigue_limit_MPa": None})
    bare = cup().model_copy(
        update={"material": cup().material.model_copy(update={"flexspline": steel})}
    )
    stated, found = linear_limit(cup(), STIFF), linear_limit(bare, STIFF)
    assert found.torque_Nm == pytest.approx(stated.torque_Nm * 2000 / 500)
    assert isinstance(found.why, ReachedStress)
    assert not found.why.is_fatigue_limit


def test_a_limit_beyond_every_metal_counts_no_further() -> None:
    stated = linear_limit(cup(), STIFF)
    lofty = linear_limit(cup(**{"material.flexspline.fatigue_limit_MPa": 4000.0}), STIFF)
    assert lofty.torque_Nm == pytest.approx(stated.torque_Nm * 2000 / 500)


def test_it_tells_whether_peaks_were_solved() -> None:
    assert not linear_limit(cup(), STIFF).peaks_solved
    assert linear_limit(cup(), STIFF, {}).peaks_solved
