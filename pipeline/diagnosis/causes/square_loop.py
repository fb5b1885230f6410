"""Friction that reverses at once with the torque: a loop with square ends.

Coulomb friction on a stiff part slips within a torque too small to be read, and a rig that reads torque and
angle on either side of its own friction shows the same.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Shape
from flexspline.pipeline.diagnosis.causes.operators import rising
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import still

SQUARE = "square"
"""The parameter of such an element, and of no other; 1."""


def square_loops(shapes: Sequence[Shape], history: History) -> list[np.ndarray]:
    """Columns (n, 1): −1 while torque rises, and rests then, 1 while it falls.

    With `held` = 0 the chord between the loop's ends is taken off, where the simulated stiffness has it.
    """
    if not shapes:
        return []
    deadband = shapes[0]["deadband_Nm"]
    direction = _from_the_turn(history, rising(history, deadband), deadband)
    chord = history.torque_Nm / shapes[0]["largest_torque_Nm"]
    return [((chord if not s["held"] else 0.0) - direction)[:, None] for s in shapes]


def _from_the_turn(history: History, direction: np.ndarray, deadband_Nm: float) -> np.ndarray:
    """(n,) the direction from the turn on: it is seen only when torque has come back beyond its noise.

    The row of the largest or smallest torque itself is neither: the last one, where torque rests there.
    """
    out, last_at_rest = direction.copy(), np.arange(len(direction))
    for hold in still(history):
        last_at_rest[hold] = hold[-1]
    for rows in history.unit_slices:
        torque, begun = history.torque_Nm[rows], 0
        for seen in np.flatnonzero(np.diff(direction[rows])) + 1:
            before = direction[rows[seen - 1]]
            if before == 0:
                continue
            height = before * torque[begun:seen]
            turn = begun + int(np.argmax(height))
            near = rows[begun:seen][height > height.max() - deadband_Nm]
            resting = last_at_rest[near][last_at_rest[near] > near]
            if len(resting):
                turn = min(int(np.searchsorted(rows, resting.max())), int(seen) - 1)
            out[rows[turn]] = 0.0
            out[rows[turn + 1 : seen]] = direction[rows[seen]]
            begun = turn
    return out
