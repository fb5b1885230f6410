"""The curve of the whole gear (`pipeline.gear.gear_curve`) as what a sweep is compared with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.geometry.errors import DesignError
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.gear.gear_chain import Chain
from flexspline.pipeline.gear.gear_curve import LOADING

SMALLEST = LOADING[0]
"""Share of the largest torque at which the teeth have just met, so that twice the angle is the gap."""
PLACES = np.concatenate([np.linspace(SMALLEST, 0.1, 13), np.linspace(0.125, 1.0, 36)])
"""Torques of the curve, of the largest: teeth come into mesh mostly at small torque. Straight lines between
them are off by less than 0.1 % of the wind-up on the gears tried."""


def refuse_given(K_b: float | None, K_e: float | None) -> None:
    """Refuse stiffnesses [N·m/rad] beside the gear's curve.

    Raises
    ------
    DesignError
    """
    if K_b is not None or K_e is not None:
        raise DesignError(
            "against", "gear", "takes no K_b and no K_e: the curve comes from the drawing"
        )


def against_gear(straight: Prediction, chain: Chain, largest_Nm: float) -> Prediction:
    """The gear's curve up to a torque [N·m] in place of the straight line.

    Its chord, its free angle and its bend; the relative deviations stay those that the design states.

    Raises
    ------
    EquilibriumError
    """
    torque = largest_Nm * PLACES
    angle = chain.angles(torque.tolist()) * ARCSEC_PER_RAD
    slope = (angle[1] - angle[0]) / (torque[1] - torque[0])
    half_gap = float(angle[0] - slope * torque[0])
    compliance = float((angle[-1] - half_gap) / largest_Nm)
    bend = angle - half_gap - compliance * torque
    return replace(
        straight,
        compliance=compliance,
        compliance_std=compliance * straight.compliance_std / straight.compliance,
        gap_arcsec=2 * half_gap,
        bend=Bend((0.0, *torque.tolist()), (0.0, *bend.tolist())),
    )
