"""The record that the simulation predicts, and its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot
from typing import TypeVar

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, backlash, gap_rad, series_compliance
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.measurement.history import History

REFERENCE_C = 20.0
"""Reference temperature [°C], ISO 1:2022; the gap of a design is the one there."""

Torque = TypeVar("Torque", float, np.ndarray)


@dataclass(frozen=True)
class Prediction:
    """θ = θ0 + T·compliance + sign(T)·gap/2, with one standard deviation of each from the design.

    Attributes
    ----------
    compliance, compliance_std : [arcsec per N·m], 1/K_e + 1/K_b.
    gap_arcsec, gap_std_arcsec : the whole angular gap at 20 °C.
    bend : how the curve leaves the line, where the whole gear is computed; None: it is straight.
    measured_bend : how a record's curve leaves its own line, where it is the simulated bend scaled as its
        slope is, or less (`whole_gear/scaled_bend.py`); None: as simulated.
    lost_bend : what is then missing of a bend scaled as the slope is, or of the simulated one, whichever is
        nearer; None: nothing.
    rated_Nm : rated torque, where the design states it.
    """

    compliance: float
    compliance_std: float
    gap_arcsec: float
    gap_std_arcsec: float
    bend: Bend | None = None
    measured_bend: Bend | None = None
    lost_bend: Bend | None = None
    rated_Nm: float | None = None

    def angle_arcsec(self, history: History) -> np.ndarray:
        """(n,) predicted angle, with zero θ0."""
        angle = history.torque_Nm * self.compliance + history.sign * self.gap_arcsec / 2
        return angle if self.bend is None else angle + self.bend.at(history.torque_Nm)

    @property
    def for_race(self) -> Prediction:
        """Start of a race: the line as simulated, the bend as measured."""
        if self.measured_bend is None:
            return self
        return replace(self, bend=self.measured_bend, measured_bend=None, lost_bend=None)

    def twist_arcsec(self, low_Nm: Torque, high_Nm: Torque) -> Torque:
        """From one torque to a higher one along the line, with the gap where they differ in sign.

        From −T to +T it is the total 2T·compliance + gap.
        """
        crossed = (low_Nm < 0) & (high_Nm > 0)
        return (high_Nm - low_Nm) * self.compliance + crossed * self.gap_arcsec

    def scale_arcsec(self, torque_Nm: float) -> float:
        """Size of the predicted angle at a torque: the unit for effects of unknown size."""
        return self.compliance * torque_Nm + self.gap_arcsec / 2


def prediction_of(
    design: Design, K_b_Nm_per_rad: float, K_e_Nm_per_rad: float, K_error: float = 0.0
) -> Prediction:
    """The design's prediction; `K_error` is the solver's relative error of the series stiffness.

    Raises
    ------
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    total = backlash(design, K_b_Nm_per_rad, K_e_Nm_per_rad)
    compliance = series_compliance(K_b_Nm_per_rad, K_e_Nm_per_rad) * ARCSEC_PER_RAD
    doubt = total.std_by_source_arcsec
    return Prediction(
        compliance,
        compliance * hypot(design.uncertainty.youngs_modulus_pct / 100, K_error),
        gap_rad(design) * ARCSEC_PER_RAD,
        hypot(doubt.get("flank_clearance", 0.0), doubt.get("radial_clearance", 0.0)),
        rated_Nm=design.gear.rated_torque_Nm,
    )
