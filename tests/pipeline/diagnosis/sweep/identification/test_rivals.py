"""What explains a record as well as a cause does: by rows, by what is known of the gear, and by physics."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import FrictionAhead, design_matrix
from flexspline.pipeline.diagnosis.sweep.identification.rivals import penalised, rivals_of
from flexspline.pipeline.diagnosis.sweep.race.friction_ahead_tuning import ahead_element

STEEL_ALUMINIUM = 12e-6
"""/K by which they expand differently."""
ARCSEC_PER_RAD = 206_265.0


def spring_left_out(share: float) -> GaussianEvidence:
    """A compliance that is larger than simulated; no noise."""
    history = sweep(cycles=3, hold=0)
    known = {"series_compliance": known_causes()["series_compliance"]}
    columns = design_matrix(FitContext(PREDICTION, history), known)
    target = share * PREDICTION.compliance * history.torque_Nm
    kept = np.abs(history.torque_Nm) > 0.07 * LARGEST
    return gaussian_evidence(columns, target, kept, Noise(0.01, 0.0, 0.5))


def test_a_calibration_far_beyond_its_stated_uncertainty_counts_against_an_explanation() -> None:
    """Rows alone are explained by either; one is 10 stated deviations (3 %) off, the other a spring."""
    evidence = spring_left_out(0.3)
    behind = penalised(evidence, (0,)) - penalised(evidence, ())
    # ½·10² nats of the calibration, less ½ log n of the spring's amplitude; the rows' own noise is small
    # against either, and the spring's prior, 15 % or more, takes less than one nat
    expected = 50.0 - np.log(evidence.rows) / 2
    assert behind == pytest.approx(expected, abs=4.0)


def test_penalised_likelihood_within_the_stated_uncertainty_is_that_of_the_rows() -> None:
    evidence = spring_left_out(0.0)
    # a spring of nothing: nothing gained, and its amplitude paid for
    assert penalised(evidence, (0,)) - penalised(evidence, ()) == pytest.approx(
        -np.log(evidence.rows) / 2, abs=1e-6
    )


@pytest.mark.parametrize("metals", [1.0, 10.0])
def test_no_two_metals_make_a_gap_grow_by_a_temperature_that_none_saw(metals: float) -> None:
    """Flanks at 45° turn twice the difference of the radii into angle."""
    cause = known_causes()["thermal_clearance"]
    per_K = metals * 2 * STEEL_ALUMINIUM * ARCSEC_PER_RAD
    unsettled = {"lag_s": 10.0, "longest_lag_s": 20.0, "colder_K": 1.0, "most_off_K": 3.0}
    seen = {"lag_s": 0.0, "longest_lag_s": 20.0}
    rig = FitContext(PREDICTION, sweep())
    assert cause.plausible((Element(unsettled, (per_K,)),), rig) == (metals == 1.0)
    assert cause.plausible((Element(unsettled, (-per_K,)),), rig) == (metals == 1.0)
    assert cause.plausible((Element(seen, (per_K,)),), rig)


def diagnosed(growth_arcsec: float) -> DiagnosisOutcome:
    """A gap that runs in, in a room at 22 °C; noise of 1 arcsec."""
    history = sweep(cycles=3, rows=200, hold=0)
    still = np.full(len(history), 22.0)
    history = replace(history, temperature_C=still, input_angle_deg=None)
    torque, rng = history.torque_Nm, np.random.default_rng(11)
    clock = np.arange(len(torque)) / len(torque)
    grown = growth_arcsec * np.expm1(-clock) / np.expm1(-1.0)
    angle = 10.0 * torque + (60.0 + grown) / 2 * np.sign(torque) + rng.normal(0, 1.0, len(torque))
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), (tuple(np.unique(history.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    return diagnose_sweep(record, PREDICTION)[0]


def test_wear_at_constant_temperature_is_wear_where_no_metal_could_grow_so_much() -> None:
    """20 arcsec: a gear that was 3 K off and has come back by two thirds needs 10 arcsec/K."""
    (found,) = diagnosed(20.0).causes
    assert found.id == "wear"
    assert found.alternatives == ()


def test_wear_that_metals_could_grow_has_a_rival() -> None:
    """6 arcsec: a gear that was 3 K colder at the start needs 2 to 4 arcsec/K."""
    (found,) = diagnosed(6.0).causes
    assert set((found.id, *found.alternatives)) >= {"wear", "thermal_clearance"}


@pytest.mark.parametrize(("gap_arcsec", "rivals"), [(45.0, ("thermal_clearance",)), (90.0, ())])
def test_a_gap_beside_one_temperature_has_a_thermal_rival_that_metals_can_make(
    gap_arcsec: float, rivals: tuple[str, ...]
) -> None:
    """6 K from 20 °C: 7.5 and 15 arcsec/K, of which aluminium at 45° makes 10."""
    history = sweep(cycles=3, rows=200, hold=0)
    history = replace(history, temperature_C=np.full(len(history), 26.0), input_angle_deg=None)
    angle = PREDICTION.angle_arcsec(history) + gap_arcsec / 2 * history.sign
    angle = angle + np.random.default_rng(5).normal(0, 0.5, len(angle))
    causes = diagnose_sweep(as_read(history, angle), PREDICTION)[0].causes
    assert {c.id: c.alternatives for c in causes} == {"clearance_offset": rivals}


@pytest.mark.parametrize("ahead", [False, True])
def test_beside_friction_ahead_of_the_gap_a_rival_may_have_friction_behind_it(ahead: bool) -> None:
    """What a lag fits was made by creep of 0.6 arcsec and friction of 2 arcsec rms behind the gap."""
    history = replace(sweep(cycles=4, hold=30, rows=60), temperature_C=None, input_angle_deg=None)
    known = {k: known_causes()[k] for k in ("creep", "friction_hysteresis", "rate_dependence")}
    columns = design_matrix(FitContext(PREDICTION, history), known)
    if ahead:  # that takes nothing here: what is behind it is all that is fitted
        nothing = FrictionAhead(ahead_element(0.1, history), np.zeros(len(history)))
        columns = replace(columns, ahead=nothing)
    kept = np.abs(history.torque_Nm) > 0.07 * LARGEST

    def effect(owner: str, wanted: dict[str, float]) -> np.ndarray:
        at, *_ = [
            t.at for t in columns.terms
            if t.owner == owner and all(t.shape.get(k) == v for k, v in wanted.items())
        ]  # fmt: skip
        column = columns.all[:, at][:, 0].astype(float)
        return np.asarray(column / np.sqrt(np.mean(column[kept] ** 2)))

    target = 0.6 * effect("creep", {"shortest_s": 30.0, "exponent": 0.5})
    target += 2.0 * effect("friction_hysteresis", {"power": 3.2, "held": 0})
    evidence = gaussian_evidence(columns, target, kept, Noise(1.0, 0.0, 0.5))
    search = Search(evidence)
    lags = [i for i, t in enumerate(evidence.terms) if t.owner == "rate_dependence"]
    best = max((search.candidate((i,)) for i in lags), key=lambda c: c.score)
    rivals, _ = rivals_of(evidence, best, "rate_dependence")
    # without friction ahead, that behind it is no part of a set in which it was not named
    assert ("creep" in rivals) == ahead
