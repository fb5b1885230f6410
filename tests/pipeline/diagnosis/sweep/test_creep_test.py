"""Torque up in seconds, held for minutes, three times: most rows are holds, and creep is what they show."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from creep_test import CreepTest, Kernel, logarithmic, standard_solid, written
from diagnosed_file import diagnose_file
from hidden.gear import draw_gear, draw_rig

from flexspline.geometry.load import design_from
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_rate

PEAK = 2.0


def history(test: CreepTest, noise_Nm: float) -> History:
    corners, levels = test.corners()
    time = np.arange(0, corners[-1], test.step_s)
    torque = np.interp(time, corners, levels)
    torque += noise_Nm * np.random.default_rng(5).normal(size=len(time))
    return History(torque, np.zeros(len(time), int), np.zeros(len(time), int), time)


@pytest.mark.parametrize("noise_Nm", [0.0, 0.002, 0.02])
@pytest.mark.parametrize("step_s", [0.2, 1.0])
@pytest.mark.parametrize("back", [0.0, -1.0])
def test_rate_and_holds_of_a_creep_test(noise_Nm: float, step_s: float, back: float) -> None:
    test = CreepTest(PEAK, step_s=step_s, back=back)
    made = history(test, noise_Nm)
    # all ramps but the first, of two seconds each, go from one level to the other; noise adds to each of
    # ten steps in a ramp, and the median of so many is shifted by less than a tenth
    rate = PEAK * (1 - back) / test.ramp_s
    assert ramp_rate(made) == pytest.approx(rate, rel=0.1)
    long = [h for h in holds(made) if np.ptp(made.time_s[h]) > test.hold_s / 2]
    assert len(long) == 2 * test.times
    for rows in long:
        # a row may fall to the ramp at either end
        assert np.ptp(made.time_s[rows]) == pytest.approx(test.hold_s, abs=3 * step_s)


@pytest.mark.parametrize("slower", [1, 4, 10, 30])
def test_holds_that_are_logged_slower_than_ramps(slower: int) -> None:
    """Rows 0.2 s apart in ramps, up to 6 s in holds, of which most rows then are."""
    made = history(CreepTest(PEAK, step_s=0.2), 0.002)
    held = np.isin(np.arange(len(made)), np.concatenate(holds(made)))
    rows = np.flatnonzero(~held | (np.arange(len(made)) % slower == 0))
    assert made.time_s is not None
    zero = np.zeros(len(rows), int)
    thinned = History(made.torque_Nm[rows], zero, zero, made.time_s[rows])
    assert ramp_rate(thinned) == pytest.approx(ramp_rate(made), rel=0.1)
    lasting = [
        [seconds for h in holds(found) if (seconds := float(np.ptp(found.time_s[h]))) > 10 * slower]
        for found in (made, thinned)
    ]
    assert lasting[1] == pytest.approx(lasting[0], abs=2 * 0.2 * slower)


def test_steps_of_a_staircase_stay_apart() -> None:
    """25 steps of 4 % of the largest torque, noise a twentieth of a step."""
    levels = np.repeat(np.arange(26) / 25 * PEAK, 30)
    torque = levels + 0.004 * np.random.default_rng(2).normal(size=len(levels))
    zero = np.zeros(len(torque), int)
    assert len(holds(History(torque, zero, zero, np.arange(len(torque), dtype=float)))) == 26


@pytest.mark.parametrize("slower", [3.0, 5.0, 10.0])
@pytest.mark.parametrize("seed", range(5))
def test_a_slow_ramp_is_no_holds(slower: float, seed: int) -> None:
    """A trapezoid, then a slower one, whose ramps move by one to four times the noise between two rows."""
    step, quick = 0.1, PEAK / 2.5
    lasts = np.array([2.5, 10.0, 5.0, 10.0, 2.5])
    corners = np.cumsum([0.0, *lasts, *slower * lasts])
    levels = PEAK * np.array([0, 1, 1, -1, -1, 0, 1, 1, -1, -1, 0])
    time = np.arange(0, corners[-1], step)
    noise = 0.09 * quick * step * np.random.default_rng(seed).normal(size=len(time))
    zero = np.zeros(len(time), int)
    found = holds(History(np.interp(time, corners, levels) + noise, zero, zero, time))
    lasting = [float(np.ptp(time[rows])) for rows in found]
    # a few rows at either end lie in a ramp's first or last, which noise does not tell from the hold
    assert min(lasting) == pytest.approx(10.0, abs=1.0)
    if slower < 4:  # slower ramps do not stand out beside a hold
        assert lasting == pytest.approx([10.0, 10.0, 10.0 * slower, 10.0 * slower], abs=1.0)


def diagnosed(seed: int, kernel: Kernel, back: float, folder: Path) -> Diagnosis:
    rng = np.random.default_rng([4711, seed])
    rig = draw_rig(rng)
    gear = draw_gear(rig, rng)
    peak = rng.uniform(40, 80) / rig.compliance
    test = CreepTest(peak, hold_s=HOLD_s, step_s=1.0, back=back)
    path = folder / "creep.csv"
    path.write_text(written(test, kernel, rig, gear, rng), encoding="utf-8")
    return diagnose_file(design_from(tomllib.loads(rig.toml)), path, rig.K_b, rig.K_e)


HOLD_s = 300.0
CASES = {
    "logarithmic, unloaded": (logarithmic(2.5, 1.0), 0.0),
    "logarithmic, reversed": (logarithmic(3.5, 3.0), -1.0),
    "one relaxation, unloaded": (standard_solid(3.0, 60.0), 0.0),
    "one relaxation, reversed": (standard_solid(2.0, 120.0), -1.0),
}


OFTEN_LIKE = ("logarithmic, reversed", "one relaxation, unloaded")


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
@pytest.mark.parametrize(
    "name",
    # of either law and either programme one
    [pytest.param(c, marks=[pytest.mark.long] * (c in OFTEN_LIKE)) for c in CASES],
)
def test_creep_is_named_and_nothing_else(name: str, seed: int, tmp_path: Path) -> None:
    kernel, back = CASES[name]
    found = diagnosed(seed, kernel, back, tmp_path)
    assert found.verdict == "named"
    assert [c.id for c in found.causes] == ["creep"]
    # docs/contract.md: % of elastic twist in the last decade of a hold
    truth = 100 * float(np.diff(kernel(np.array([HOLD_s / 10, HOLD_s])))[0])
    cause = found.causes[0]
    # three deviations, and the gear's own modulus, which truth is a share of: 2 %
    assert cause.magnitude == pytest.approx(truth, abs=3 * cause.magnitude_std + 0.02 * truth)
    assert cause.magnitude_std < truth / 4


@pytest.mark.parametrize("back", [0.0, -1.0])
def test_no_creep_is_made_up(back: float, tmp_path: Path) -> None:
    assert diagnosed(7, lambda t: 0 * t, back, tmp_path).verdict == "consistent"
