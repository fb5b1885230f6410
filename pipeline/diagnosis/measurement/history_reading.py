"""A table with torque as a history: units, cycles, and an order of time that is checked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.coarse_clock import spread_stamps
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.table import MeasuredTable
from flexspline.pipeline.diagnosis.measurement.time_stamps import is_clock, is_short

LARGEST_CYCLE = 1_000_000
"""A cycle a second for eleven days; a larger number is a slipped column."""

CYCLE_SHARE = 0.1
"""Share of the largest torque: five times the largest noise. A loop that reaches so far on both sides is a
cycle, even beside others ten times larger."""


@dataclass(frozen=True)
class NamedHistory:
    """A file's history, the names of its units, and the file's own cycle numbers of each."""

    history: History
    units: tuple[str, ...]
    cycles: tuple[tuple[float, ...], ...]


def history_of(table: MeasuredTable) -> NamedHistory:
    """What the rig did, by a table with `torque_Nm`; a clock that stands still was not recorded.

    Raises
    ------
    MeasurementError : time or cycles that run backwards within a unit; cycles that are no numbers.
    """
    n = len(table)
    names = tuple(dict.fromkeys(table.labels.get("unit", ("",))))
    code = {name: i for i, name in enumerate(names)}
    unit = np.array([code[u] for u in table.labels.get("unit", ("",) * n)])
    over = ""
    if is_short(table.read_as.began):
        over = "; past the hour? write hours too, or let the minutes go on beyond 59"
    elif is_clock(table.read_as.began):
        over = "; past midnight? write the date beside it"
    _refuse_backward(table, "time_s", unit, "time runs backwards", over)
    _refuse_backward(table, "cycle", unit, "cycle numbers run backwards")
    torque = table.numbers["torque_Nm"]
    recorded = "cycle" in table.numbers
    cycle = table.numbers["cycle"] if recorded else np.zeros(n)
    if recorded:
        odd = np.flatnonzero((cycle != np.floor(cycle)) | (cycle < 0))
        if len(odd):
            raise table.refuse(
                int(odd[0]), f"cycle = {cycle[odd[0]]:g} is not a whole number from 0"
            )
        large = np.flatnonzero(cycle > LARGEST_CYCLE)
        if len(large):
            raise table.refuse(
                int(large[0]), f"cycle = {cycle[large[0]]:g} is beyond {LARGEST_CYCLE}"
            )
    counted = np.zeros(n, int)
    own: list[tuple[float, ...]] = []
    for u in range(len(names)):
        rows = np.flatnonzero(unit == u)
        given = cycle[rows] if recorded else counted_cycles(torque[rows])
        values, index = np.unique(given, return_inverse=True)
        counted[rows] = index if not recorded else (given - values[0]).astype(int)
        own.append(tuple(float(v) for v in values))
    time = table.numbers.get("time_s")
    history = History(
        torque, unit, counted,
        None if time is None or is_frozen(time) else spread_stamps(time, unit),
        table.numbers.get("temperature_C"),
        table.numbers.get("input_angle_deg"),
    )  # fmt: skip
    return NamedHistory(history, names, tuple(own))


def is_frozen(time_s: np.ndarray) -> bool:
    """Whether a clock stands still in all rows, which says no more than no clock."""
    return len(time_s) > 1 and bool(np.ptp(time_s) == 0)


def counted_cycles(torque_Nm: np.ndarray) -> np.ndarray:
    """Cycle number (n,) from 1, where the file has none.

    A cycle ends where the torque, having been beyond `CYCLE_SHARE` of its largest value on both sides, last
    rose through 0 before going beyond it again.
    """
    limit = CYCLE_SHARE * np.abs(torque_Nm).max()
    far = np.flatnonzero(np.abs(torque_Nm) > limit)
    positive = torque_Nm[far] > 0
    returns = far[1:][positive[1:] & ~positive[:-1]]  # first row beyond it after a row beyond −
    first_positive = far[positive][:1]
    starts = []
    for row in returns:
        if len(first_positive) and row > first_positive[0]:
            below = np.flatnonzero(torque_Nm[:row] <= 0)
            starts.append(below[-1] + 1)
    return 1.0 + np.searchsorted(np.array(starts, int), np.arange(len(torque_Nm)), side="right")


def _refuse_backward(
    table: MeasuredTable, name: str, unit: np.ndarray, reason: str, advice: str = ""
) -> None:
    values = table.numbers.get(name)
    if values is None:
        return
    for u in np.unique(unit):
        rows = np.flatnonzero(unit == u)
        back = np.flatnonzero(np.diff(values[rows]) < 0)
        if len(back):
            row = rows[back[0] + 1]
            was = values[rows[back[0]]]
            times_said = f"{name} = {values[row]:g} after {was:g}"
            raise table.refuse(int(row), f"{reason}: {times_said}{advice}")
