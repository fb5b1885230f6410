"""Loads of a record: torque goes up from the gap and comes back; how wide the loop is that each leaves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.identification.rate_independence import cycle_rates

FEWEST_LOAD_ROWS = 8
"""Fewest rows of a load on one side of the gap: four each way. Judgement."""
OPEN_SHARE = 0.1
"""Relative difference of the way down from the way up. With more, the load has not ended. Judgement."""
ONE_SIZE = 0.05
"""Relative difference up to which loads have the same amplitude, or the same rate. Judgement."""


@dataclass(frozen=True)
class HalfCycles:
    """`rows` of each half-cycle: from where torque leaves the gap's crossing to where it comes back."""

    history: History
    rows: tuple[np.ndarray, ...]

    @classmethod
    def of(cls, history: History, band_Nm: float) -> HalfCycles:
        """The gap is crossed within ± `band_Nm`, whose rows are no load's."""
        halves = []
        for rows in history.unit_slices:
            torque = history.torque_Nm[rows]
            side = np.where(np.abs(torque) > band_Nm, np.sign(torque), 0)
            begun = np.r_[0, np.flatnonzero(np.diff(side)) + 1]
            parts = zip(np.split(rows, begun[1:]), side[begun], strict=True)
            halves += [own for own, way in parts if way and _returns(history, own)]
        return cls(history, tuple(halves))

    def __len__(self) -> int:
        return len(self.rows)

    @cached_property
    def counts(self) -> np.ndarray:
        """(k,) rows of each."""
        return np.array([len(own) for own in self.rows])

    @cached_property
    def side(self) -> np.ndarray:
        """(k,) sign of the torque."""
        return self.history.sign[self._first]

    @cached_property
    def rates(self) -> np.ndarray | None:
        """(k,) [N·m/s] of each load's cycle; None where cycles do not differ in it."""
        rates = cycle_rates(self.history)
        if rates is None:
            return None
        of_row = np.zeros(len(self.history))
        for rows, rate in zip(self.history.cycle_slices, rates, strict=True):
            of_row[rows] = rate
        return of_row[self._first]

    @cached_property
    def kinds(self) -> np.ndarray:
        """(k,) number of the kind that each is of: of one unit, one side, one amplitude and one rate."""
        amplitude = np.array([np.abs(self.history.torque_Nm[own]).max() for own in self.rows])
        sizes = [amplitude] if self.rates is None else [amplitude, self.rates]
        logs = [np.round(np.log(size.clip(size.max() / 1e9)) / ONE_SIZE) for size in sizes]
        keys = np.column_stack([self.history.unit[self._first], self.side, *logs])
        return np.unique(keys, axis=0, return_inverse=True)[1].ravel()

    def widths(self, angle_arcsec: np.ndarray) -> np.ndarray:
        """(k,) by how much the angle (n,) is larger while torque falls, −∮θ dT over the way up."""
        torque = self.history.torque_Nm
        return np.array([_width(torque[own], angle_arcsec[own]) for own in self.rows])

    def only(self, which: np.ndarray) -> HalfCycles:
        """Those of a mask (k,)."""
        return HalfCycles(self.history, tuple(self.rows[i] for i in np.flatnonzero(which)))

    @cached_property
    def _first(self) -> np.ndarray:
        return np.array([own[0] for own in self.rows])


def _returns(history: History, rows: np.ndarray) -> bool:
    step = np.diff(history.torque_Nm[rows])
    return len(rows) >= FEWEST_LOAD_ROWS and abs(step.sum()) < OPEN_SHARE / 2 * np.abs(step).sum()


def _width(torque_Nm: np.ndarray, angle_arcsec: np.ndarray) -> float:
    """Of one load, its last row joined to its first: a row more on one way opens no loop."""
    step, angle = np.diff(torque_Nm, append=torque_Nm[0]), angle_arcsec - angle_arcsec.mean()
    return -float((np.roll(angle, -1) + angle) @ step) / float(np.abs(step).sum())
