"""Doubt of one cause's shape in another's size: what a fit of the wrong shape takes up."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, sweep

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep, prepare
from flexspline.pipeline.diagnosis.sweep.identification.leakage import (
    SHAPE_MISFIT,
    effect_size,
    leaked,
    lengths_beyond_calibration,
)

FRICTION, SPRING, GAP = "friction_hysteresis", "series_compliance", "clearance_offset"
TURNING = replace(sweep(cycles=3, rows=400, hold=0), temperature_C=None, input_angle_deg=None)


@pytest.fixture(scope="module")
def prepared() -> PreparedSweep:
    torque = TURNING.torque_Nm
    noise = np.random.default_rng(2).normal(0, 0.3, len(torque))
    angle = 14.0 * torque + 30.0 * np.sign(torque) + noise
    record = Sweep(
        Path("rig.csv"), TURNING, angle, ("",), (tuple(np.unique(TURNING.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    return prepare(record, PREDICTION)


def of_shapes(prepared: PreparedSweep, friction: int) -> GaussianEvidence:
    """Evidence with so many of friction's shapes, a missing spring and another gap."""
    columns = prepared.columns.of([FRICTION, SPRING, GAP])
    mine = [t for t in columns.terms if t.owner == FRICTION][:friction]
    kept = [*mine, *(t for name in (SPRING, GAP) for t in columns.terms if t.owner == name)]
    # a friction's own angle, of the first shape, 5 arcsec wide
    added = -2.5 * columns.all[:, mine[0].at].sum(axis=1)
    few = replace(
        columns,
        all=np.hstack([columns.all[:, t.at] for t in kept]),
        terms=tuple(replace(t, at=slice(i, i + 1)) for i, t in enumerate(kept)),
    )
    return gaussian_evidence(few, prepared.target - added, prepared.kept, prepared.noise)


def leak(fit: SweepFit) -> dict[str, float]:
    return leaked(fit, fit.magnitude_slopes())


def test_of_a_cause_alone_and_of_exact_ones_nothing_leaks(prepared: PreparedSweep) -> None:
    evidence = of_shapes(prepared, 2)
    assert leak(fit_regressors(evidence, [0])) == {FRICTION: 0.0}
    # neither a spring nor a gap has another shape
    assert leak(fit_regressors(evidence, [2, 3])) == {SPRING: 0.0, GAP: 0.0}


def test_it_is_what_the_fit_of_a_law_between_two_shapes_is_off_by(prepared: PreparedSweep) -> None:
    evidence = of_shapes(prepared, 2)
    fit = fit_regressors(evidence, [0, 2])
    size = effect_size(fit, FRICTION)
    length = float(lengths_beyond_calibration(evidence, [1])[0])
    other = evidence.x[:, 1] * size / length
    # what base and set leave of it, their priors as further rows
    model = np.hstack([evidence.base, evidence.x[:, [0, 2]]])
    priors = np.diag(np.r_[1 / evidence.columns.base_prior, 1.0, 1.0])
    rows = np.vstack([model, priors])
    taken = np.linalg.lstsq(rows, np.r_[other, np.zeros(len(priors))], rcond=None)[0]
    left = float(np.linalg.norm(other - model @ taken))
    share = min(1.0, SHAPE_MISFIT * known_causes()[FRICTION].shape_doubt * size / left)
    # the same share of the other shape in the record itself, fitted again
    column = evidence.columns.all[:, 1] * evidence.scale[1]
    moved = column * share * size / length
    again = gaussian_evidence(
        evidence.columns, evidence.target + moved, prepared.kept, prepared.noise
    )
    off = fit_regressors(again, [0, 2]).magnitudes()[SPRING] - fit.magnitudes()[SPRING]
    assert leak(fit)[SPRING] == pytest.approx(abs(off), rel=1e-4)
    assert abs(off) > 0


def test_friction_that_holds_torque_or_does_not_leaves_the_spring_unknown(
    prepared: PreparedSweep,
) -> None:
    """`held` or not is a spring more: ± half the width at the largest torque, 2.5 of 20 arcsec, 12.5 %."""
    evidence = of_shapes(prepared, 2)
    first, second = evidence.terms[:2]
    assert {k for k in first.shape if first.shape[k] != second.shape[k]} == {"held"}
    length = lengths_beyond_calibration(evidence, [0, 1])
    doubt = leak(fit_regressors(evidence, [0, 2]))[SPRING]
    # the other shape is as long beyond the calibration; the spring's prior and the noise are below a percent
    assert doubt == pytest.approx(12.5 * length[0] / length[1], rel=0.02)


def test_a_spring_is_no_size_of_a_shape(prepared: PreparedSweep) -> None:
    """What the calibration takes up has no shape to miss: of a spring nothing but its prior is left."""
    evidence = of_shapes(prepared, 2)
    fit = fit_regressors(evidence, [0, 2])
    spring = float(fit.posterior.mean[-1] / evidence.scale[2])
    raw = abs(spring) * float(np.linalg.norm(evidence.x[:, 2]))
    # the rows know the compliance far better than its prior of 2 %
    assert raw > 100
    assert effect_size(fit, SPRING) < 0.1 * raw
