"""Where terms without a name cancel each other, compliance and gap are stated without them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from read_sweep import as_read, history_of, simulated, steps

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import Regressor, design_matrix
from flexspline.pipeline.diagnosis.sweep.magnitudes.calibration_std import calibration_of
from flexspline.pipeline.diagnosis.sweep.magnitudes.cancelling_terms import terms_cancel
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, run_race

COMPLIANCE, GAP = 10.0, 60.0
PREDICTION = Prediction(compliance=10.0, compliance_std=0.3, gap_arcsec=60.0, gap_std_arcsec=10.0)
LARGEST_Nm, NOISE_ARCSEC = 8.0, 0.3


def softening(history: History, opens: float) -> np.ndarray:
    """A joint that opens at that share of the largest torque: 30 % softer from there."""
    share = history.torque_Nm / LARGEST_Nm
    return 0.3 * COMPLIANCE * LARGEST_Nm * np.sign(share) * np.maximum(np.abs(share) - opens, 0)


def explained(extra: Callable[[History], np.ndarray], local: bool = True) -> ExplainedSweep:
    """A straight line and the gap as simulated, and an effect that has no name.

    By a race without the terms that begin at one torque, or stay near it, if not `local`.
    """
    history = history_of(steps(LARGEST_Nm, 55), 5)
    noise = np.random.default_rng(4).normal(0, NOISE_ARCSEC, len(history))
    sweep = as_read(history, simulated(history) + extra(history) + noise)
    prepared = prepare(sweep, PREDICTION)
    if local:
        return run_race(prepared)
    columns = design_matrix(
        prepared.rig, dict(known_causes())
    )  # no bumps, steps or bends sought before

    def is_wide(term: Regressor) -> bool:
        if term.form is None or term.form.kind != "softening":
            return True
        return bool(np.mean(columns.all[:, term.at] == 0) < 0.1)

    return run_race(replace(prepared, columns=columns.only(is_wide)))


@pytest.mark.parametrize("opens", [0.6, 0.7])
def test_what_cancels_does_not_fix_compliance_and_gap(opens: float) -> None:
    found = explained(lambda h: softening(h, opens), local=False)
    assert terms_cancel(found.identified)
    calibration = calibration_of(found)
    assert calibration.compliance is not None
    # no part of the curve is stiffer than the straight line
    assert calibration.compliance.value > COMPLIANCE
    assert abs(calibration.compliance.value - COMPLIANCE) < 2 * calibration.compliance.std
    assert abs(calibration.gap_arcsec.value - GAP) < 2 * calibration.gap_arcsec.std
    assert calibration.far_off(PREDICTION) == ()


@pytest.mark.parametrize("opens", [0.47, 0.7])
def test_a_joint_that_opens_is_one_term(opens: float) -> None:
    """At a load between two that are tried, too."""
    found = explained(lambda h: softening(h, opens))
    evidence = found.identified.search.evidence
    terms = [evidence.terms[i].form for i in found.identified.best.terms]
    assert {form.kind for form in terms if form} == {"softening"}
    assert not terms_cancel(found.identified)
    calibration = calibration_of(found)
    assert calibration.compliance is not None
    assert abs(calibration.compliance.value - COMPLIANCE) < 0.1
    assert abs(calibration.gap_arcsec.value - GAP) < 0.5


@pytest.mark.parametrize("power", [1.25, 1.6, 2.25])
def test_a_law_between_those_tried_leaves_the_compliance_open(power: float) -> None:
    """A spring whose twist grows as a power of torque, beside the linear one."""
    largest = 0.3 * COMPLIANCE * LARGEST_Nm

    def soft(history: History) -> np.ndarray:
        share = history.torque_Nm / LARGEST_Nm
        return largest * np.sign(share) * np.abs(share) ** power

    calibration = calibration_of(explained(soft))
    assert calibration.compliance is not None
    assert abs(calibration.compliance.value - COMPLIANCE) < 2 * calibration.compliance.std
    assert abs(calibration.gap_arcsec.value - GAP) < 2 * calibration.gap_arcsec.std


def test_terms_that_are_right_do_not_cancel() -> None:
    """A clamp that loosens half way: the stiffness of each cycle is its own."""
    found = explained(lambda h: 0.12 * COMPLIANCE * h.torque_Nm * (h.cycle >= 3))
    assert found.identified.unnamed(())
    assert not terms_cancel(found.identified)
    calibration = calibration_of(found)
    assert calibration.compliance is not None
    # noise of 0.3 arcsec in some 1 000 rows, torque of 4.6 N·m rms: 0.003
    assert calibration.compliance.value == pytest.approx(COMPLIANCE, abs=0.05)
