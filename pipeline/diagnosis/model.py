"""The extended model: the calibrated simulation and the causes found, as one forward model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.effects import causes
from flexspline.pipeline.diagnosis.effects.cause import Element
from flexspline.pipeline.diagnosis.record import History


@dataclass(frozen=True)
class ExtendedModel:
    """θ = θ0 + T·compliance + sign(T)·gap/2 + what each cause adds; T is the torque that the gear felt.

    Attributes
    ----------
    compliance : [arcsec per N·m]; gap_arcsec : as calibrated within the design's uncertainty.
    zeros_arcsec : zero of each unit, by its name.
    own : of each unit, by its name, deviation of compliance and gap from the common ones.
    elements : of each cause, by its id.
    """

    compliance: float
    gap_arcsec: float
    zeros_arcsec: Mapping[str, float]
    elements: Mapping[str, tuple[Element, ...]]
    own: Mapping[str, tuple[float, float]]

    def angle_arcsec(self, history: History, units: tuple[str, ...] = ("",)) -> np.ndarray:
        """(n,) angle; `units` names the history's units. A unit not fitted has zero 0.

        Raises
        ------
        ValueError : the history lacks a channel that a cause needs.
        """
        felt = self.felt(history)
        angle = felt.torque_Nm * self.compliance + felt.sign * self.gap_arcsec / 2
        for cause_id, elements in self.elements.items():
            angle += causes()[cause_id].angle_arcsec(elements, felt)
        for code, name in enumerate(units):
            rows = felt.unit == code
            compliance, gap = self.own.get(name, (0.0, 0.0))
            angle[rows] += self.zeros_arcsec.get(name, 0.0)
            angle[rows] += compliance * felt.torque_Nm[rows] + gap * felt.sign[rows] / 2
        return angle

    def felt(self, history: History) -> History:
        """The history that the gear felt."""
        for cause_id, elements in self.elements.items():
            history = causes()[cause_id].felt(elements, history)
        return history
