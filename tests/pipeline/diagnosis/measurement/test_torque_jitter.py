"""The torque's noise, corners and holds, of programmes that are known: triangles at two rates, staircases."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.corners import corners_of
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.torque_jitter import jitter, less_jitter

NOISE = 0.05
"""N·m."""


def triangles(
    periods_s: tuple[float, ...], row_s: float, peak_Nm: float, noise_Nm: float
) -> History:
    """Cycles 0 → + → 0 → − → 0, one of each period, a row every `row_s`."""
    start = np.concatenate([[0.0], np.cumsum(periods_s)])
    t = np.arange(0.3 * row_s, start[-1], row_s)
    cycle = np.searchsorted(start, t, side="right") - 1
    phase = (t - start[cycle]) / np.array(periods_s)[cycle]
    torque = 2 / np.pi * peak_Nm * np.arcsin(np.sin(2 * np.pi * phase))
    rng = np.random.default_rng(3)
    return History(torque + noise_Nm * rng.normal(size=len(t)), np.zeros(len(t), int), cycle, t)


@pytest.mark.parametrize("noise", [0.0, NOISE])
def test_noise_makes_no_corners(noise: float) -> None:
    """Steps of 0.43 N·m a row: three rows' bend has a deviation √6·0.05 = 0.12, and a turn is 0.86."""
    found = corners_of(triangles((100.0,) * 10, 0.43, 25.0, noise))
    true = 25.0 + 50.0 * np.arange(20)
    assert [c.time_s for c in found] == pytest.approx(true, abs=0.43)
    assert [c.change for c in found] == pytest.approx([-2.0, 2.0] * 10, abs=5 * 0.12 / 0.43)


def test_smaller_corners_of_slow_cycles_are_seen_over_more_rows() -> None:
    """At a third of the rate it changes by 2/3 of the quick ramps', in noise of 0.28 of them a row."""
    found = corners_of(triangles((100.0, 300.0, 100.0), 0.43, 25.0, NOISE))
    assert [c.time_s for c in found] == pytest.approx(
        [25, 75, 100, 175, 325, 400, 425, 475], abs=2 * 0.43
    )


def test_the_noise_is_what_is_left_of_the_torque_beside_corners_too() -> None:
    """13 rows know the middle of a parabola to 0.42 of their noise, and its end to √(9/13) = 0.83.

    A straight way of 116 rows is known by its line better: √(2/116) = 0.13.
    """
    noisy, clean = (triangles((100.0,) * 4, 0.43, 25.0, n) for n in (NOISE, 0.0))
    off = noisy.torque_Nm - jitter(noisy, 6) - clean.torque_Nm
    turns = 25.0 + 50.0 * np.arange(8)
    assert noisy.time_s is not None
    beside = np.abs(noisy.time_s[:, None] - turns).min(axis=1) < 6 * 0.43
    # 112 and 800 rows that share their noise with their neighbours: to a quarter, and a tenth
    assert off[~beside].std() == pytest.approx(0.42 * NOISE, rel=0.15)
    assert off[beside].std() < 0.83 * NOISE
    assert np.abs(jitter(clean, 7)).max() < 1e-9
    # eight ways of two numbers each: their squares' mean is 1 ± 3·√(2/16)
    by_lines = less_jitter(noisy).torque_Nm - clean.torque_Nm
    assert by_lines.std() < np.sqrt(1 + 3 * np.sqrt(2 / 16)) * 0.13 * NOISE


def test_a_slow_cycle_is_no_holds() -> None:
    """At a sixth of the quick cycles' rate three rows are no farther apart than their noise."""
    slow = triangles((90.0, 540.0, 90.0), 1.5, 15.0, 0.035)
    # of 360 rows some stand as a hold of that noise would
    assert sum(map(len, holds(slow))) < 0.1 * 360


def test_a_hold_s_noise_is_about_its_mean() -> None:
    level = np.repeat([0.0, 1.0, 0.0, -1.0] * 6, 20)
    ramp = np.convolve(level, np.ones(5) / 5, mode="same")
    t = np.arange(len(ramp)) * 1.0
    noise = 0.01 * np.random.default_rng(5).normal(size=len(t))
    history = History(ramp + noise, np.zeros(len(t), int), (t // 80).astype(int), t)
    found = holds(history)
    assert len(found) >= 20
    rows = found[3]
    torque = history.torque_Nm[rows]
    assert jitter(history, 7)[rows] == pytest.approx(torque - torque.mean(), abs=1e-12)
