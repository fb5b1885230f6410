"""The whole gear of designs drawn at random: a curve comes, and more torque turns it farther."""

from __future__ import annotations

import numpy as np
import pytest
from random_designs import design_of

from flexspline.geometry.load import design_from
from flexspline.geometry.rated import rated_torque
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.gear.gear_chain import Chain, chords
from flexspline.pipeline.gear.gear_curve import LOADING, curve_of
from flexspline.pipeline.gear.gear_model import even, gear_model


@pytest.mark.parametrize(
    "seed", [5, 20, *(pytest.param(n, marks=pytest.mark.long) for n in (12, 13, 98))]
)
def test_more_torque_turns_it_farther(seed: int) -> None:
    """Cups and hats, thin and thick, of 30 to 301 teeth, one without room for two edges along its seat."""
    design = design_from(design_of(seed, slips=False))
    chain = Chain(gear_model(design, design.part("flexspline")), 0.0, 0.0)
    curve = curve_of(design, chain)
    torque, angle = np.array(curve.torque_Nm), np.array(curve.angle_arcsec)
    up = slice(0, len(LOADING))
    assert np.diff(angle[up]).min() > 0
    # the curve's other branches are solved here, begun from full torque: without friction the way back is
    # the way there, and both ways are alike, to what the forces settle to
    rated = curve.rated_torque_Nm
    back = ARCSEC_PER_RAD * chain.angles([rated, 0.5 * rated, 0.04 * rated, -0.04 * rated, -rated])
    there = np.interp([rated, 0.5 * rated, 0.04 * rated], torque[up], angle[up])
    assert back == pytest.approx([*there, *-there[[2, 0]]], rel=1e-4, abs=1e-3)
    assert len(torque) == len(angle) == 4 * len(LOADING) - 2
    assert (torque[0], torque[-1], torque.min()) == pytest.approx(
        (torque[up].min(), -torque[up].min(), -rated)
    )
    assert angle == pytest.approx(
        np.interp(np.abs(torque), torque[up], angle[up]) * np.sign(torque)
    )
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


def test_straight_lines_between_the_torques_are_the_curve() -> None:
    """Further teeth meet all along it: to half of what the model's own discretisation moves it by, 0.5 %."""
    design = design_from(design_of(5, slips=False))
    chain = Chain(gear_model(design, design.part("flexspline")), 0.0, 0.0)
    up, between = np.array(LOADING), np.linspace(LOADING[0], 1.0, 120)
    rated, _ = rated_torque(design)
    drawn, there = (chain.angles((rated * shares).tolist()) for shares in (up, between))
    off = np.abs(np.interp(between, up, drawn) - there).max()
    assert off < 0.0025 * (drawn[-1] - drawn[0])
