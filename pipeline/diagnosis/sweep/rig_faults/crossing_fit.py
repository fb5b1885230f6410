"""How likely a record is with the gap's crossing in one form, by a robust fit."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.measurement.crossing_band import crossing_band_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.robust import robust_std
from flexspline.pipeline.diagnosis.sweep.crossing.crossing_likelihood import LEAST_WIDTH
from flexspline.pipeline.diagnosis.sweep.crossing.step_fit import (
    LEAST_STEP,
    MOST_FIRST_ROWS,
    ROBUST_DEVIATIONS,
    SINGULAR_SHARE,
    looped_functions,
    unlooped_functions,
    weighted_fit,
)
from flexspline.pipeline.diagnosis.sweep.race.torque_offset_race import SPIKE_NATS
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_forms import Tried
from flexspline.pipeline.diagnosis.sweep.row_selection import settling, turning

QUADRATURE = ((-3.0, 0.06), (-1.5, 0.24), (0.0, 0.4), (1.5, 0.24), (3.0, 0.06))
"""Standard deviations of the torque's noise, and weights: about a normal of 1.5 deviations, as a width of the
crossing is better taken too large than too small."""
WEIGHINGS = 3
"""Fits, each with weights by the last one's residual: a row pulls the less the farther off it is, as beyond a
spike it costs no more. Rows on the wrong side of the gap would else bend all that is fitted beside it."""


@dataclass(frozen=True)
class CrossingFit:
    """How likely a record is with one form, and the scatter that it leaves [arcsec]."""

    tried: Tried
    log_likelihood: float
    left_arcsec: float


def likeliest(fit: CrossingFit) -> float:
    """What the likeliest of some fits has most of."""
    return fit.log_likelihood


@dataclass(frozen=True)
class CrossedRecord:
    """A record, whose angle is smooth functions of torque with any loop, and the gap's step in one form.

    `added` : what else the angle may hold (n,), in any size. `most_rows` : looked at, evenly chosen. Without
    `loops` there is no loop but the form's own, by the torque that the twist follows.
    """

    history: History
    angle_arcsec: np.ndarray
    gap_arcsec: float
    noise_arcsec: float
    added: tuple[np.ndarray, ...] = ()
    most_rows: int = MOST_FIRST_ROWS
    loops: bool = True

    @cached_property
    def rows(self) -> np.ndarray:
        """Rows that count: friction's memory from before the record, and turns, say nothing of the gap.

        Nor do rests about zero torque: the output lies anywhere in the gap there.
        """
        count = ~settling(self.history) & ~turning(self.history)
        band = crossing_band_Nm(self.history)
        for hold in holds(self.history):
            count[hold] &= bool(np.abs(self.history.torque_Nm[hold]).mean() >= band)
        good = np.flatnonzero(count)
        return good[:: max(1, len(good) // self.most_rows)]

    @cached_property
    def smooth(self) -> np.ndarray:
        """What the angle of its rows may be but the step, in as few columns as say all that the functions do.

        Several are nearly one another, and normal equations of those would have to be solved by their
        eigenvalues, for each form anew.
        """
        functions = looped_functions if self.loops else unlooped_functions
        columns = np.column_stack([functions(self.history), *self.added])[self.rows]
        apart, sizes, _ = np.linalg.svd(columns, full_matrices=False)
        resolved = sizes > SINGULAR_SHARE**0.5 * sizes.max(initial=0.0)
        return np.asarray(apart[:, resolved] * np.sqrt(len(columns)))

    @cached_property
    def width_Nm(self) -> float:
        """Noise of the torque, by which a row may lie on the other side."""
        least = LEAST_WIDTH * self.history.largest_Nm
        return max(torque_noise_Nm(self.history), least)

    def best(self, tried: Iterable[Tried]) -> CrossingFit:
        """The likeliest of some forms."""
        return max((self.of(one) for one in tried), key=likeliest)

    def of(self, tried: Tried) -> CrossingFit:
        """The fit with one form; its step's height is free, but much less than the gap is none."""
        sides = [tried.form(noise * self.width_Nm)[self.rows] for noise, _ in QUADRATURE]
        share = np.array([weight for _, weight in QUADRATURE])
        side = share @ np.array(sides)
        unsure = share @ (np.array(sides) - side) ** 2
        deviation = np.sqrt(self.noise_arcsec**2 + (self.gap_arcsec / 2) ** 2 * unsure)
        columns = [side, self.smooth]
        if tried.followed_Nm is not None:
            columns.append((tried.followed_Nm - self.history.torque_Nm)[self.rows])
        basis, angle = np.column_stack(columns), self.angle_arcsec[self.rows]
        weight = 1 / deviation
        for _ in range(WEIGHINGS):
            coefficients = weighted_fit(basis, angle, weight)
            off = np.abs(angle - basis @ coefficients) / deviation
            before, weight = weight, 1 / deviation / np.maximum(1, off / ROBUST_DEVIATIONS)
            if np.array_equal(weight, before):
                break
        if coefficients[0] < LEAST_STEP * self.gap_arcsec:
            return CrossingFit(tried, -np.inf, np.inf)
        # a row that lies anywhere costs what a spike does
        huber = np.where(
            off < ROBUST_DEVIATIONS, off**2, 2 * ROBUST_DEVIATIONS * off - ROBUST_DEVIATIONS**2
        )
        cost = np.minimum(huber, 2 * SPIKE_NATS) / 2 + np.log(deviation)
        left = robust_std(off) * self.noise_arcsec
        return CrossingFit(tried, -float(cost.sum()), left)
