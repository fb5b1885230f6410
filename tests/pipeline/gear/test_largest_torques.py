"""What is said of the torques at which the gear ratchets and its tube buckles, one beside the other."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hand_made_curve import gear_curve

from flexspline.fea.gear.tube_buckling import Tube
from flexspline.fea.types import Elastic
from flexspline.pipeline.gear.largest_torques import largest_torques
from flexspline.results.gear_words import gear_notes

TUBE = Tube(radius=19.4, wall=0.4, length=21.25, material=Elastic(206e3, 0.3))
"""Buckles at about 790 N·m."""
SHORT = replace(TUBE, length=1.2)
"""Yields first."""
FIRST, SHARE = "buckles before the gear ratchets", "of their buckling torque"


@pytest.mark.parametrize(
    ("ratchets_Nm", "tube", "first", "share"),
    [
        (1000.0, TUBE, True, True),
        (500.0, TUBE, False, True),
        (None, TUBE, False, True),
        (1000.0, SHORT, False, False),
        (1000.0, None, False, False),
    ],
)
def test_ratcheting_is_set_beside_a_buckling_torque_that_is_given(
    ratchets_Nm: float | None, tube: Tube | None, first: bool, share: bool
) -> None:
    """An upper limit above it says that the tube buckles first; without one nothing refers to it."""
    _, notes = largest_torques(ratchets_Nm, tube, 20.0)
    said = " ".join(gear_notes(replace(gear_curve(10.0, 60.0, 5.0), notes=tuple(notes))))
    assert ("is an upper limit" in said) == (ratchets_Nm is not None)
    assert (FIRST in said) is first
    assert (SHARE in said) is share


def test_equal_torques_are_said_to_be_no_copy() -> None:
    """790 N·m each in two digits."""
    _, notes = largest_torques(TUBE.lower_edge_Nm * 1.001, TUBE, 20.0)
    assert "both_limits_alike" in notes
    _, notes = largest_torques(500.0, TUBE, 20.0)
    assert "both_limits_alike" not in notes
