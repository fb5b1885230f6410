"""The measurement that would tell apart what end points cannot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.prediction import Prediction

AMPLITUDES = (0.25, 0.5, 1.0, 2.0, 4.0)
ROWS = 64
"""Of one loop."""
READING_ARCSEC = 1.0
"""No reading is taken to be better than this when plans are compared."""


@dataclass(frozen=True)
class Plan:
    """Something a rig can do: what it varies, in words, and the torques it visits in order."""

    vary: str
    doing: str
    history: History


@dataclass(frozen=True)
class PlanSeparation:
    """A plan and how far the two rivals that are nearest to each other are apart, in units of noise."""

    vary: str
    doing: str
    separation: float


def plans(torque_Nm: float) -> list[Plan]:
    """What can be done with the same rig."""
    ends = [s * a * torque_Nm for a in AMPLITUDES for s in (1, -1)]
    quarter = np.arange(1, ROWS // 4 + 1) / (ROWS // 4)
    loop = np.concatenate([quarter, 1 - quarter, -quarter, quarter - 1])
    one = np.concatenate([loop, loop])
    listed = ", ".join(f"{a * torque_Nm:g}" for a in AMPLITUDES)
    return [
        Plan("repeat", f"the same end points {ROWS // 2} times over",
             _history(np.tile([torque_Nm, -torque_Nm], ROWS // 2))),
        Plan("torque_Nm", f"end points at ± {listed} N·m", _history(np.array(ends))),
        Plan("sweep", f"a closed torque sweep 0 → +T → 0 → −T → 0, twice, at T = {torque_Nm:g} N·m",
             _history(torque_Nm * one)),
        Plan("torque_amplitude",
             f"closed torque sweeps 0 → +T → 0 → −T → 0, loading and unloading recorded, at T = {listed} N·m",
             _history(np.concatenate([a * torque_Nm * loop for a in AMPLITUDES]))),
    ]  # fmt: skip


def _history(torque: np.ndarray) -> History:
    none = np.zeros(len(torque), int)
    return History(torque, none, none)


def separations(
    torque_Nm: float, models: Sequence[ExtendedModel], prediction: Prediction, noise_arcsec: float
) -> list[PlanSeparation]:
    """Of every plan, the widest first.

    A difference counts only beyond what a zero and a calibration of K and gap within the design's
    uncertainty would absorb.
    """
    noise = max(noise_arcsec, READING_ARCSEC)
    found = []
    for plan in plans(torque_Nm):
        h = plan.history
        angles = [m.angle_of(h) for m in models]
        free = np.column_stack([
            np.full(len(h), 10 * np.abs(angles).max()),
            h.torque_Nm * prediction.compliance_std,
            h.sign * prediction.gap_std_arcsec / 2,
        ])  # fmt: skip
        inner = np.eye(3) + free.T @ free / noise**2
        apart = []
        for i, a in enumerate(angles):
            for b in angles[i + 1 :]:
                off = (a - b) / noise
                seen = free.T @ off / noise
                apart.append(
                    float(np.sqrt(max(off @ off - seen @ np.linalg.solve(inner, seen), 0.0)))
                )
        found.append(PlanSeparation(plan.vary, plan.doing, min(apart, default=0.0)))
    return sorted(found, key=lambda s: -s.separation)
