"""The middle of a sweep's loop: angle over torque without friction, without zero, without other causes.

Friction that builds up over a part of the loop leaves its slope in the middle too: no loop tells it from a
softer gear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.analysis import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import true_history

OF_THE_CURVE = (CLEARANCE, SERIES, HARDENING)
"""Causes that bend or turn the curve itself."""
OF_THE_LOOP = (FRICTION, RATE)
"""Causes that change sign with the direction: the mean over both directions is without them."""
BINS = 12
"""Of torque, from the gap's crossing to the largest: as many places as bends of a gear's curve need."""
FEWEST_CYCLES = 3
"""Fewest cycles whose scatter shows how well a mean is known."""


LEAST_SHARE = 1e-3
"""Share of the largest torque below which the gear's own curve moves by less than any reading resolves."""


@dataclass(frozen=True)
class CentralCurve:
    """Half of what lies between +T and −T, at m places of torque.

    Attributes
    ----------
    torques_Nm : of each place, the sizes of the torques on the output [N·m] that were read there.
    angle_arcsec, std_arcsec : (m,) mean, and its standard deviation.
    """

    torques_Nm: tuple[np.ndarray, ...]
    angle_arcsec: np.ndarray
    std_arcsec: np.ndarray

    @property
    def largest_Nm(self) -> float:
        return float(max(sizes.max() for sizes in self.torques_Nm))

    @property
    def smallest_Nm(self) -> float:
        """Not below LEAST_SHARE of the largest, where friction ahead of the teeth leaves them torque at 0."""
        smallest = float(min(sizes.min() for sizes in self.torques_Nm))
        return max(smallest, LEAST_SHARE * self.largest_Nm)


def central_curve(
    analysis: SweepAnalysis, cycles: Sequence[int] | None = None
) -> CentralCurve | None:
    """Of one unit's sweep, or of some of its cycles; None where they do not hold both signs of torque.

    In each cycle both directions weigh alike, so friction cancels whether or not it was named.
    """
    prepared = analysis.explained.prepared
    history = _true(analysis)
    reading = _reading(analysis)
    size = np.abs(history.torque_Nm)
    edges = np.linspace(prepared.band_Nm, float(size.max()), BINS + 1)
    number = np.clip(np.digitize(size, edges) - 1, 0, BINS - 1)
    rising = direction_of_loading(history) > 0
    points = []
    wanted = np.unique(history.cycle) if cycles is None else cycles
    for cycle in wanted:
        rows = prepared.kept & (history.cycle == cycle)
        halves = [
            np.array([_both_ways(reading, rising, rows & (history.torque_Nm * sign > 0) & (number == b))
                      for b in range(BINS)])
            for sign in (1, -1)
        ]  # fmt: skip
        points.append((halves[0] - halves[1]) / 2)
    each = np.array(points)
    seen = np.isfinite(each).sum(axis=0)
    there = seen > 0
    if there.sum() < 3:
        return None
    each, count = each[:, there], seen[there]
    mean = np.nanmean(each, axis=0)
    rows_per_cell = max(1.0, prepared.kept.sum() / (4 * BINS * len(wanted)))
    # of four cells, two signs and two directions, halved
    std = np.full(len(mean), prepared.noise.std_arcsec / np.sqrt(rows_per_cell)) / 2
    if len(wanted) >= FEWEST_CYCLES:
        scatter = np.sqrt(np.nanmean((each - mean) ** 2, axis=0).mean())
        std = np.maximum(std, scatter)
    read = prepared.kept & np.isin(history.cycle, wanted)
    torques = tuple(size[read & (number == b)] for b in np.flatnonzero(there))
    return CentralCurve(torques, mean, std / np.sqrt(count))


def _reading(analysis: SweepAnalysis) -> np.ndarray:
    """(n,) the angle without what causes add that belong neither to the curve nor to the loop."""
    sweep, model = analysis.explained.prepared.sweep, analysis.model
    own = {k: v for k, v in model.elements.items() if k in (*OF_THE_CURVE, *OF_THE_LOOP)}
    curve = replace(model, elements=own).angle_of(_true(analysis), sweep.units)
    return sweep.angle_arcsec - (model.angle_of(sweep.history, sweep.units) - curve)


def _true(analysis: SweepAnalysis) -> History:
    """The torque on the output, a shifted reading put right."""
    prepared = analysis.explained.prepared
    return true_history(prepared.sweep, prepared.offset_Nm)


def _both_ways(reading: np.ndarray, rising: np.ndarray, rows: np.ndarray) -> float:
    """Mean over both directions, each with the same weight; nan where one is missing."""
    return (_mean(reading, rows & rising) + _mean(reading, rows & ~rising)) / 2


def _mean(values: np.ndarray, rows: np.ndarray) -> float:
    return float(values[rows].mean()) if rows.any() else float("nan")
