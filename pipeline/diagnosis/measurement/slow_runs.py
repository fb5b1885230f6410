"""Where torque rests or nearly rests: holds, and the slow rows around a turn."""

from __future__ import annotations

from collections import deque

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.runs import runs
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter

SLOW_RANGE_SHARE = 0.005
"""Of the largest torque, within which torque all but rests: a sixth of the shortest way between two breaks of
an output that sticks, in made-up records (0.03)."""
FEWEST_SLOW_ROWS = 4
"""Rows of a slow run [1]: its mean is compared with those of its four parts
(`sweep/residual/stick_slip_rests.py`)."""
SLOWER_RATIO = 2.0
"""Fewest rows of a slow run, over the median number of rows that torque needs for the span. Judgement."""


def resting(history: History) -> list[np.ndarray]:
    """Rows of each hold and of each other run of rows in which torque moves little, in order."""
    held = holds(history)
    free = np.ones(len(history), bool)
    for rows in held:
        free[rows] = False
    torque = less_jitter(history).torque_Nm
    span = SLOW_RANGE_SHARE * history.largest_Nm
    pieces: list[np.ndarray] = []
    for rows in history.unit_slices:
        for first, end in runs(free[rows]):
            piece = rows[first:end]
            pieces += [piece[a:b] for a, b in _longest(torque[piece], span)]
    if not pieces:
        return held
    fewest = max(FEWEST_SLOW_ROWS, SLOWER_RATIO * float(np.median([len(p) for p in pieces])))
    slow = [p for p in pieces if len(p) >= fewest]
    return sorted([*held, *slow], key=lambda rows: int(rows[0]))


def _longest(torque_Nm: np.ndarray, span_Nm: float) -> list[tuple[int, int]]:
    """Runs (first row, after the last) within a span, none in two of them, the longest chosen first."""
    first, runs = 0, []
    highest: deque[int] = deque()
    lowest: deque[int] = deque()
    for k, value in enumerate(torque_Nm):
        while highest and torque_Nm[highest[-1]] <= value:
            highest.pop()
        while lowest and torque_Nm[lowest[-1]] >= value:
            lowest.pop()
        highest.append(k)
        lowest.append(k)
        while torque_Nm[highest[0]] - torque_Nm[lowest[0]] > span_Nm:
            first += 1
            if highest[0] < first:
                highest.popleft()
            if lowest[0] < first:
                lowest.popleft()
        runs.append((first, k + 1))
    taken = np.zeros(len(torque_Nm), bool)
    longest = []
    for a, b in sorted(runs, key=lambda run: run[0] - run[1]):
        if not taken[a:b].any():
            taken[a:b] = True
            longest.append((a, b))
    return longest
