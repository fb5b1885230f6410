"""Further measurements, compared by how far apart they drive the predictions of rival models."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_ARCSEC
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import Doing

FREE_ANGLE_RATIO = 1e4
"""Standard deviation over the largest predicted angle: so wide that the data alone determine the
calibration."""


@dataclass(frozen=True)
class MeasurementPlan:
    """Something a rig can do: which channel it varies, what to do, and the record it would give."""

    vary: str
    doing: Doing
    history: History


@dataclass(frozen=True)
class PlanSeparation:
    """A plan and how far the two rivals that are nearest to each other are apart, in units of noise."""

    vary: str
    doing: Doing
    separation: float


def separations(
    plans: Sequence[MeasurementPlan],
    models: Sequence[ExtendedModel],
    noise_arcsec: float,
    calibration: tuple[float, float] | None = None,
) -> list[PlanSeparation]:
    """Of every plan, the widest first.

    A difference counts only beyond what a zero, a compliance and a gap would absorb; `calibration`
    are the standard deviations of these two [arcsec per N·m, arcsec], None where both are free.
    """
    separated = []
    for plan in plans:
        angles = [m.angle_of(plan.history) for m in models]
        columns = _calibration_columns(plan.history, float(np.abs(angles).max()), calibration)
        apart = [_separation(a - b, columns, noise_arcsec) for a, b in combinations(angles, 2)]
        separated.append(PlanSeparation(plan.vary, plan.doing, min(apart, default=0.0)))
    return sorted(separated, key=lambda s: -s.separation)


def most_telling(
    plans: Sequence[MeasurementPlan], models: Sequence[ExtendedModel], noise_arcsec: float
) -> PlanSeparation:
    """The plan that separates the models most for as many readings; of the longer its own separation.

    Seven positions are not worth more than two for their number alone.
    """
    rows = {plan.doing: len(plan.history) for plan in plans}
    separated = separations(plans, models, noise_arcsec)
    return max(separated, key=lambda s: s.separation / rows[s.doing] ** 0.5)


def _calibration_columns(
    history: History, largest_arcsec: float, calibration: tuple[float, float] | None
) -> np.ndarray:
    """(n, 3) zero, compliance and gap, each times its standard deviation [arcsec]."""
    torque, side = history.torque_Nm, history.sign / 2
    free = FREE_ANGLE_RATIO * max(largest_arcsec, ROUNDING_ARCSEC)
    compliance, gap = calibration or (free / np.abs(torque).max(), free)
    zero = free if calibration is None else 10 * largest_arcsec
    return np.column_stack([np.full(len(torque), zero), compliance * torque, gap * side])


def _separation(off_arcsec: np.ndarray, columns: np.ndarray, noise_arcsec: float) -> float:
    """Length of a difference (n,) in units of noise, less what the columns absorb."""
    off = off_arcsec / noise_arcsec
    seen = columns.T @ off / noise_arcsec
    inner = np.eye(columns.shape[1]) + columns.T @ columns / noise_arcsec**2
    left = float(off @ off - seen @ np.linalg.solve(inner, seen))
    return max(left, 0.0) ** 0.5
