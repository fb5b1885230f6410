"""Against the gear's curve: a gear stiffer or softer all over is no hardening, and no spring in series is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.gear.gear_chain import Chain, chain_of
from flexspline.pipeline.gear.gear_curve import LOADING
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.summary import summary

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed({"shaft.bolt_count": 0})
LARGEST_Nm, HALF_GAP_arcsec, COMPLIANCE = 10.0, 29.32, 24.19
"""Half the free angle and the chord of that gear's curve, arcsec and arcsec per N·m."""
K_b, K_e = 31_300.0, 44_000.0


@pytest.fixture(scope="module")
def chain() -> Chain:
    return chain_of(analysis_context(DESIGN))


Twist = Callable[[np.ndarray], np.ndarray]


@pytest.fixture(scope="module")
def gear_twist(chain: Chain) -> Twist:
    """The gear's angle beyond half its gap [arcsec], of a size of torque."""
    grid = LARGEST_Nm * np.concatenate(
        [[0.0], np.linspace(0.001, 0.2, 60), np.linspace(0.21, 1, 80)]
    )
    curve = chain.angles(grid[1:].tolist()) * ARCSEC_PER_RAD - HALF_GAP_arcsec
    return lambda torque: np.interp(torque, grid, np.concatenate([[0.0], curve]))


def recorded(chain: Chain, twist: Twist, folder: Path, friction_Nm: float = 0.0) -> Diagnosis:
    """Four cycles of a twist [arcsec] of the size of torque at the teeth, behind the gap and friction."""
    share = np.concatenate([np.linspace(0, 1, 60), np.linspace(1, -1, 120), np.linspace(-1, 0, 60)])
    torque = LARGEST_Nm * np.tile(share, 4)
    teeth, at = np.zeros(len(torque)), 0.0
    for i, now in enumerate(torque):
        at = min(max(at, now - friction_Nm), now + friction_Nm)
        teeth[i] = at
    angle = np.sign(teeth) * (HALF_GAP_arcsec + twist(np.abs(teeth)))
    angle += np.random.default_rng(5).normal(0, 0.4, len(torque))
    path = folder / "sweep.csv"
    text = "".join(
        f"{i // 240 + 1},{i},{t:.4f},{a:.3f}\n"
        for i, (t, a) in enumerate(zip(torque, angle, strict=True))
    )
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text)
    return diagnose_file(DESIGN, path, K_b, K_e, chain=chain)


@pytest.fixture(scope="module")
def soft(chain: Chain, gear_twist: Twist, tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    """Of a third of the twist."""
    return recorded(chain, lambda t: gear_twist(t) / 3, tmp_path_factory.mktemp("soft"))


@pytest.mark.parametrize(
    ("times", "spring"),
    [
        (1 / 3, 0.0),
        pytest.param(0.5, 0.0, marks=pytest.mark.long),
        pytest.param(1.6, 0.0, marks=pytest.mark.long),
        pytest.param(1.0, 5.0, marks=pytest.mark.long),
        (1.0, 20.0),
    ],
)
def test_a_gear_of_another_stiffness_is_that_and_nothing_else(
    times: float, spring: float, chain: Chain, gear_twist: Twist, soft: Diagnosis, tmp_path: Path
) -> None:
    """With a `spring` [arcsec per N·m] behind."""
    if (times, spring) == (1 / 3, 0.0):
        found = soft
    else:
        found = recorded(chain, lambda t: times * gear_twist(t) + spring * t, tmp_path)
    assert found.verdict == "named"
    assert [c.id for c in found.causes] == ["series_compliance"]
    expected = 100 * (times - 1 + spring / COMPLIANCE)
    # half a percent: the curve is straight between its places
    assert found.causes[0].magnitude == pytest.approx(expected, abs=0.5)
    assert any("the same factor as its slope" in n for n in notes(found)) == (spring == 0)
    assert found.prediction.bend is not None
    assert found.model is not None
    simulated, kept = (max(bend.angle_arcsec) for bend in (found.prediction.bend, found.model.bend))
    assert kept == pytest.approx(times * simulated, rel=0.01)


def test_the_error_before_is_that_of_the_simulation(chain: Chain, soft: Diagnosis) -> None:
    """Nothing of the record's own bend goes into the simulation as it stands."""
    found = soft
    assert found.outcome.gain is not None
    grid = LARGEST_Nm * np.linspace(0.05, 0.98, 200)
    off = 2 / 3 * (chain.angles(grid.tolist()) * ARCSEC_PER_RAD - HALF_GAP_arcsec)
    assert found.outcome.gain.rmse_before == pytest.approx(np.sqrt((off**2).mean()), rel=0.02)


def test_a_stiffer_gear_with_a_soft_wind_up_and_friction_is_all_three(
    chain: Chain, gear_twist: Twist, tmp_path: Path
) -> None:
    """A wind-up of 14 arcsec each way, gone at a third of the torque, on a gear of 0.72 of the twist."""
    friction = 0.25

    def twist(torque: np.ndarray) -> np.ndarray:
        return 0.72 * gear_twist(torque) + 14 * np.tanh(torque / 1.2)

    found = recorded(chain, twist, tmp_path, friction)
    causes = {c.id: c for c in found.causes}
    assert {*causes} == {"series_compliance", "stiffness_hardening", "friction_hysteresis"}
    assert all(not c.alternatives for c in found.causes)  # two branches are no spring's
    stiffer = causes["series_compliance"]
    assert stiffer.magnitude == pytest.approx(-28.0, abs=1.5)
    assert causes["friction_hysteresis"].ahead_Nm == pytest.approx(friction, rel=0.1)
    low, high = (np.array(ends) * LARGEST_Nm for ends in ((0.05, 0.2), (0.8, 1.0)))
    softer = [
        np.ptp(0.72 * COMPLIANCE * at + 14 * np.tanh(at / 1.2)) / np.ptp(at) for at in (low, high)
    ]
    hardening = causes["stiffness_hardening"]
    assert hardening.magnitude == pytest.approx(softer[0] / softer[1], abs=0.02)
    assert not found.outcome.unexplained


@pytest.mark.parametrize("slope", [0.7, pytest.param(1.3, marks=pytest.mark.long)])
def test_a_straight_line_has_lost_the_bend_and_keeps_its_slope(
    slope: float, chain: Chain, gear_twist: Twist, tmp_path: Path
) -> None:
    """What no cause has a name for is said to be missing, and makes no cause of itself."""
    found = recorded(chain, lambda t: slope * COMPLIANCE * t, tmp_path)
    assert [c.id for c in found.causes] == ["series_compliance"]
    assert found.causes[0].magnitude == pytest.approx(100 * (slope - 1), abs=1.0)
    (lost,) = found.outcome.unexplained
    assert lost.structure == (UnnamedForm("less_bend"),)
    said = summary(found) + " ".join(notes(found))
    assert "the same factor as its slope" not in said
    # the simulated bend: what a straight line and a step at zero leave of the gear's curve
    grid = np.linspace(0.05, 1, 200) * LARGEST_Nm
    curve = gear_twist(grid)
    off = curve - np.polyval(np.polyfit(grid, curve, 1), grid)
    assert lost.rms == pytest.approx(min(1.0, slope) * np.sqrt((off**2).mean()), rel=0.25)


def test_a_curve_between_the_points_that_are_written_is_as_simulated(
    chain: Chain, tmp_path: Path
) -> None:
    """Straight lines between the torques of the gear's own curve, and friction: no structure over torque."""
    up = LARGEST_Nm * np.array(LOADING)
    curve = chain.angles(up.tolist()) * ARCSEC_PER_RAD - HALF_GAP_arcsec
    found = recorded(chain, lambda t: np.interp(t, up, curve), tmp_path, 0.2)
    assert [c.id for c in found.causes] == ["friction_hysteresis"]
    assert found.causes[0].ahead_Nm == pytest.approx(0.2, rel=0.05)
    assert not found.outcome.unexplained
    assert found.calibration is not None
    assert found.calibration.compliance is not None
    assert found.calibration.compliance.value == pytest.approx(COMPLIANCE, rel=0.005)
