"""Times of rows with a coarse clock: for example whole seconds, with ten rows in each."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

PAUSE = 1.5
"""Times the clock's step: a longer distance between two stamps means that the logger paused."""
FEWEST_WHOLE, FEWEST_OF_STAMP = 2, 2.0
"""Fewest stamps, and fewest rows of a stamp on average, that show at which distance a steady logger
writes."""
STEADY = 1.0
"""Most rows by which equal distances may miss stamps. A logger that misses more is not steady."""


def spread_stamps(time_s: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """(n,) times, in order within each unit; rows of one stamp lie evenly in the clock's step after it.

    The step is the least by which the clock moves on. If all rows of a second had its beginning as their
    time, a ramp would become stairs. Between two pauses of a steady logger all rows lie at one distance: 16.7
    rows a second are not 16 and 17, and a stamp that a pause cuts off holds fewer.
    """
    spread = time_s.astype(float)
    for u in np.unique(unit):
        rows = np.flatnonzero(unit == u)
        stamps, first, count = np.unique(time_s[rows], return_index=True, return_counts=True)
        if len(count) > 1:
            step = float(np.diff(stamps).min())
            starts = np.flatnonzero(np.diff(stamps) > PAUSE * step) + 1
            parts = list(pairwise([0, *starts.tolist(), len(stamps)]))
            distances = [_distance(stamps[a:b], count[a:b], step) for a, b in parts]
            usual = distances[int(np.argmax([b - a for a, b in parts]))]
            for (a, b), own in zip(parts, distances, strict=True):
                within = rows[first[a] : first[b - 1] + count[b - 1]]
                spread[within] = _between_pauses(stamps[a:b], count[a:b], step, own or usual)
    return spread


def _distance(stamps: np.ndarray, count: np.ndarray, step: float) -> float | None:
    """Of the rows of some stamps (m,), of which the first and the last may be cut off; None of too few."""
    if len(count) < FEWEST_WHOLE + 2 or count[1:-1].mean() < FEWEST_OF_STAMP:
        return None
    whole = slice(int(count[0]), int(count[:-1].sum()))
    row = np.arange(int(count.sum()))[whole]
    return float(
        np.polynomial.Polynomial.fit(row, _evenly(stamps, count, step)[whole], 1).deriv()(0.0)
    )


def _evenly(stamps: np.ndarray, count: np.ndarray, step: float) -> np.ndarray:
    """(n,) times of rows that lie evenly in each stamp's step."""
    at = np.repeat(np.arange(len(count)), count)
    in_stamp = np.arange(len(at)) - (np.cumsum(count) - count)[at]
    return np.asarray(stamps[at] + step * in_stamp / count[at])


def _between_pauses(
    stamps: np.ndarray, count: np.ndarray, step: float, distance: float | None
) -> np.ndarray:
    """(n,) times of rows at one distance that keep to their stamps; else evenly in each."""
    if distance is not None:
        stamp, along = np.repeat(stamps, count), distance * np.arange(int(count.sum()))
        earliest, latest = (stamp - along).max(), (stamp - along).min() + step
        if earliest - latest < STEADY * distance:
            return np.asarray((earliest + latest) / 2 + along)
    return _evenly(stamps, count, step)
