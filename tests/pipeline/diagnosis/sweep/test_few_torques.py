"""Records of few torques: what lies between them is not known, and a misfit at one of them is no noise."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import history_of, read, simulated, steps

from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import crossing
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.residual.unexplained import COMES_BACK

LARGEST = 20.0  # N·m
GAP = PREDICTION.gap_arcsec


@pytest.mark.parametrize(("each_quarter", "seed"), [(7, 1), (9, 2)])
def test_a_gap_below_the_least_torque_is_no_soft_wind_up(each_quarter: int, seed: int) -> None:
    """Steps of a seventh or a ninth of the torque: whether the gear is soft below the first is not known."""
    history = history_of(steps(LARGEST, each_quarter), 5)
    outcome, _ = diagnose_sweep(
        read(history, simulated(history) + 45.0 * history.sign, seed), PREDICTION
    )
    assert outcome.verdict == "named"
    assert [(c.id, c.alternatives) for c in outcome.causes] == [("clearance_offset", ())]
    # 0.5 arcsec of noise over a hundred rows
    assert outcome.causes[0].magnitude == pytest.approx(90.0, abs=1.0)


@pytest.mark.parametrize("offset", [-1.5, -0.4, 0.9, 2.2])
def test_a_crossing_between_two_rows_is_said_in_the_middle_with_their_distance(
    offset: float,
) -> None:
    torque = np.tile(steps(LARGEST, 10), 3) + 0.3  # rows at 0.3 N·m and 2 N·m apart
    seen = crossing(torque, GAP / 2 * np.sign(torque - offset), GAP, 0.5, 0.0)
    assert seen is not None
    middle = 2.0 * np.floor((offset - 0.3) / 2.0) + 1.3
    # anywhere between the two: their middle, 1/√12 of their distance; the search's grid is 0.4 % of 20 N·m
    assert seen.offset_Nm == pytest.approx(middle, abs=0.1)
    assert seen.std_Nm == pytest.approx(2.0 / np.sqrt(12), rel=0.1)


@pytest.mark.parametrize("noise_Nm", [0.0, 0.02])
def test_a_row_in_the_middle_of_the_gap_says_where_it_is_crossed(noise_Nm: float) -> None:
    """A record that was made with a step of height 0 at torque 0, or a rig that stood in the gap."""
    torque = np.tile(steps(LARGEST, 10), 3)
    rng = np.random.default_rng(3)
    offset = -1.27
    reading = torque + offset + rng.normal(0, noise_Nm, len(torque))
    left = GAP / 2 * np.sign(np.round(torque, 9))
    seen = crossing(reading, left + rng.normal(0, 0.5, len(torque)), GAP, 0.5, noise_Nm)
    assert seen is not None
    # the search's grid of 0.4 % of the torque, and three deviations of a mean of six readings
    assert seen.offset_Nm == pytest.approx(offset, abs=0.1 + 3 * noise_Nm / np.sqrt(6))


def test_a_misfit_at_one_torque_in_every_cycle_is_unknown() -> None:
    """A bump narrower than the steps: two rows of each cycle, which pass for noise of two rows in forty."""
    history = history_of(steps(LARGEST, 10), 6)
    bump = 25.0 * (np.abs(history.torque_Nm + 6.0) < 0.5)
    outcome, _ = diagnose_sweep(read(history, simulated(history) + bump, 4), PREDICTION)
    assert outcome.verdict == "unknown"


def test_the_same_bump_in_one_cycle_does_not_come_back() -> None:
    history = history_of(steps(LARGEST, 10), 6)
    once = 25.0 * ((np.abs(history.torque_Nm - 10.0) < 0.5) & (history.cycle == 2))
    outcome, _ = diagnose_sweep(read(history, simulated(history) + once, 5), PREDICTION)
    assert outcome.verdict == "consistent"
    assert COMES_BACK not in {u.structure for u in outcome.unexplained}
