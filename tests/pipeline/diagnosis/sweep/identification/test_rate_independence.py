"""A rate dependence beside friction must follow the rate: a loop that knows none is friction's own."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hidden.adapter import diagnose
from hidden.cases import draw_case
from histories import LARGEST, PREDICTION, shape_of, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.decision import EVEN_ODDS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.measurement.ramps import cycle_rate
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.pipeline.diagnosis.sweep.identification.rate_independence import (
    RATES_WITHIN,
    at_one_rate,
    follows_rate,
    rates_apart_within,
)

NOISE = 0.2  # arcsec
STEADY = sweep(cycles=6, rows=120, hold=0)


def at_rates(history: History, factors: tuple[float, ...]) -> History:
    """The same torques, each cycle so many times quicker."""
    assert history.time_s is not None
    steps = np.diff(history.time_s, prepend=history.time_s[0])
    return replace(history, time_s=np.cumsum(steps / np.array(factors)[history.cycle]))


VARIED = at_rates(STEADY, (0.5, 2.0, 1.0, 0.6, 1.7, 1.0))


def test_at_one_rate_each_cycle_runs_alike() -> None:
    alike = at_one_rate(VARIED)
    assert alike is not None
    rates = [cycle_rate(alike, rows) for rows in alike.cycle_slices]
    assert rates == pytest.approx([rates[0]] * 6, rel=1e-6)
    assert np.array_equal(alike.torque_Nm, VARIED.torque_Nm)
    assert (np.diff(alike.time_s) > 0).all()


def test_of_cycles_at_one_rate_nothing_is_known() -> None:
    assert at_one_rate(STEADY) is None
    assert at_one_rate(replace(VARIED, time_s=None)) is None


@pytest.mark.parametrize("follows", [True, False])
def test_only_a_twist_that_follows_the_rate_does(follows: bool) -> None:
    """The same law once computed with the record's rates, once as if all cycles ran at one."""
    known = {k: known_causes()[k] for k in ("friction_hysteresis", "rate_dependence")}
    rate, friction = known["rate_dependence"], known["friction_hysteresis"]
    blind = at_one_rate(VARIED)
    assert blind is not None
    lag = shape_of("rate_dependence", VARIED, exponent=1.0)
    loop = shape_of("friction_hysteresis", VARIED, loaded=0)
    angle = 3.0 * friction.columns(loop, VARIED)[:, 0]
    twist = rate.columns(lag, VARIED if follows else blind)[:, 0]
    angle = angle + 2.0 * twist / twist.std()
    angle += np.random.default_rng(4).normal(0, NOISE, len(angle))
    columns = design_matrix(FitContext(PREDICTION, VARIED), known)
    kept = np.abs(VARIED.torque_Nm) > 0.1
    now = gaussian_evidence(columns, angle, kept, Noise(NOISE**2, 0.0, 0.5))
    chosen = [
        next(
            i
            for i, t in enumerate(columns.terms)
            if t.owner == owner and dict(t.shape).items() >= shape.items()
        )
        for owner, shape in (("friction_hysteresis", loop), ("rate_dependence", lag))
    ]
    assert follows_rate(now, Search(now).candidate(chosen)) == follows


@pytest.mark.usefixtures("causes_only")
def test_a_lag_beside_friction_is_found() -> None:
    rate, friction = known_causes()["rate_dependence"], known_causes()["friction_hysteresis"]
    twist = rate.columns(shape_of("rate_dependence", VARIED, exponent=0.6), VARIED)[:, 0]
    loop = friction.columns(shape_of("friction_hysteresis", VARIED, loaded=0), VARIED)[:, 0]
    angle = PREDICTION.angle_arcsec(VARIED) + 3.0 * loop + twist / twist.std()
    angle += np.random.default_rng(7).normal(0, NOISE, len(angle))
    record = as_read(VARIED, angle)
    named = {c.id for c in diagnose_sweep(record, PREDICTION)[0].causes}
    assert named == {"friction_hysteresis", "rate_dependence"}


TURN = np.linspace(0, 2 * np.pi, 400, endpoint=False)
SINE = replace(
    sweep(cycles=5, rows=400, hold=0),
    torque_Nm=np.tile(LARGEST * np.sin(TURN), 5),
    temperature_C=None,
    input_angle_deg=None,
)
"""One rate, one amplitude, 2000 s a cycle."""
LAG_S = 120.0
"""Of a Kelvin element with a fifth of the twist: its loop of 2.6 arcsec is as wide as the friction's of 3."""


def lagging(history: History) -> np.ndarray:
    """(n,) twist of a Kelvin element, θ' = (c·T − θ)/τ, less what it has without lag, by small steps."""
    assert history.time_s is not None
    out, state = np.zeros(len(history)), 0.0
    for i in range(1, len(history)):
        step = (history.time_s[i] - history.time_s[i - 1]) / LAG_S
        state += (1 - np.exp(-step)) * (2.0 * history.torque_Nm[i] - state)
        out[i] = state - 2.0 * history.torque_Nm[i]
    return out


def rubbing(history: History, within_Nm: float = 0.1) -> np.ndarray:
    """(n,) a Coulomb element's loop, 3 arcsec wide, that slips within so much of a turn."""
    state, out = 0.0, np.zeros(len(history))
    for i, step in enumerate(np.diff(history.torque_Nm, prepend=0.0)):
        state = min(max(state + step / within_Nm, -1.0), 1.0)
        out[i] = -1.5 * state
    return out


def found_in(
    added: np.ndarray, history: History = SINE, seed: int = 11
) -> dict[str, tuple[str, ...]]:
    """Causes found and their rivals in a sweep that reads these angles [arcsec] beside the simulated."""
    return {c.id: c.alternatives for c in outcome_of(added, history, seed).causes}


def outcome_of(added: np.ndarray, history: History, seed: int = 11) -> DiagnosisOutcome:
    angle = PREDICTION.angle_arcsec(history) + added
    angle = angle + np.random.default_rng(seed).normal(0, NOISE, len(angle))
    return diagnose_sweep(as_read(history, angle), PREDICTION)[0]


@cache
def rubbing_at_a_sine() -> DiagnosisOutcome:
    """What two tests compare with."""
    return outcome_of(rubbing(SINE), SINE)


@pytest.mark.usefixtures("causes_only")
def test_at_one_rate_a_loop_that_one_of_the_two_makes_has_its_name() -> None:
    """A lag's loop of a sine is an ellipse; Coulomb friction's is a parallelogram."""
    assert found_in(lagging(SINE)) == {"rate_dependence": ()}
    (friction,) = rubbing_at_a_sine().causes
    assert (friction.id, friction.alternatives) == ("friction_hysteresis", ())


RAMPS = replace(SINE, torque_Nm=np.tile(LARGEST * 2 / np.pi * np.arcsin(np.sin(TURN)), 5))
"""The same as triangles."""


def test_rates_within_a_record_tell_a_sine_from_ramps() -> None:
    """√(1 − 0.1²) over √(1 − 0.9²) = 2.28 of the sine: travel is even over the torque."""
    assert rates_apart_within(SINE) == pytest.approx(2.28, rel=0.02)
    assert rates_apart_within(RAMPS) == pytest.approx(1.0, abs=0.02)
    noise = np.random.default_rng(3).normal(0, 0.01 * LARGEST, len(RAMPS))
    noisy = rates_apart_within(replace(RAMPS, torque_Nm=RAMPS.torque_Nm + noise))
    assert noisy < RATES_WITHIN


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in (1, 2))]
)
def test_on_straight_ramps_at_one_rate_a_rate_dependence_is_never_without_friction(
    seed: int,
) -> None:
    """Eight springs that slip, on ramps from 10 to 100 % and back: they were named rate dependence, sure."""
    preloaded = replace(RAMPS, torque_Nm=0.55 * LARGEST + 0.45 * RAMPS.torque_Nm)
    loops = [rubbing(preloaded, 0.3 * LARGEST / k) for k in range(1, 9)]
    found = found_in(np.mean(loops, axis=0), preloaded, seed)
    assert found.keys() & {"rate_dependence", "friction_hysteresis"}
    assert found.get("rate_dependence", ("friction_hysteresis",)) == ("friction_hysteresis",)


@pytest.mark.usefixtures("causes_only")
def test_on_straight_ramps_at_one_rate_a_lag_is_not_told_from_friction() -> None:
    assert found_in(lagging(RAMPS), RAMPS)["rate_dependence"] == ("friction_hysteresis",)


@pytest.mark.parametrize("timed", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_rival_that_the_programme_leaves_open_has_even_odds(timed: bool) -> None:
    """On straight ramps at one rate, or without time: no explanation of the race stands for it."""
    history = RAMPS if timed else replace(SINE, time_s=None)
    added = lagging(RAMPS) if timed else rubbing(SINE)
    outcome = outcome_of(added, history)
    assert outcome.verdict == "ambiguous"
    (cause,) = outcome.causes
    assert {cause.id, *cause.alternatives} == {"rate_dependence", "friction_hysteresis"}
    assert cause.probability == EVEN_ODDS
    # nor is an effect that has no such rival less likely
    (sure,) = rubbing_at_a_sine().causes
    assert sure.probability > 0.99


@pytest.mark.usefixtures("causes_only")
def test_at_one_rate_a_loop_that_takes_both_is_either_s() -> None:
    """Friction whose thresholds are spread in some way has this loop by itself."""
    found = found_in(lagging(SINE) + rubbing(SINE))
    assert found == {
        "rate_dependence": ("friction_hysteresis",),
        "friction_hysteresis": ("rate_dependence",),
    }


@pytest.mark.usefixtures("causes_only")
def test_a_loop_that_no_element_of_friction_has_is_no_lag() -> None:
    """Bristles ahead of the teeth, at nine rates: once friction and rate dependence, beyond doubt."""
    found = diagnose(draw_case(980113, 2, "pair", "friction_ahead"))
    assert {c["id"] for c in found["causes"]} == {"friction_hysteresis", "kinematic_error"}
