"""A measurement and a design in, a diagnosis out.

Each kind of measurement goes the same way, in a folder of its own; its `diagnose.py` lists the steps in
order. `whole_gear/` comes after a sweep that is held against the gear: which of the gear's inputs explains
the rest. Its steps are in `identification.py`.

| step | sweep/ | end_points/ | specimens/ | whole_gear/ |
|---|---|---|---|---|
| hypotheses | `evidence/regressors.py` | `regressors.py` | `parameters.py` | `inputs.py` |
| evidence of a set of them | `evidence/` | `evidence.py` | `evidence.py` | `fitted_input.py` |
| race of sets | `race/` | `race.py` | `race.py` | `pairs.py` |
| causes, rivals | `identification/` | `decide.py` | `decide.py` | `identification.py` |
| verdict | `verdict.py` | `decide.py` | `decide.py` | `identification.py` |
| next measurement | `next_measurement.py` | the same | the same | `identification.py` |

The rules of the verdict for the first three are in `decision.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.calibration import Calibration
from flexspline.pipeline.diagnosis.end_points.diagnose import diagnose_end_points
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import EndPoints, Measurement, Sweep
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import (
    DiagnosisOutcome,
    NamedCause,
    Verdict,
)
from flexspline.pipeline.diagnosis.plausibility import refuse_absurd
from flexspline.pipeline.diagnosis.prediction import Prediction, prediction_of
from flexspline.pipeline.diagnosis.scale_error import with_scale_error
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.pipeline.diagnosis.sweep.analysis import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.timeless import in_rows
from flexspline.pipeline.stiffness_pair import StiffnessPair

if TYPE_CHECKING:
    from flexspline.pipeline.diagnosis.whole_gear.identification import GearIdentification
    from flexspline.pipeline.gear.gear_chain import Chain
    from flexspline.pipeline.parts import AnalysisContext

MeasurementKind = Literal["sweep", "end_points", "specimens"]


@dataclass(frozen=True)
class Diagnosis:
    """What was found, with all that a report needs.

    Attributes
    ----------
    outcome : the verdict, causes, gain. model : the extended model, None where nothing was fitted.
    sweep, end_points, specimens : what stands behind the verdict, of the kind that was measured; None
        where there are too few data.
    gear_inputs : which input of the gear explains what its curve leaves; None of a sweep against the sum.
    given : the stiffnesses that a person stated, such as `--Kb 31.3`; kept of sweeps.
    """

    design: Design
    measurement: Measurement = field(repr=False)
    prediction: Prediction
    outcome: DiagnosisOutcome
    model: ExtendedModel | None = None
    sweep: SweepAnalysis | None = field(default=None, repr=False)
    end_points: EndPointAnalysis | None = field(default=None, repr=False)
    specimens: SpecimenAnalysis | None = field(default=None, repr=False)
    gear_inputs: GearIdentification | None = None
    given: tuple[str, ...] = ()

    @property
    def kind(self) -> MeasurementKind:
        """What was measured."""
        if isinstance(self.measurement, Sweep):
            return "sweep"
        return "end_points" if isinstance(self.measurement, EndPoints) else "specimens"

    @cached_property
    def calibration(self) -> Calibration | None:
        """Gap and compliance as the record has them; None of specimens, and of too few data."""
        if self.sweep is not None:
            return self.sweep.calibration
        return self.end_points.calibration if self.end_points is not None else None

    @cached_property
    def calibrations(self) -> Mapping[str, Calibration]:
        """The same of each unit, where a sweep has several."""
        if self.sweep is None or not isinstance(self.measurement, Sweep):
            return {}
        explained = self.sweep.explained
        names = explained.prepared.sweep.units
        if len(names) < 2:
            return {}
        misread = self.sweep.misread
        return {n: calibration_of(explained, u, misread) for u, n in enumerate(names)}

    @property
    def verdict(self) -> Verdict:
        """What the diagnosis says, in one word."""
        return self.outcome.verdict

    @property
    def causes(self) -> tuple[NamedCause, ...]:
        """What the simulation leaves out, the largest first."""
        return self.outcome.causes


def diagnose_measurement(
    design: Design,
    measurement: Measurement,
    pair: StiffnessPair,
    context: AnalysisContext | None = None,
    chain: Chain | None = None,
    given: tuple[str, ...] = (),
) -> Diagnosis:
    """Diagnose a measurement.

    `context`, where the pair of stiffnesses came from FE: specimens are then solved like the design; without
    it, given stiffnesses are scaled from specimen to specimen by the hole-free model. A torque sweep is
    compared with the curve of the whole gear's `chain`, where there is one, in place of the straight line.
    `given`: the stiffnesses that a person stated, such as `--Kb 31.3`.

    Raises
    ------
    MeasurementError : its size cannot be the design's, or it is no sweep, which `chain` needs.
    EquilibriumError : the gear has no equilibrium at the sweep's largest torque.
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    K_b, K_e = pair.K_b_Nm_per_rad, pair.K_e_Nm_per_rad
    prediction = prediction_of(design, K_b, K_e, pair.error)
    if chain is not None:
        prediction = _along_gear_curve(prediction, chain, measurement)
    refuse_absurd(measurement, prediction, K_b, K_e, given)
    if isinstance(measurement, Sweep):
        outcome, behind = diagnose_sweep(measurement, prediction)
        if measurement.history.time_s is None:
            outcome = in_rows(outcome)
        if behind:
            outcome = with_scale_error(outcome, measurement, prediction, behind.calibration)
        model = behind.model if behind else None
        inputs = None
        if chain and behind:
            from flexspline.pipeline.diagnosis.whole_gear.identification import gear_inputs

            inputs = gear_inputs(design, chain, behind)
        return Diagnosis(
            design, measurement, prediction, outcome, model, sweep=behind, gear_inputs=inputs,
            given=given,
        )  # fmt: skip
    if isinstance(measurement, EndPoints):
        outcome, analysis, model = diagnose_end_points(design, measurement, prediction)
        return Diagnosis(design, measurement, prediction, outcome, model, end_points=analysis)
    from flexspline.pipeline.analysis import analysis_context
    from flexspline.pipeline.diagnosis.specimens.diagnose import diagnose_specimens

    bench = context or analysis_context(design)
    outcome, specimen_analysis = diagnose_specimens(
        design, measurement, K_b, K_e, bench, full=context is not None
    )
    return Diagnosis(design, measurement, prediction, outcome, specimens=specimen_analysis)


def _along_gear_curve(straight: Prediction, chain: Chain, measurement: Measurement) -> Prediction:
    """The whole gear's curve in place of the straight line; errors as `diagnose_measurement`."""
    if not isinstance(measurement, Sweep):
        raise MeasurementError(
            measurement.path,
            None,
            "is not a torque sweep; only a sweep can be compared with the gear",
        )
    largest = measurement.history.largest_Nm
    if largest == 0:
        return straight
    from flexspline.pipeline.diagnosis.whole_gear.against import against_gear
    from flexspline.pipeline.diagnosis.whole_gear.scaled_bend import with_scaled_bend

    return with_scaled_bend(against_gear(straight, chain, largest), measurement)
