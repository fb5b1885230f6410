"""The noise of a record before any model is fitted: the residual of local parabolas."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import LEAST_ANGLE_ARCSEC
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import stretches_of
from flexspline.pipeline.diagnosis.robust import robust_std

PARTS = 12
"""Parts of a cycle. In one part, a branch differs from a parabola by a thousandth of its twist."""
FEWEST_WINDOW_ROWS, MOST_WINDOW_ROWS = 7, 400
"""Rows of a window. A parabola then absorbs less than half of the noise, and more rows add no information."""
ANGLE_SPIKE_STEPS = 5
"""Times the step from row to row that 99 of 100 stay below: a reading so far outside of the rows around it
is wrong. One bends the parabola away from all rows of its window; smaller ones lose their weight in time."""


def rough_residual(
    angle: np.ndarray, history: History, kept: np.ndarray, rows_per_cycle: float
) -> np.ndarray:
    """(kept,) what a local parabola leaves over windows of a twelfth of a cycle: noise and little else."""
    out = np.empty(int(kept.sum()))
    width = int(np.clip(rows_per_cycle / PARTS, FEWEST_WINDOW_ROWS, MOST_WINDOW_ROWS))
    y = angle[kept]
    step = float(np.quantile(np.abs(np.diff(y)), 0.99)) if len(y) > 1 else 0.0
    for s in stretches_of(history, kept):
        piece, level = y[s], _without_spikes(y[s], step)
        for a in range(0, len(piece), width):
            b = min(len(piece), a + width)
            if b - a < FEWEST_WINDOW_ROWS and b == len(piece) and a > 0:
                a = max(0, b - width)
            x = np.linspace(-1, 1, b - a)
            degree = min(2, max(0, b - a - 4))
            out[s.start + a : s.start + b] = piece[a:b] - _robust_polynomial(x, level[a:b], degree)
    return out


def _without_spikes(y: np.ndarray, step: float) -> np.ndarray:
    """The readings (n,), one or two in a row that are far outside of the two rows on either side replaced."""
    if len(y) < FEWEST_WINDOW_ROWS:
        return y
    padded = np.pad(y, 2, mode="reflect")
    around = np.sort([padded[k : k + len(y)] for k in (0, 1, 3, 4)], axis=0)
    outside = np.maximum(around[1] - y, y - around[2])
    return np.where(outside > ANGLE_SPIKE_STEPS * step, around[1:3].mean(axis=0), y)


def _robust_polynomial(x: np.ndarray, y: np.ndarray, degree: int) -> np.ndarray:
    weight = np.ones(len(x))
    basis = np.vander(x, degree + 1)
    fitted = y
    for _ in range(3):
        coefficients = np.linalg.lstsq(basis * weight[:, None], y * weight, rcond=None)[0]
        fitted = basis @ coefficients
        off = np.abs(y - fitted)
        scale = robust_std(off) + LEAST_ANGLE_ARCSEC
        before, weight = weight, 1 / np.maximum(1, off / (3 * scale))
        if np.array_equal(weight, before):
            break
    return fitted
