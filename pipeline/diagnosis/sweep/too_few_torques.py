"""Whether a sweep has torques enough for a zero, a stiffness, a gap and one thing more."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.record import FEWEST_SWEEP_ROWS, Sweep
from flexspline.pipeline.diagnosis.shortage import ConstantTorque, FewTorques

CONSTANT_SHARE = 0.1
"""Torque that varies by less than this share of its largest value is constant. Judgement."""
FEWEST_CREEP_HOLDS = 3
"""Fewest holds: up, back, and once more. Growth in a single hold may be drift."""


def too_few_torques(sweep: Sweep) -> ConstantTorque | FewTorques | None:
    """What the torque lacks; None where it is enough, as of a few torques that are held."""
    torque = sweep.history.torque_Nm
    largest = float(np.abs(torque).max())
    if largest == 0 or np.ptp(torque) < CONSTANT_SHARE * largest:
        return ConstantTorque()
    different = len(np.unique(np.round(torque / largest, 2)))
    if different < FEWEST_SWEEP_ROWS and not _is_creep_test(sweep):
        return FewTorques(FEWEST_SWEEP_ROWS)
    return None


def _is_creep_test(sweep: Sweep) -> bool:
    """Whether torque is stepped and held: few torques then show what goes on while they are held."""
    return len(holds(sweep.history)) >= FEWEST_CREEP_HOLDS
