"""Forms in which a record may cross the gap: where, how late, and how sharply.

A form says on which side of the gap each row is. Where a reading has a filter, the gap's step is spread over
the rows after the crossing; where it is only delayed, or friction lies ahead of the teeth, the step is sharp
and comes late in both senses of travel.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import lags, steadied, stops
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s
from flexspline.pipeline.diagnosis.measurement.recursion import first_order
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.sweep.crossing.friction_ahead_guess import LARGEST_FRICTION
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import OFFSET_REACH
from flexspline.pipeline.diagnosis.sweep.crossing.torque_offset_guess import FIRST_STEPS
from flexspline.pipeline.diagnosis.sweep.rig_faults.torque_delay import torque_read_at

FILTER, DELAY, BOTH = "filter", "delay", "both"
"""Kinds of a late angle: through a filter, by a delay, or both readings through one filter."""
RUBBED = "friction"
"""Kind of a crossing behind friction ahead of the teeth."""
SHORTEST_SHARE, LONGEST_SHARE, TIMES = 0.002, 0.4, 32
"""Times tried, as shares of a ramp, each 1.19 times the one before: the best one is refined."""
SOFT_ENDS, SOFT_STEPS = (0.002, 0.1), 24
"""Widths of a gap's soft ends tried, as shares of the largest torque, each 1.19 times the one before."""
FRICTIONS = 45
"""Frictions tried, 1 % of the largest torque apart: the best one is refined."""

Form = Callable[[float], np.ndarray]
"""(n,) side of the gap of each row, −1 … 1, if the torque reading were so much [N·m] higher."""


@dataclass(frozen=True)
class Tried:
    """A form of one kind, by its `value` [N·m or s].

    `followed_Nm` : (n,) torque that the twist follows, where it is not the reading.
    """

    kind: str
    value: float
    form: Form
    followed_Nm: np.ndarray | None = None


def at_a_place(history: History) -> list[Tried]:
    """Crossed at one torque in both senses: a shifted reading, or none."""
    places = np.linspace(-OFFSET_REACH, OFFSET_REACH, FIRST_STEPS) * history.largest_Nm
    return [Tried("offset", p, _sharp(history.torque_Nm - p)) for p in places.tolist()]


def softly(history: History) -> list[Tried]:
    """Crossed at zero, by teeth that take up their load one after another: alike in both senses."""
    torque = history.torque_Nm
    widths = np.geomspace(*SOFT_ENDS, SOFT_STEPS) * history.largest_Nm
    return [Tried("soft", width, soft_side(torque, width)) for width in widths.tolist()]


def behind_friction(
    history: History, frictions_Nm: np.ndarray | None = None, offset_Nm: float = 0.0
) -> list[Tried]:
    """Crossed where friction ahead of the teeth lets the torque pass, which the twist follows; beside a
    shifted reading."""
    if frictions_Nm is None:
        frictions_Nm = np.linspace(0, LARGEST_FRICTION, FRICTIONS + 1)[1:] * history.largest_Nm
    torque = steadied(history, deadband_Nm(history))
    carried = stops(history, torque, frictions_Nm, np.zeros(len(frictions_Nm)))
    at_teeth = history.torque_Nm[:, None] - carried
    return [
        Tried(RUBBED, friction, _sharp(torque - offset_Nm), torque)
        for friction, torque in zip(frictions_Nm.tolist(), at_teeth.T, strict=True)
    ]


def of_time(history: History, kind: str) -> Iterator[Tried]:
    """Forms of one kind that a time tells: of a late angle, a late torque, or of the twist alone.

    Of "twist" (a first-order lag) and "delayed twist" the step is where it should be; the torque reading
    of "torque" is late.
    """
    ramp = ramp_s(history)
    times = ramp * np.geomspace(SHORTEST_SHARE, LONGEST_SHARE, TIMES) if ramp > 0 else np.empty(0)
    yield from (late(history, kind, time) for time in times.tolist())


def late(history: History, kind: str, time_s: float) -> Tried:
    """The form of one kind and time."""
    torque = history.torque_Nm
    if kind in (DELAY, "delayed twist"):
        delayed = torque_read_at(history, -time_s)
        return Tried(kind, time_s, _sharp(delayed if kind == DELAY else torque), delayed)
    if kind == BOTH:  # what a filter made of a ramp is the ramp, later by its time
        true = torque_read_at(history, time_s)
        return Tried(kind, time_s, _spread(history, true, time_s))
    if kind == "torque":
        true = torque_read_at(history, time_s)
        return Tried(kind, time_s, _sharp(true), true)
    lagging = lags(torque, history, np.array([time_s]))[:, 0]
    form = _spread(history, torque, time_s) if kind == FILTER else _sharp(torque)
    return Tried(kind, time_s, form, lagging)


def _sharp(torque_Nm: np.ndarray) -> Form:
    return lambda more: np.sign(torque_Nm + more)


def soft_side(torque_Nm: np.ndarray, width_Nm: float) -> Form:
    """Of teeth that take up their load one after another."""
    return lambda more: np.tanh((torque_Nm + more) / width_Nm)


def _spread(history: History, torque_Nm: np.ndarray, filter_s: float) -> Form:
    return lambda more: filtered_side(history, torque_Nm + more, filter_s)


def filtered_side(history: History, torque_Nm: np.ndarray, filter_s: float) -> np.ndarray:
    """(n,) sign of a torque (n,) through a first-order filter, exact for torque linear between rows."""
    assert history.time_s is not None
    out = np.empty(len(history))
    for rows in history.unit_slices:
        time, torque = history.time_s[rows], torque_Nm[rows]
        side = np.where(torque < 0, -1.0, 1.0)
        step = np.diff(time) / filter_s
        crossed = side[1:] != side[:-1]
        moved = np.where(crossed, torque[:-1] - torque[1:], 1.0)
        after = 1 - np.where(
            crossed, torque[:-1] / moved, 1.0
        )  # share of the step beyond the crossing
        keep, kept_after = np.exp(-step), np.exp(-after * step)
        drive = np.empty(len(rows))
        drive[0] = side[0]
        drive[1:] = side[:-1] * (kept_after - keep) + side[1:] * (1 - kept_after)
        out[rows] = first_order(keep, drive)
    return out
