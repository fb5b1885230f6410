"""Reversals of torque that fell into a gap of the record."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import AT_CORNER, programme_edges
from flexspline.pipeline.diagnosis.measurement.lost_rows import losses
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.robust import rms

ROWS_BESIDE_LOSS, FEWEST_ROWS_BESIDE_LOSS = 60, 8
"""Most and fewest rows of the straight way on either side, the nearest ones. Judgement."""
STRAIGHT_BESIDE_LOSS = 0.01
"""Of the torque along it, what a straight way's rms may be off a line beyond twice its noise: that of a sine
from its top over an eighth of the cycle is 0.06."""


LARGEST_TORQUE_RATIO = 1.05
"""Largest torque at a lost turn, over the largest torque that was read in its cycles. Judgement."""
MOVED_RIG_STEPS, MOVED_RIG_SIGMAS = 2.0, 3.0
"""Usual steps of torque, and deviations of what two ways say, beyond which a rig has moved between two rows:
one that stood there, and turned then, would seem to have gone on."""


@dataclass(frozen=True)
class LostTurns:
    """Turns between two rows: the row before each (k,), and how much further torque went [N·m] (k,)."""

    rows: np.ndarray
    further_Nm: np.ndarray


def turned_unseen(history: History) -> np.ndarray:
    """(n,) torque [N·m], at the row before a loss of rows that of the turn that was lost with them.

    For what has a memory: it is driven to the turn, though nobody has written it.
    """
    turns = lost_turns(history)
    if not len(turns.rows):
        return history.torque_Nm
    torque = history.torque_Nm.copy()
    torque[turns.rows] += turns.further_Nm
    return torque


def turning_like(history: History, made: History) -> History:
    """`made`, of the same rows, whose torque was made of the history's and turns where that does."""
    lost_turns.keep(made, lost_turns(history))
    return made


@once
def lost_turns(history: History) -> LostTurns:
    """Where the straight ways on either side of a loss of rows, followed between them, meet."""
    turns: dict[int, float] = {}
    if history.time_s is not None and not history.exact:
        units = history.unit_slices
        lost = [losses(history.time_s[rows], history.torque_Nm[rows]) for rows in units]
        edges = programme_edges(history) if any(map(len, lost)) else []
        for rows, after, ways in zip(units, lost, edges, strict=False):
            for (first, turn), (_, last) in pairwise(pairwise(ways.tolist())):
                if turn - 1 in after:
                    way = rows[max(first + AT_CORNER, turn - ROWS_BESIDE_LOSS) : turn]
                    back = rows[turn : min(last - AT_CORNER, turn + ROWS_BESIDE_LOSS)]
                    further = _further(history, way, back)
                    if further is not None:
                        turns[int(rows[turn - 1])] = further
    return LostTurns(np.array([*turns], int), np.array([*turns.values()]))


def _further(history: History, before: np.ndarray, after: np.ndarray) -> float | None:
    """How far beyond its last row a straight way meets the next [N·m]; None where they go on, or apart."""
    assert history.time_s is not None
    if min(len(before), len(after)) < FEWEST_ROWS_BESIDE_LOSS:
        return None
    lines = []
    for rows in (before, after):
        t, torque = history.time_s[rows] - history.time_s[before[-1]], history.torque_Nm[rows]
        line = np.polynomial.Polynomial.fit(t, torque, 1).convert()
        if rms(torque - line(t)) > 2 * torque_noise_Nm(history) + STRAIGHT_BESIDE_LOSS * np.ptp(
            torque
        ):
            return None
        lines.append(line)
    (level, slope), (later, back) = (np.pad(line.coef, (0, 2 - len(line.coef))) for line in lines)
    if slope * back >= 0:
        return None
    at = (later - level) / (slope - back)
    until = history.time_s[after[0]] - history.time_s[before[-1]]
    step = max(np.median(np.abs(np.diff(history.torque_Nm[rows]))) for rows in (before, after))
    doubt = torque_noise_Nm(history) * np.sqrt(4 / len(before) + 4 / len(after))  # at a line's end
    moved = abs(later + back * until - level) > MOVED_RIG_STEPS * step + MOVED_RIG_SIGMAS * doubt
    cycles = np.isin(history.cycle, history.cycle[[before[-1], after[0]]])
    alike = cycles & (history.unit == history.unit[before[-1]])
    most = LARGEST_TORQUE_RATIO * float(np.abs(history.torque_Nm[alike]).max())
    turned = 0 < at < until and abs(level + slope * at) < most
    return float(slope * at) if moved and turned else None
