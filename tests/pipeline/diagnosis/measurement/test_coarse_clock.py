"""Times of rows that share a stamp."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.coarse_clock import spread_stamps


@pytest.mark.parametrize("step_s", [1.0, 60.0])
def test_rows_of_a_second_lie_where_they_were_taken(step_s: float) -> None:
    """Ten rows in each step of the clock: to the tenth of a step, all but the first and the last step's."""
    true = np.arange(200) * step_s / 10 + 0.03 * step_s
    found = spread_stamps(np.floor(true / step_s) * step_s, np.zeros(200, int))
    assert found == pytest.approx(true, abs=0.1 * step_s)


@pytest.mark.parametrize("rows_a_second", [16.67, 7.3, 10.0])
@pytest.mark.parametrize("lost", [((100, 180),), ((100, 180), (195, 260), (500, 550))])
def test_a_steady_logger_writes_at_one_distance(
    rows_a_second: float, lost: tuple[tuple[int, int], ...]
) -> None:
    """Seconds cut off by pauses and by the ends hold fewer rows, each at its place to half a row or so."""
    true = np.arange(600) / rows_a_second + 0.77
    for first, last in reversed(lost):
        true = np.delete(true, np.s_[first:last])
    found = spread_stamps(np.floor(true), np.zeros(len(true), int))
    # one row of phase is unknown where every second holds the same rows; two in a second that stands alone
    assert np.abs(found - true).max() < 1.1 / rows_a_second


def test_a_logger_that_changes_its_pace_lies_evenly_in_each_second() -> None:
    true = np.r_[np.arange(200) / 10, 20 + np.arange(800) / 40]
    found = spread_stamps(np.floor(true), np.zeros(len(true), int))
    assert found == pytest.approx(true, abs=1e-9)


def test_single_rows_and_gaps_stay_as_they_are() -> None:
    """Two rows at 5 s, in a record of seconds that pauses for a minute; another unit has its own clock."""
    time = np.array([0.0, 1.0, 5.0, 5.0, 65.0, 0.0, 0.5, 0.5])
    found = spread_stamps(time, np.array([0, 0, 0, 0, 0, 1, 1, 1]))
    assert found.tolist() == [0.0, 1.0, 5.0, 5.5, 65.0, 0.0, 0.5, 0.75]


def test_a_clock_that_never_moves_says_nothing() -> None:
    assert spread_stamps(np.full(3, 7.0), np.zeros(3, int)).tolist() == [7.0] * 3
