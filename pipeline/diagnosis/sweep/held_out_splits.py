"""Which rows of a record to hold out: cycles between others; whole amplitudes, rates, temperatures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import log

import numpy as np

from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import cycle_rate


@dataclass(frozen=True)
class _ChannelKind:
    """A channel of which a record may have several levels, and what parts two of them.

    `step` : in the channel's unit, or in the logarithm of its value (`by_ratio`).
    """

    channel: str
    step: float
    by_ratio: bool = False


AMPLITUDE_LEVELS = _ChannelKind("torque_amplitude", log(1.2), by_ratio=True)
"""1.2: the turns of smaller loops are then clear of the larger ones' (two rows at each are never used)."""
RATE_LEVELS = _ChannelKind("torque_rate", log(1.5), by_ratio=True)
"""1.5: what lags in proportion to the rate then differs by half."""
TEMPERATURE_LEVELS = _ChannelKind("temperature_C", 4.0)
"""4 K: what an ordinary room, ±2 K, does not do by itself."""


FEWEST_PLACES, FEWEST_UNITS = 4, 3
"""Positions, or units, of which one can be spared: three show the two amplitudes of a harmonic and a zero,
two what units have in common."""
EVERY = 3
"""Of cycles or positions, one in so many is held out. By judgement: no two neighbours are, and two thirds of
the rows are left to learn from."""


@dataclass(frozen=True)
class Split:
    """What is held out, and its rows (n,)."""

    what: LeftOut
    rows: np.ndarray


def between_others(
    history: History, own_cycle: np.ndarray, units: tuple[str, ...], judged: np.ndarray
) -> Split | None:
    """Whole cycles, or positions, or units.

    Every third cycle, never the first: the last is kept for fitting where there are more than two, so
    that what changes from cycle to cycle is not extrapolated. None where nothing can be spared.
    `own_cycle` (n,) and `units` are the file's own cycle numbers and names; `judged` (n,) the rows on which a
    prediction may be: where amplitudes rise, whole cycles come before the first turn from the largest.
    """
    present = np.unique(history.cycle)
    count = len(present)
    if count >= 2:
        inner = [c for c in range(1, count - 1) if judged[history.cycle == present[c]].any()]
        rows = np.isin(history.cycle, present[inner[::EVERY] or [1]])
        return Split(_cycles(history, own_cycle, units, rows), rows)
    position = history.input_angle_deg
    if position is not None and len(spots := np.unique(position)) >= FEWEST_PLACES:
        chosen_places = spots[1::EVERY]
        left = LeftOut("input_angle_deg", tuple(map(float, chosen_places)))
        return Split(left, np.isin(position, chosen_places))
    slices = history.unit_slices
    if len(slices) >= FEWEST_UNITS:
        rows = np.zeros(len(history), bool)
        rows[slices[1]] = True
        return Split(LeftOut("unit", names=(units[history.unit[slices[1][0]]],)), rows)
    return None


def _cycles(
    history: History, own_cycle: np.ndarray, units: tuple[str, ...], rows: np.ndarray
) -> LeftOut:
    """The cycles of the rows (n,) by the file's own numbers, of each unit where units begin at others."""
    if len(np.unique(own_cycle - history.cycle)) == 1:
        return LeftOut("cycle", tuple(map(float, np.unique(own_cycle[rows]))))
    of_units = (
        (units[u], tuple(map(float, np.unique(own_cycle[rows & (history.unit == u)]))))
        for u in np.unique(history.unit[rows])
    )
    return LeftOut("cycle", of_units=tuple(of_units))


def affordable(levels: list[Split], most: int) -> list[Split]:
    """So many of the levels at most: of each channel the two ends, the last channel before the others.

    Then what lies between the ends, where there is room. Of a channel whose ends have none nothing is taken,
    and one of a single level comes last: what is judged alone says nothing of a cause (`held_out.refuted`).
    """
    of_channel: dict[str, list[int]] = {}
    for i, split in enumerate(levels):
        of_channel.setdefault(split.what.channel, []).append(i)
    chosen: list[int] = []
    between: list[int] = []
    for c in sorted(reversed(of_channel.values()), key=lambda c: len(c) == 1):
        ends = sorted({c[0], c[-1]})
        if len(chosen) + len(ends) <= most:
            chosen += ends
            between += c[1:-1]
    chosen += between[: most - len(chosen)]
    return [levels[i] for i in sorted(chosen)]


def whole_levels(history: History, timed: bool) -> list[Split]:
    """Whole amplitudes, rates and temperatures, where a record has several of them.

    Of each channel the lowest, the middle and the highest, one at a time.

    `timed` : whether time was recorded. A level in which all cycles of a unit lie is none for that unit:
    its zero would not be known.
    """
    cycles = history.cycle_slices
    splits: list[Split] = []
    for kind, values in _values(history, cycles, timed):
        levels = _levels(np.log(values) if kind.by_ratio else values, kind.step)
        last = int(levels.max())
        for level in sorted({0, (last + 1) // 2, last}) if last > 0 else ():
            chosen = levels == level
            rows = np.zeros(len(history), bool)
            rows[np.concatenate([cycles[k] for k in np.flatnonzero(chosen)])] = True
            for unit in history.unit_slices:
                rows[unit] &= not rows[unit].all()
            if rows.any() and not any(np.array_equal(rows, other.rows) for other in splits):
                ends = (float(values[chosen].min()), float(values[chosen].max()))
                splits.append(Split(LeftOut(kind.channel, ends, level=True), rows))
    return splits


def _values(
    history: History, cycles: list[np.ndarray], timed: bool
) -> Iterator[tuple[_ChannelKind, np.ndarray]]:
    """The value of each cycle in each channel that may have levels."""
    torque, temperature = history.torque_Nm, history.temperature_C
    peaks = np.array([np.abs(torque[rows]).max() for rows in cycles])
    if (peaks > 0).all():
        yield AMPLITUDE_LEVELS, peaks
    if timed:
        rates = np.array([cycle_rate(history, rows) for rows in cycles])
        if (rates > 0).all():
            yield RATE_LEVELS, rates
    if temperature is not None:
        yield TEMPERATURE_LEVELS, np.array([temperature[rows].mean() for rows in cycles])


def rate_range(history: History) -> tuple[float, float]:
    """The quickest and the slowest cycle's torque rate [N·m/s]; zeros where time or rows do not tell."""
    if history.time_s is None:
        return 0.0, 0.0
    rates = [rate for rows in history.cycle_slices if (rate := cycle_rate(history, rows)) > 0]
    return (max(rates), min(rates)) if rates else (0.0, 0.0)


def _levels(values: np.ndarray, step: float) -> np.ndarray:
    """(c,) level of each cycle, counted upwards: one begins where a value is a step above its first."""
    out = np.zeros(len(values), int)
    order = np.argsort(values, kind="stable")
    first, level = values[order[0]], 0
    for k in order:
        if values[k] > first + step:
            first, level = values[k], level + 1
        out[k] = level
    return out
