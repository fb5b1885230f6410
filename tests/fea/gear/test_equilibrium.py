"""The gear's equilibrium: limits known by hand, energy, and independence of what is only numerical."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.gear.equilibrium import Contacts, EquilibriumError, equilibrium
from flexspline.fea.gear.kinematics import ToothMesh
from flexspline.fea.gear.model import GearModel
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.load import load_design
from flexspline.pipeline.gear import gear_model as settings
from flexspline.pipeline.gear.gear_model import gear_model

DESIGN = load_design(EXAMPLES / "xb1-40.toml")


@pytest.fixture(scope="module")
def model() -> GearModel:
    return gear_model(DESIGN, DESIGN.part("flexspline"))


def test_everything_rigid_turns_through_the_free_angle() -> None:
    """(min g+ + min g−)/(r_p cos α) between a small torque one way and the other."""
    mesh = ToothMesh(20.0, 2 / 202, 0.2, 0.003, radians(20), 0.026)
    phi, _ = mesh.stations(200, 128)
    plain, relief = mesh.free_gaps(phi, 0.2), mesh.relief(phi)
    front, back = plain[0] + relief[0], plain[1] + relief[1]
    assert front.min() > 0
    arm = 20.0 * cos(radians(20))
    turning = np.concatenate([np.full(len(phi), -arm), np.full(len(phi), arm)])
    free = np.concatenate([front, back])
    rigid = Contacts(free, 1e-12 * np.eye(len(free)), turning, np.zeros(len(free)))
    one, other = (equilibrium(rigid, torque).rotation for torque in (1.0, -1.0))
    assert one - other == pytest.approx((front.min() + back.min()) / arm, rel=1e-6)


def test_from_a_known_state_comes_what_comes_from_none(model: GearModel) -> None:
    """Two methods, one equilibrium: near, far off, and the other way."""
    known = model.at_torque(8.0)
    for torque in (8.0, 7.5, 1.0, 0.05, 40.0, -3.0):
        plain, beside = model.at_torque(torque), model.at_torque(torque, known)
        # the interior point leaves forces times gaps of 1e-11 of the largest
        assert beside.rotation == pytest.approx(plain.rotation, rel=1e-6)
        largest = plain.forces.max()
        assert beside.forces == pytest.approx(plain.forces, abs=1e-4 * largest)
        on = plain.forces > 1e-3 * largest
        assert (beside.forces[on] > 0).all()


def test_beside_a_state_whose_contacts_all_pull_all_begins_anew() -> None:
    """Two balls and a tooth at a tenth of the torque: Newton's first step leaves no contact."""
    strained = np.array([[6.90, -18.1, 7.40], [-18.1, 71.5, -29.7], [7.40, -29.7, 16.0]]) * 1e-6
    turning, hertz = np.array([10.0, 10.0, -10.0]), np.array([1e-4, 1e-4, 0.0])
    at = Contacts(np.array([0.0, 0.0, 0.01]), strained, turning, hertz)
    beside = equilibrium(at, 1e3, equilibrium(at, 1e4))
    # by hand: the tooth alone carries 1e3/10 N; c θ = g + S F, 10 θ = 0.01 + 16e-6·100
    assert beside.forces == pytest.approx([0.0, 0.0, 100.0], abs=1e-6)
    assert beside.rotation == pytest.approx(1.16e-3, rel=1e-6)


def test_a_torque_without_teeth_is_refused() -> None:
    nothing = Contacts(np.array([-0.1]), np.eye(1), np.zeros(1), np.zeros(1))
    with pytest.raises(EquilibriumError, match="no tooth"):
        equilibrium(nothing, 5.0)


def test_one_spring_and_one_ball_by_hand() -> None:
    """A flank (1e-5 mm/N, arm 20 mm) turns (g + s F)/arm; a ball squeezed by 10 µm carries (0.01/C)^1.5."""
    at = Contacts(
        np.array([0.002, -0.01]),
        np.diag([1e-5, 0.0]),
        np.array([-20.0, 0.0]),
        np.array([0.0, 3e-4]),
    )
    found = equilibrium(at, 1000.0)
    assert found.forces == pytest.approx([50.0, (0.01 / 3e-4) ** 1.5], rel=1e-6)
    assert found.rotation == pytest.approx((0.002 + 50e-5) / 20, rel=1e-6)
    assert found.slope == pytest.approx(1e-5 / 400, rel=1e-6)


def test_forces_push_and_act_only_where_gaps_are_closed(model: GearModel) -> None:
    at, found = model.contacts, model.at_torque(12.0)
    gap = (
        at.free + found.rotation * at.turning + at.compliance @ found.forces
        + at.hertz * found.forces ** (2 / 3)
    )  # fmt: skip
    size, largest = np.abs(at.free).max(), found.forces.max()
    assert found.forces.min() >= 0
    assert gap.min() > -1e-8 * size
    assert (found.forces * gap).max() < 1e-8 * size * largest
    assert -at.turning @ found.forces == pytest.approx(12.0 * NMM_PER_NM / 2)


def test_the_work_of_loading_is_stored(model: GearModel) -> None:
    """∫ T dθ from 0.5 to 12 N·m = change of ½ F·S F and of (2/5) C F^(5/3) of the balls."""

    def stored(forces: np.ndarray) -> float:
        at = model.contacts
        return float(forces @ at.compliance @ forces / 2 + 0.4 * at.hertz @ forces ** (5 / 3))

    torques = np.linspace(0.5, 12.0, 30)
    states = [model.at_torque(torques[0])]
    for torque in torques[1:].tolist():
        states.append(model.at_torque(torque, states[-1]))
    angle = np.array([s.rotation for s in states])
    half = torques * NMM_PER_NM / 2
    work = float(((half[1:] + half[:-1]) / 2 * np.diff(angle)).sum())
    # 29 steps, trapezoids: 1e-3
    assert stored(states[-1].forces) - stored(states[0].forces) == pytest.approx(work, rel=1e-3)


def test_both_ways_alike_and_unloading_is_loading(model: GearModel) -> None:
    up = model.at_torque(8.0)
    assert model.at_torque(-8.0).rotation == pytest.approx(-up.rotation, rel=1e-6)
    beyond = model.at_torque(20.0)
    assert model.at_torque(8.0, beyond).rotation == pytest.approx(up.rotation, rel=1e-6)


def test_the_tangent_is_the_curve_s_slope_and_the_shares_are_its_parts(model: GearModel) -> None:
    here = model.at_torque(12.0)
    less, more = (model.at_torque(12.0 + d).rotation for d in (-0.02, 0.02))
    per_Nm = here.slope * NMM_PER_NM / 2
    assert (more - less) / 0.04 == pytest.approx(per_Nm, rel=0.02)  # Hertz bends the curve
    assert sum(model.compliance_of(here).values()) == pytest.approx(here.slope / 2, rel=1e-4)


def K_of(model: GearModel) -> np.ndarray:
    torques = np.array([0.0232, 3.48, 11.6, 23.2])
    angles = [model.at_torque(float(t)).rotation for t in torques]
    return np.diff(torques) / np.diff(angles)


@pytest.fixture(scope="module")
def K(model: GearModel) -> np.ndarray:
    """Solved once for all that change the model."""
    return K_of(model)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        pytest.param("LAST_HARMONIC", 96, marks=pytest.mark.long),
        ("PLACES", 9),
        pytest.param("GROOVE_SHARE", 0.15, marks=pytest.mark.long),
        pytest.param("FACE_PLACES", {"relieved": 9}, marks=pytest.mark.long),
    ],
)
def test_what_is_only_numerical_does_not_show(
    K: np.ndarray, monkeypatch: pytest.MonkeyPatch, name: str, value: object
) -> None:
    """Twice the harmonics and angles, twice the places, a ball that presses on half the width."""
    monkeypatch.setattr(settings, name, value)
    finer = gear_model(DESIGN, DESIGN.part("flexspline"))
    assert K_of(finer) == pytest.approx(K, rel=0.005)  # what K is told to


def test_no_play_is_stiffer_at_first_than_play(model: GearModel, K: np.ndarray) -> None:
    tight = replace(model, wave_generator=replace(model.wave_generator, play=0.0))
    assert K_of(tight)[0] > K[0]
