"""What stands behind the verdict on a torque sweep."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.model.doubt import PredictionUncertainty
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import ChannelTest
from flexspline.pipeline.diagnosis.sweep.separate_units import UnitsApart


@dataclass(frozen=True)
class SweepAnalysis:
    """What stands behind the verdict on a sweep, with all that a figure or a report needs.

    `model` is the calibrated simulation with the `causes` found, `doubt` what its predictions may be off by;
    `tests` are of what it leaves. All of it is of one unit, `apart.unit`, where units are judged `apart`.
    `misread` says that a reading comes late, or that drag looks like one.
    """

    explained: ExplainedSweep
    model: ExtendedModel
    doubt: PredictionUncertainty
    tests: tuple[ChannelTest, ...]
    causes: tuple[NamedCause, ...]
    apart: UnitsApart | None = None
    misread: bool = False

    @cached_property
    def calibration(self) -> Calibration:
        """Gap and compliance as the record has them, of what its units have in common."""
        return calibration_of(self.explained, misread=self.misread)
