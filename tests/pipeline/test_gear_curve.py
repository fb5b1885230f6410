"""The whole gear of designs drawn at random: a curve comes, and more torque turns it farther."""

from __future__ import annotations

import numpy as np
import pytest
from random_designs import design_of

from flexspline.geometry.load import design_from
from flexspline.pipeline.gear import LOADING, Chain, chords, curve_of
from flexspline.pipeline.gear_model import even, gear_model


@pytest.mark.parametrize("seed", [5, 12, 13, 20, 98])
def test_more_torque_turns_it_farther(seed: int) -> None:
    """Cups and hats, thin and thick, of 30 to 301 teeth, one without room for two edges along its seat."""
    design = design_from(design_of(seed, slips=False))
    curve = curve_of(design, Chain(gear_model(design, design.part("flexspline")), 0.0, 0.0))
    torque, angle = np.array(curve.torque_Nm), np.array(curve.angle_arcsec)
    up = slice(0, len(LOADING))
    assert np.diff(angle[up]).min() > 0
    back = slice(len(LOADING) - 1, 2 * len(LOADING) - 1)
    assert torque[back][::-1] == pytest.approx(torque[up])
    # without friction the way back is the way there: to what the forces settle to
    assert angle[back][::-1] == pytest.approx(angle[up], rel=1e-4, abs=1e-3)
    assert curve.teeth_in_contact > 0
    assert min(curve.compliance_shares.values()) >= 0
    assert sum(curve.compliance_shares.values()) == pytest.approx(1)


def test_a_shaft_in_series_adds_its_compliance() -> None:
    design = design_from(design_of(12, slips=False))
    model = gear_model(design, design.part("flexspline"))
    torques = [1.0, 5.0]
    stiff, soft = (
        chords(torques, Chain(model, shaft, 0.0).angles(torques))[0] for shaft in (0.0, 1e-4)
    )
    assert 1 / soft == pytest.approx(1 / stiff + 1e-4)


def test_balls_are_shared_evenly_by_two_lobes() -> None:
    assert (even(23), even(24)) == (24, 24)
