"""The history of a test: torque and the other channels, row by row."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np


@dataclass(frozen=True)
class History:
    """What a rig did, row by row: the input of every forward model.

    Attributes
    ----------
    torque_Nm : (n,) torque on the output.
    unit : (n,) index of the unit under test; `cycle` (n,) load cycle, counted from 0 in each unit.
    time_s, temperature_C, input_angle_deg : (n,), None where not recorded. `input_angle_deg` is where
        the wave generator was locked.
    readings : (n,) of how many readings each row is the mean; None where it is one of each.
    exact : whether torque is a calculated course, which has no noise.
    number : (n,) of each row in the file, or the mean number of the rows that it is the mean of, where time
        was not recorded; None where the rows are those of the file.
    """

    torque_Nm: np.ndarray
    unit: np.ndarray
    cycle: np.ndarray
    time_s: np.ndarray | None = None
    temperature_C: np.ndarray | None = None
    input_angle_deg: np.ndarray | None = None
    readings: np.ndarray | None = None
    exact: bool = False
    number: np.ndarray | None = None
    memo: dict[tuple[Hashable, ...], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """Results computed from this history and needed again (`once`); not a part of its value."""

    @classmethod
    def course(cls, torque_Nm: np.ndarray) -> History:
        """A calculated course of torque (n,), in one cycle of one unit."""
        none = np.zeros(len(torque_Nm), int)
        return cls(torque_Nm, none, none, exact=True)

    def __len__(self) -> int:
        return len(self.torque_Nm)

    def rows(self, chosen: np.ndarray) -> History:
        """The chosen rows (mask or indices)."""

        def part(values: np.ndarray | None) -> np.ndarray | None:
            return None if values is None else values[chosen]

        return History(
            self.torque_Nm[chosen], self.unit[chosen], self.cycle[chosen],
            part(self.time_s), part(self.temperature_C), part(self.input_angle_deg),
            part(self.readings), self.exact, part(self.number),
        )  # fmt: skip

    def shifted(self, offset_Nm: float) -> History:
        """The true torque, where the reading is `offset_Nm` too high."""
        return replace(self, torque_Nm=self.torque_Nm - offset_Nm)

    def time_or_rows(self, rows: np.ndarray) -> np.ndarray:
        """(m,) time of some rows, by their indices; where it was not recorded, their numbers, from 0."""
        if self.time_s is not None:
            return self.time_s[rows]
        if self.number is None:
            return np.arange(len(rows), dtype=float)
        return self.number[rows] - self.number[rows[:1]]

    def timed(self) -> History:
        """With time; rows are seconds where it was not recorded."""
        if self.time_s is not None:
            return self
        return replace(self, time_s=self.time_or_rows(np.arange(len(self))))

    @property
    def cycle_count(self) -> int:
        """Load cycles of all units."""
        return sum(len(np.unique(self.cycle[rows])) for rows in self.unit_slices)

    @property
    def sign(self) -> np.ndarray:
        """(n,) on which side of the gap the teeth bear: −1, 0 or 1."""
        return np.sign(self.torque_Nm)

    @cached_property
    def largest_Nm(self) -> float:
        """Largest torque, of either sign."""
        return float(np.abs(self.torque_Nm).max())

    @cached_property
    def unit_slices(self) -> list[np.ndarray]:
        """Row indices of each unit, in order."""
        return [np.flatnonzero(self.unit == u) for u in np.unique(self.unit)]

    @property
    def unit_and_cycle(self) -> np.ndarray:
        """(n,) one number for each cycle of each unit, in the order of units and of their cycles."""
        return np.asarray(self.unit * (int(self.cycle.max()) + 1) + self.cycle)

    @property
    def cycle_slices(self) -> list[np.ndarray]:
        """Row indices of each cycle of each unit, in order."""
        key = self.unit_and_cycle
        return [np.flatnonzero(key == k) for k in np.unique(key)]
