"""Rows in which neither torque nor angle moves by a digit: a channel that dropped out."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.record import Sweep

FEWEST_CONSTANT_ROWS = 20
"""Fewest constant rows of a channel that dropped out. Readings with noise seldom agree in both channels even
in two rows in succession. Judgement."""


def constant_lines(sweep: Sweep) -> tuple[int, int] | None:
    """First and last line in the file of the longest run with torque and angle exactly constant, both.

    None where no run has `FEWEST_CONSTANT_ROWS` rows, and where most rows repeat the row before: the record
    has no noise.
    """
    history = sweep.history
    same = (np.diff(history.torque_Nm) == 0) & (np.diff(sweep.angle_arcsec) == 0)
    same &= np.diff(history.unit) == 0
    changes = np.concatenate([[0], np.flatnonzero(~same) + 1, [len(sweep)]])
    rows = np.diff(changes)
    longest = int(rows.argmax())
    if rows[longest] < FEWEST_CONSTANT_ROWS:
        return None
    first = int(changes[longest])
    others = np.delete(same, slice(first, first + int(rows[longest]) - 1))
    if 2 * int(others.sum()) > len(others):
        return None
    return int(sweep.line[first]), int(sweep.line[changes[longest + 1] - 1])
