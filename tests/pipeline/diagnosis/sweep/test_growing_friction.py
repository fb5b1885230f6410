"""Friction that grows with a power of the load."""

from __future__ import annotations

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, shape_of, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import GROWING
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.pipeline.diagnosis.sweep.evidence.shape_tuning import tuned
from flexspline.results.diagnosis.words import magnitude_words

pytestmark = pytest.mark.usefixtures("causes_only")

FRICTION = known_causes()["friction_hysteresis"]
HISTORY = sweep(cycles=3, rows=160, hold=0)
SHAPE = shape_of("friction_hysteresis", HISTORY, loaded=GROWING, spread=0)


def width_at(torque_Nm: float, growth: float) -> float:
    """Of the last cycle's loop, between its way up and its way down at one torque."""
    column = FRICTION.columns({**SHAPE, "threshold_Nm": 0.05, "growth": growth}, HISTORY)[:, 0]
    last = HISTORY.cycle == 2
    at = np.flatnonzero(last & np.isclose(HISTORY.torque_Nm, torque_Nm))
    assert len(at) == 2
    return float(abs(np.diff(column[at])[0]))


@pytest.mark.parametrize("growth", [0.7, 1.0, 1.5])
def test_the_loop_widens_with_that_power_of_torque(growth: float) -> None:
    # both torques are far from a turn, where the element has slipped
    assert width_at(1.5, growth) / width_at(0.5, growth) == pytest.approx(3.0**growth)
    assert FRICTION.magnitude(
        [Element({**SHAPE, "growth": growth}, np.array([1.0]))], FitContext(PREDICTION, HISTORY)
    ) == pytest.approx(0.0, abs=1e-12)


def test_a_shape_of_an_older_model_file_grows_in_proportion() -> None:
    older = {k: v for k, v in SHAPE.items() if k != "growth"}
    assert np.array_equal(FRICTION.columns(older, HISTORY), FRICTION.columns(SHAPE, HISTORY))


def test_tuning_finds_the_power() -> None:
    true = {**SHAPE, "growth": 1.6}
    angle = 5.0 * FRICTION.columns(true, HISTORY)[:, 0]
    angle = angle + np.random.default_rng(5).normal(0, 0.05, len(angle))
    columns = design_matrix(FitContext(PREDICTION, HISTORY), {FRICTION.id: FRICTION})
    kept = np.abs(HISTORY.torque_Nm) > 0.05 * LARGEST
    now = gaussian_evidence(columns, angle, kept, Noise(0.05**2, 0.0, 0.5))
    start = next(i for i, t in enumerate(columns.terms) if dict(t.shape) == SHAPE)
    # 5 arcsec over 0.05 of noise on 450 rows: the power is known to about 0.3 %
    assert tuned(now, [start]).shapes[0][1]["growth"] == pytest.approx(1.6, abs=0.03)


def test_a_loop_in_proportion_to_load_has_a_doubt_where_it_is_closed() -> None:
    """Its width at T = 0 is none, and known no better than the rows there let."""
    noise = 0.3
    state, stuck = 0.0, []
    for step in np.diff(HISTORY.torque_Nm, prepend=0.0):
        state = float(np.clip(state + step / 0.1, -1.0, 1.0))
        stuck.append(state)
    rng = np.random.default_rng(11)
    angle = 10.0 * HISTORY.torque_Nm + 30.0 * HISTORY.sign - 1.5 * np.abs(HISTORY.torque_Nm) * stuck
    angle += rng.normal(0, noise, len(angle))
    (cause,) = diagnose_sweep(as_read(HISTORY, angle), PREDICTION)[0].causes
    assert cause.id == FRICTION.id
    near = (np.abs(HISTORY.torque_Nm) < 0.15 * LARGEST).sum()
    assert abs(cause.magnitude) < 2 * cause.magnitude_std
    assert (
        cause.magnitude_std >= 2 * noise / near**0.5 * 0.8
    )  # the noise is estimated, to some 10 %
    assert magnitude_words(cause).endswith("arcsec wide at T = 0")
