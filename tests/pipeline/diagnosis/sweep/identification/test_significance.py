"""What is named has a size: beyond two of the deviations that its fit and the others' shapes leave it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, sweep

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.outcome import SIZE_KNOWN
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.pipeline.diagnosis.sweep.identification.significance import SizeDoubt

FRICTION, SPRING, WAVE = "friction_hysteresis", "series_compliance", "kinematic_error"
HISTORY = sweep(cycles=6, rows=200, hold=0)
NOISE = 0.3


def fitted(added: np.ndarray, *causes: str) -> SweepFit:
    """One shape of each cause, fitted to what a gear adds to the simulation."""
    columns = design_matrix(FitContext(PREDICTION, HISTORY), {c: known_causes()[c] for c in causes})
    kept = np.abs(HISTORY.torque_Nm) > 0.07 * LARGEST
    evidence = gaussian_evidence(columns, added, kept, Noise(NOISE**2, 0.0, 0.5))
    first = [next(i for i, t in enumerate(evidence.terms) if t.owner == c) for c in causes]
    return fit_regressors(evidence, first)


def friction(width_arcsec: float) -> np.ndarray:
    """A loop of the first shape that friction tries."""
    columns = design_matrix(FitContext(PREDICTION, HISTORY), {FRICTION: known_causes()[FRICTION]})
    one = columns.all[:, columns.terms[0].at].sum(axis=1)
    return width_arcsec / 2 * one


@pytest.mark.parametrize("share", [0.0, 0.05, 0.1, 0.2, 0.4])
def test_a_spring_beside_friction_is_one_where_it_exceeds_what_friction_leaves_unsure(
    share: float,
) -> None:
    """Whether friction takes torque at the ends of its loop is a spring more or less: 10 of 20 arcsec."""
    added = friction(10.0) + share * PREDICTION.compliance * HISTORY.torque_Nm
    doubt = SizeDoubt.of(fitted(added, FRICTION, SPRING))
    assert doubt.is_significant(SPRING) == (100 * share > SIZE_KNOWN * doubt.std[SPRING])
    assert doubt.is_significant(FRICTION)


def test_the_doubt_is_the_other_cause_s() -> None:
    """A spring of 5 %: alone it is many deviations of its fit, beside large friction it is none."""
    spring = 0.05 * PREDICTION.compliance * HISTORY.torque_Nm
    assert SizeDoubt.of(fitted(spring, SPRING)).is_significant(SPRING)
    assert not SizeDoubt.of(fitted(friction(10.0) + spring, FRICTION, SPRING)).is_significant(
        SPRING
    )


def test_hardening_of_one_is_none() -> None:
    nothing = np.zeros(len(HISTORY))
    doubt = SizeDoubt.of(fitted(nothing, "stiffness_hardening"))
    assert doubt.magnitude["stiffness_hardening"] == pytest.approx(1.0, abs=1e-6)
    assert not doubt.is_significant("stiffness_hardening")


def test_an_amplitude_of_waves_is_no_question_of_its_deviation() -> None:
    """At few positions a sum of harmonics is known and none of them; that there is one, its evidence says."""
    few = replace(HISTORY, input_angle_deg=90.0 * (HISTORY.cycle % 2))
    columns = design_matrix(FitContext(PREDICTION, few), {WAVE: known_causes()[WAVE]})
    two = next(i for i, t in enumerate(columns.terms) if len(t.shape) == 2)
    assert few.input_angle_deg is not None
    added = 20.0 * np.sin(np.radians(few.input_angle_deg))
    kept = np.abs(few.torque_Nm) > 0.07 * LARGEST
    evidence = gaussian_evidence(columns, added, kept, Noise(NOISE**2, 0.0, 0.5))
    doubt = SizeDoubt.of(fit_regressors(evidence, [two]))
    assert doubt.magnitude[WAVE] < SIZE_KNOWN * doubt.std[WAVE]
    assert doubt.is_significant(WAVE)
