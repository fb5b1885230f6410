"""Isolated outliers: rows far from their neighbours, taken as wrong readings."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.runs import runs
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter

OUTLIER_SIGMAS = 5.0
"""One row of normal noise in 1.7 million lies further off."""
SAME_PLACE = 0.01
"""Share of the largest torque within which outliers of different cycles are at the same place. Judgement."""
LONGEST_OUTLIER = 2
"""Most rows of an outlier. Three rows in succession are a finding."""


def isolated_outliers(residual: np.ndarray, history: History, sigma: float) -> np.ndarray:
    """(n,) rows that stand alone beyond 5σ; three in a row, or one place in several passes, stay."""
    far = np.abs(residual) > OUTLIER_SIGMAS * sigma
    if not far.any():
        return far
    out = far.copy()
    for a, b in runs(far):
        if b - a > LONGEST_OUTLIER:
            out[a:b] = False
    rows = np.flatnonzero(out)
    near = SAME_PLACE * history.largest_Nm
    others: dict[int, np.ndarray] = {}
    for i in rows.tolist():
        same = (
            (np.abs(history.torque_Nm[rows] - history.torque_Nm[i]) < near)
            & (history.cycle[rows] != history.cycle[i])
            & (np.sign(residual[rows]) == np.sign(residual[i]))
        )
        if same.sum() >= 2:
            others[i] = rows[same]
    if others:
        rising = np.gradient(less_jitter(history).torque_Nm) > 0
        for i, same_place in others.items():
            if (rising[same_place] == rising[i]).sum() >= 2:
                out[i] = False
    return out
