"""Gap and compliance of the simulation as fitted to a record, the design's uncertainty as their prior."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.prediction import Prediction

FAR_DEVIATIONS = 3.0
"""Stated standard deviations. Of a right simulation, one calibration in 370 lies further off."""


@dataclass(frozen=True)
class Estimate:
    """A value and its standard deviation, in one unit."""

    value: float
    std: float


@dataclass(frozen=True)
class Calibration:
    """Calibration of the extended model beside its causes, common to all units.

    Attributes
    ----------
    gap_arcsec : the whole gap at 20 °C.
    beside_effects : whether effects found were fitted beside it, and are not in it.
    compliance : [arcsec per N·m]; None where the record leaves it as simulated.
    """

    gap_arcsec: Estimate
    beside_effects: bool
    compliance: Estimate | None = None

    def far_off(self, prediction: Prediction, beyond: float = FAR_DEVIATIONS) -> tuple[FarOff, ...]:
        """The calibrated quantities more than so many of their stated deviations from the simulation.

        And more than as many of their own: a value that the record leaves open is not off.
        """
        measured = [("gap", self.gap_arcsec, prediction.gap_arcsec, prediction.gap_std_arcsec)]
        if self.compliance is not None:
            stated = prediction.compliance, prediction.compliance_std
            measured.append(("compliance", self.compliance, *stated))
        return tuple(
            FarOff(name, estimate, abs(estimate.value - simulated) / std)
            for name, estimate, simulated, std in measured
            if abs(estimate.value - simulated) > beyond * max(std, estimate.std) and std > 0
        )


@dataclass(frozen=True)
class FarOff:
    """A calibrated quantity, `gap` [arcsec] or `compliance` [arcsec per N·m], far from its simulated value.

    Attributes
    ----------
    deviations : how far, in the standard deviations that the design states.
    """

    quantity: str
    measured: Estimate
    deviations: float
