"""Limits in words, each with the figures that it carries."""

from __future__ import annotations

import pytest
from example_files import EXAMPLES
from hand_made_gear import content, design

from flexspline.fea.types import Stiffness
from flexspline.geometry.load import load_design
from flexspline.pipeline.linear_limit import LinearLimit, ReachedStress, ToothTwist
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results.limit_words import load_beyond, reason, stiffness_notes
from flexspline.results.report.tables import answers
from flexspline.results.warned import shortfalls


@pytest.mark.parametrize(
    ("why", "said"),
    [
        (ToothTwist(200), "the twist reaches one tooth pitch, 360°/200"),
        (
            ReachedStress("flexspline", "tube", None, 500.0, is_fatigue_limit=True),
            "the stress of the flexspline's tube under torque alone reaches the fatigue limit of 500 MPa",
        ),
        (
            ReachedStress("flexspline", "diaphragm", 9.0, 500.0, is_fatigue_limit=True),
            "the stress of the diaphragm at r = 9 mm under torque alone reaches the fatigue limit of 500 MPa",
        ),
        (
            ReachedStress("shaft", "shaft", 7.0, 2000.0, is_fatigue_limit=False),
            "the stress of the shaft of 7 mm under torque alone reaches 2000 MPa, above the strength of any "
            "metal used in gears",
        ),
        (
            ReachedStress("shaft", "peak", None, 500.0, is_fatigue_limit=True),
            "the shaft's peak stress under torque alone reaches the fatigue limit of 500 MPa",
        ),
    ],
)
def test_why_the_linear_model_ends(why: ToothTwist | ReachedStress, said: str) -> None:
    assert reason(LinearLimit(88.2, why)) == said
    without = reason(LinearLimit(88.2, why, peaks_solved=False))
    assert without.startswith(f"{said} (without the peak stress at notches")


def test_a_load_torque_beyond_it_is_said() -> None:
    limit = LinearLimit(88.2, ToothTwist(200))
    beyond, within = (design().changed({"load.torque_Nm": torque}) for torque in (5000.0, 0.5))
    (line,) = load_beyond(limit, beyond)
    assert "load.torque_Nm = 5000 exceeds 88.2 N·m" in line
    assert list(load_beyond(limit, within)) == []


def test_a_hat_on_a_shaft_held_over_more_than_its_flange_is_said_beside_K_e() -> None:
    hat = load_design(EXAMPLES / "hat-25.toml")
    assert "too large" in stiffness_notes(hat)["K_e_Nm_per_rad"]
    assert "too large" in next(
        a["note"] for a in answers(content(design=hat)) if a["symbol"] == "K_e"
    )
    K_e = Stiffness(6e5, 599e3, 601e3, False, "solid", "1/8", "hand made", ())
    (line,) = shortfalls(hat, Stiffnesses({"K_e": K_e}))
    assert "too large" in line
    assert not shortfalls(hat, Stiffnesses({"K_b": K_e}))
    touched = hat.flexspline.size(hat.flexspline.land.inner)
    ring = {
        "shaft.segment[0].inner_diameter_mm": touched,
        "shaft.segment[1].outer_diameter_mm": 90.0,
    }
    assert stiffness_notes(hat.changed(ring)) == {}
    assert stiffness_notes(design()) == {}
