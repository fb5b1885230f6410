"""Teeth that the load presses out of their spaces."""

from __future__ import annotations

from dataclasses import replace
from math import sin

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.gear.engagement import TORQUE_SHARE, Engagement
from flexspline.fea.gear.model import GearModel
from flexspline.geometry.load import load_design
from flexspline.geometry.rated import rated_torque
from flexspline.pipeline.gear.gear_model import gear_model

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
RATED = rated_torque(DESIGN)[0]


@pytest.fixture(scope="module")
def model() -> GearModel:
    return gear_model(DESIGN, DESIGN.part("flexspline"))


def test_withdrawal_is_what_opens_both_gaps(model: GearModel) -> None:
    """g+ + g− = j + 2 y sin α: by the contacts' own gaps, less what flanks were relieved and teeth yield."""
    engagement, mesh, teeth = Engagement(model), model.mesh, len(model.tooth_angles)
    held = engagement.held(RATED)
    assert held is not None
    assert held.out.sum() <= 1  # at the end of the working depth
    contacts, forces, still = engagement.contacts, held.at.forces, np.zeros(teeth)
    plain = np.array(mesh.gaps(model.tooth_angles, still, still)).ravel()
    relieved = contacts.free[: 2 * teeth] - plain
    yields = model.pair / model.teeth_per_station * forces[: 2 * teeth]
    gaps = contacts.free + held.at.rotation * contacts.turning + contacts.compliance @ forces
    front, back = (gaps[: 2 * teeth] - relieved - yields).reshape(2, teeth)
    y = (front + back - mesh.clearance) / (2 * sin(mesh.pressure_angle))
    # the circular spline takes part in the gaps as in the withdrawal
    found = engagement.withdrawal(held.at)
    assert found[~held.out] == pytest.approx(y[~held.out], abs=1e-6 * mesh.stroke)


def test_unloaded_teeth_all_hold(model: GearModel) -> None:
    """Up to one at the end of the working depth, where the rim is no ideal ellipse."""
    held = Engagement(model).held(1e-3 * RATED)
    assert held is not None
    assert held.out.sum() <= 1


def test_faces_hardly_matter(model: GearModel) -> None:
    """One place along the face, condensed again, in place of five that move as one."""
    single = gear_model(DESIGN, DESIGN.part("flexspline"), face_places=1)
    limits = [Engagement(each).limit(RATED) for each in (model, single)]
    assert limits[0] == pytest.approx(limits[1], rel=2 * TORQUE_SHARE)


def test_without_balls_twice_the_modulus_holds_twice_the_torque(model: GearModel) -> None:
    """All else is linear: the same gaps close at the same displacements."""
    rigid = replace(model, race=None)
    body, spline = rigid.rim.body, rigid.spline
    assert spline is not None
    stiff = replace(
        rigid,
        rim=replace(rigid.rim, body=replace(body, harmonics=body.harmonics / 2)),
        spline=replace(spline, harmonics=spline.harmonics / 2),
        pair=rigid.pair / 2,
    )
    limits = [Engagement(each).limit(RATED) for each in (rigid, stiff)]
    assert limits[0] is not None
    assert limits[1] == pytest.approx(2 * limits[0], rel=2 * TORQUE_SHARE)


def test_deeper_teeth_hold_longer(model: GearModel) -> None:
    shallow = replace(model, mesh=replace(model.mesh, depth=0.8))
    limits = [Engagement(each).limit(RATED) for each in (shallow, model)]
    assert None not in limits
    assert limits[0] < limits[1]  # type: ignore[operator]


def test_what_lets_go_is_beyond_and_what_holds_below(model: GearModel) -> None:
    engagement = Engagement(model)
    limit = engagement.limit(RATED)
    assert limit is not None
    assert engagement.held(limit * (1 - 2 * TORQUE_SHARE)) is not None
    assert engagement.held(limit * (1 + 2 * TORQUE_SHARE)) is None


def test_teeth_do_not_pass_through_a_soft_circular_spline() -> None:
    """Of 1e-3 GPa: its ring would move by millimetres under a torque that a steel one carries, and a tooth is
    0.45 mm high."""
    rubber = {"name": "rubber", "youngs_modulus_GPa": 1e-3, "poissons_ratio": 0.3}
    soft = DESIGN.changed({"material.circular_spline": rubber})
    assert Engagement(gear_model(soft, soft.part("flexspline"))).held(RATED) is None
