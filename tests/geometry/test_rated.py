"""The rated torque that is assumed where a design states none."""

from __future__ import annotations

import pytest
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.geometry.rated import rated_torque

CUP = load_design(EXAMPLES / "xb1-40.toml")
MODULUS = "material.flexspline.youngs_modulus_GPa"


@pytest.mark.parametrize(
    ("modulus_GPa", "share"),
    [(206.0, 1.0), (190.0, 1.0), (114.0, 0.6), (1.9, 0.01)],
)
def test_a_softer_gear_carries_as_much_less(modulus_GPa: float, share: float) -> None:
    """T ~ E at the same shape under load (elasticity is linear in E); of any steel alike."""
    usual, _ = rated_torque(CUP)
    found, (assumed,) = rated_torque(CUP.changed({MODULUS: modulus_GPa}))
    assert found == pytest.approx(share * usual)
    assert assumed.value == found
    assert ("which are of steel" in assumed.why) == (share < 1)


def test_a_stated_torque_stays() -> None:
    plastic = CUP.changed({MODULUS: 1.6, "gear.rated_torque_Nm": 5.0})
    assert rated_torque(plastic) == (5.0, ())
