"""Which rows of a record may name causes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import rising
from flexspline.pipeline.diagnosis.measurement.floors import FINEST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm

SETTLED_AT, SETTLING_SHARE = 0.6, 0.3
"""Share of the largest torque that counts as far from zero, and the largest share of a unit's rows before it
that may be left out. Judgement."""


@dataclass(frozen=True)
class RowCounts:
    """Rows of a sweep by their use; a row left out is counted once, under the first reason that holds."""

    used: int
    crossing: int
    turning: int
    settling: int
    outliers: int

    @property
    def total(self) -> int:
        return self.used + self.crossing + self.turning + self.settling + self.outliers


def row_counts(history: History, band_Nm: float, outlier: np.ndarray) -> RowCounts:
    """How many rows name causes, and why the others do not; `outlier` (n,) mask."""
    left = np.ones(len(history), bool)
    counts = []
    for reason in (
        np.abs(history.torque_Nm) <= band_Nm,
        turning(history),
        settling(history),
        outlier,
    ):
        counts.append(int((left & reason).sum()))
        left &= ~reason
    return RowCounts(int(left.sum()), *counts)


def naming_rows(history: History, band_Nm: float) -> np.ndarray:
    """(n,) rows that may name causes, outliers aside."""
    return (np.abs(history.torque_Nm) > band_Nm) & ~turning(history) & ~settling(history)


def turning(history: History) -> np.ndarray:
    """(n,) rows at which the torque turns, each with the one after it.

    What a row there shows depends on how reading and turning fall together: friction has not turned
    yet, a rate is half of what it was. A few rows of sparse records would decide between them.
    """
    direction = rising(history, deadband_Nm(history) + FINEST_TORQUE_Nm)
    out = np.zeros(len(history), bool)
    for rows in history.unit_slices:
        turned = _turns(direction[rows])
        for back in (0, 1):
            out[rows[turned - back]] = True
    return out


def settling(history: History) -> np.ndarray:
    """(n,) rows before a unit's torque first turns far from zero.

    What a friction element remembers from before the record is not known; the first far turn wipes it
    out. Only where most of the record remains.
    """
    out = before_far_turn(history)
    for rows in history.unit_slices:
        if out[rows].sum() >= SETTLING_SHARE * len(rows):
            out[rows] = False
    return out


def before_far_turn(history: History) -> np.ndarray:
    """(n,) rows before a unit's torque first turns far from zero; all where it never does."""
    direction = rising(history, deadband_Nm(history) + FINEST_TORQUE_Nm)
    far = SETTLED_AT * history.largest_Nm
    out = np.ones(len(history), bool)
    for rows in history.unit_slices:
        turned = [i for i in _turns(direction[rows]) if abs(history.torque_Nm[rows[i]]) > far]
        if turned:
            out[rows[turned[0] :]] = False
    return out


def _turns(direction: np.ndarray) -> np.ndarray:
    """Rows (t,) at which a direction (m,) of ±1, 0 before it first moves, differs from the last row's."""
    turned = np.flatnonzero(np.diff(direction) != 0) + 1
    return turned[direction[turned - 1] != 0]
