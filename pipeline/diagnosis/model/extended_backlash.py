"""The backlash sum with what an extended model adds between −T_L and +T_L."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import copysign

import numpy as np

from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.prediction import REFERENCE_C

RAMP_S = 600.0
"""[s] from 0 to T_L: slow, so that what lags torque counts for little."""
RAMP_ROWS = 200
"""Rows of a ramp from 0 to T_L [1], one in 3 s; friction of the example's model is the same with 50 and
with 1600."""


@dataclass(frozen=True)
class ExtendedBacklash:
    """The nominal sum and what the model adds; arcsec.

    Attributes
    ----------
    calibration_arcsec : from the nominal stiffness and gap to the measured ones; of a model fitted against
        the whole gear, from the sum to the gear's calibrated curve.
    causes_arcsec : what each cause adds between the two ends, by its id; may be negative.
    """

    nominal: Backlash
    calibration_arcsec: float
    causes_arcsec: Mapping[str, float]

    @property
    def total_arcsec(self) -> float:
        return (
            self.nominal.total_arcsec + self.calibration_arcsec + sum(self.causes_arcsec.values())
        )


def extended_backlash(
    nominal: Backlash, model: ExtendedModel, torque_Nm: float
) -> ExtendedBacklash:
    """Add a model's terms to the sum at T_L = `torque_Nm`.

    Each cause is evaluated on the history 0 → +T_L → −T_L → +T_L → −T_L → +T_L, ten minutes a ramp,
    at 20 °C, first cycle, wave generator at 0°. What it adds is the angle at +T_L, the mean of the
    last two visits, less the angle at −T_L between them: a steady drift of the reading cancels. A
    shifted torque reading adds nothing, as T_L is the true torque; what friction ahead of the teeth
    carries of it takes its share of the wind-up away. Units' own deviations enter by their mean.
    """
    history, low, high = _there_and_back(torque_Nm)
    teeth = model.at_teeth(history)
    added = {}
    for cause_id, elements in model.elements.items():
        cause = known_causes()[cause_id]
        carried = history.torque_Nm - cause.at_teeth(elements, history).torque_Nm
        angle = cause.angle_arcsec(elements, teeth) - model.compliance * carried
        added[cause_id] = float(angle[high].mean() - angle[low])
    own = np.array(list(model.own.values()) or [(0.0, 0.0)]).mean(axis=0)
    twist = 2 * torque_Nm * (model.compliance + own[0])
    if model.bend is not None:  # fitted against the gear's curve, which leaves its chord
        twist += 2 * float(model.bend.at(np.array([torque_Nm]))[0])
    gap = model.gap_arcsec + own[1]
    windup = nominal.shaft_arcsec + nominal.flexspline_arcsec
    free = nominal.gap_arcsec
    return ExtendedBacklash(nominal, float(twist - windup + gap - free), added)


def _there_and_back(torque_Nm: float) -> tuple[History, int, np.ndarray]:
    """The history, the row of the last −T_L, and the rows of +T_L on either side of it."""
    ends = [0.0, *(copysign(torque_Nm, s) for s in (1, -1, 1, -1, 1))]
    parts = [np.linspace(a, b, RAMP_ROWS * (1 if a == 0 else 2) + 1)[1:] for a, b in pairwise(ends)]
    torque = np.concatenate([[0.0], *parts])
    at = np.cumsum([len(p) for p in parts])
    n = len(torque)
    zero = np.zeros(n)
    time = np.arange(n) * RAMP_S / RAMP_ROWS
    history = History(
        torque,
        np.zeros(n, int),
        np.zeros(n, int),
        time,
        np.full(n, REFERENCE_C),
        zero,
        exact=True,
    )
    return history, int(at[3]), at[[2, 4]]
