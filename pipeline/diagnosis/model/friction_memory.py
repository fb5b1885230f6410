"""The unknown state of friction before a file's first row, and the rows that it still affects."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.closed_loop import loop_widths
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.operators import rising
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import LARGEST_NOISE
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.span import Ends, MeasuredSpan

SMALLER = 0.8
"""Share of the torque of the record's smallest cycle. How friction acts in smaller loops was not measured.
Judgement."""


def memory_variance(model: ExtendedModel, read: History, ends_Nm: Ends) -> np.ndarray:
    """(n,) mean square [arcsec²] by which angles are off if friction remembers one of two ends of torque.

    `read` is the true history on the output. Before its first row each unit has come from the highest
    torque of the model's record or from the lowest: of all pasts within the record these leave a friction
    element furthest apart, and what torque passes wipes either out (Krasnosel'skii, Pokrovskii, Systems
    with Hysteresis (1989), section 2.2). Nothing that follows a row changes it.
    """
    friction = _friction_alone(model)
    plain = friction.angle_of(_after(read, None))
    off = [friction.angle_of(_after(read, end))[_rows_after(read)] - plain for end in ends_Nm]
    return np.asarray(np.mean(np.square(off), axis=0))


def half_loop_arcsec(model: ExtendedModel, largest_Nm: float) -> float:
    """Half the width of the friction's closed loop at this torque, where it is widest."""
    friction = replace(_friction_alone(model), gap_arcsec=0.0)
    return float(np.abs(loop_widths(friction.angle_of, largest_Nm)).max()) / 2


def smaller_loops(span: MeasuredSpan, history: History) -> np.ndarray:
    """(n,) rows of loops that reach much less torque than any cycle of the record.

    A row's loop reaches as far as torque has since the turn before the last. Before a unit's first turn
    there is none: there the memory counts (`memory_variance`).
    """
    least = SMALLER * (span.smallest_loop_Nm or 0.0)
    return reached_Nm(span, history) < least


def reached_Nm(span: MeasuredSpan, history: History) -> np.ndarray:
    """(n,) largest |torque| since the turn before the last; infinite before a unit's first turn."""
    largest = max(map(abs, span.torque_Nm))
    rises = rising(history, LARGEST_NOISE * largest)  # whatever noise the torque has
    out = np.full(len(history), np.inf)
    for rows in history.unit_slices:
        direction, size = rises[rows], np.abs(history.torque_Nm[rows])
        turns = np.flatnonzero((np.diff(direction) != 0) & (direction[:-1] != 0)) + 1
        starts = np.r_[0, turns]
        for k in range(1, len(starts)):
            end = starts[k + 1] if k + 1 < len(starts) else len(rows)
            turned = max(starts[k - 1] - 1, 0)  # the turn itself, from which one row may go on far
            before = size[turned : starts[k]].max()
            out[rows[starts[k] : end]] = np.maximum(
                before, np.maximum.accumulate(size[starts[k] : end])
            )
    return out


def _friction_alone(model: ExtendedModel) -> ExtendedModel:
    return replace(model, elements={FRICTION: model.elements.get(FRICTION, ())})


def _after(read: History, torque_Nm: float | None) -> History:
    """The history with a row at this torque before each unit's own; without time, as friction has none."""
    bare = History(read.torque_Nm, read.unit, read.cycle)
    if torque_Nm is None:
        return bare
    first = [rows[0] for rows in read.unit_slices]
    return History(
        np.insert(read.torque_Nm, first, torque_Nm),
        np.insert(read.unit, first, read.unit[first]),
        np.insert(read.cycle, first, read.cycle[first]),
    )


def _rows_after(read: History) -> np.ndarray:
    """(n,) where the history's own rows are in `_after`."""
    first = np.zeros(len(read), int)
    first[[rows[0] for rows in read.unit_slices]] = 1
    return np.arange(len(read)) + np.cumsum(first)
