"""The race against closed forms: evidence of a set, the beam, tuning, the leftover's p-value, offsets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, PREDICTION
from histories import sweep as swept
from scipy.stats import multivariate_normal

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import MOST_FIT_ROWS, thinned
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import crossing
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.pipeline.diagnosis.sweep.evidence.shape_tuning import tuned
from flexspline.pipeline.diagnosis.sweep.race.torque_offset_race import (
    OFFSET_LEAST,
    OFFSET_SURE,
)
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import channel_tests

SIGMA = 0.5


def raced(history: History, target: np.ndarray, noise: float = SIGMA) -> GaussianEvidence:
    known = {
        k: known_causes()[k]
        for k in ("friction_hysteresis", "stiffness_hardening", "direction_asymmetry")
    }
    columns = design_matrix(FitContext(PREDICTION, history), known)
    kept = np.abs(history.torque_Nm) > 0.07 * LARGEST
    return gaussian_evidence(columns, target, kept, Noise(noise**2, 0.0, 0.5))


def test_evidence_is_the_gaussian_density() -> None:
    """Of the data under a linear model with Gaussian priors; source: Bishop, PRML (2006), 3.5."""
    history = swept(cycles=1)
    rng = np.random.default_rng(1)
    now = raced(history, rng.normal(0, 2, len(history)))
    chosen = (3, len(now.terms) // 2)
    kept, columns = now.kept, now.columns

    def density(terms: tuple[int, ...]) -> float:
        x = np.hstack([columns.base[kept], *(columns.all[kept][:, now.terms[i].at] for i in terms)])
        prior = np.concatenate([columns.base_prior, *(now.terms[i].prior for i in terms)])
        # the zero's prior of 1e5 arcsec would drown the rest in rounding: a smaller one for both
        prior = np.minimum(prior, 1e3)
        covariance = (x * prior**2) @ x.T + SIGMA**2 * np.eye(len(x))
        return float(multivariate_normal.logpdf(now.target[kept], cov=covariance))

    found = Search(now).candidate(chosen).log_evidence
    assert found == pytest.approx(density(chosen) - density(()), abs=1e-3)


def test_the_beam_finds_what_trying_all_pairs_finds() -> None:
    history = swept(cycles=2)
    friction, asymmetry = (
        known_causes()["friction_hysteresis"],
        known_causes()["direction_asymmetry"],
    )
    rig = FitContext(PREDICTION, history)
    angle = 4.0 * friction.columns(friction.shapes(rig)[7], history)[:, 0]
    angle = angle + 1.5 * asymmetry.columns(asymmetry.shapes(rig)[0], history)[:, 0]
    now = raced(history, angle + np.random.default_rng(2).normal(0, SIGMA, len(angle)))
    search = Search(now, lambda t: t.cause is not None)
    best = search.run(most=2)
    named = [i for i, t in enumerate(now.terms) if t.cause is not None]
    pairs = (search.candidate((i, j)) for i in named for j in named if i < j)
    better = (
        c for c in pairs if c.score > best.score + 1e-6
        if all((a >= 0).all() or not now.terms[i].positive
               for i, a in zip(c.terms, fit_regressors(now, c.terms).posterior.amplitudes(now), strict=True))
    )  # fmt: skip
    assert list(better) == []


def test_a_set_grown_term_by_term_has_the_evidence_of_all_at_once() -> None:
    """Of terms of one, two and more columns."""
    history = swept(cycles=2)
    now = raced(history, np.random.default_rng(5).normal(0, 2, len(history)) + history.torque_Nm)
    search = Search(now)
    search.run(most=3)
    assert {1, 2} < {now.terms[i].width for c in search.tried for i in c.terms}
    for grown in search.tried[:: len(search.tried) // 300 + 1]:
        whole = search.candidate(grown.terms)
        assert grown.owners == whole.owners
        # sums of three steps, each by another factorisation
        assert grown.log_evidence == pytest.approx(whole.log_evidence, abs=1e-6)
        assert grown.score == pytest.approx(whole.score, abs=1e-6)


def test_tuning_finds_the_knee() -> None:
    """A knee between two of the grid's, from the nearest of them."""
    history = swept(cycles=3, rows=120)
    hardening = known_causes()["stiffness_hardening"]
    shape = next(
        s
        for s in hardening.shapes(FitContext(PREDICTION, history))
        if s["law"] == 0 and s["held"] == 0
    )
    true = {**shape, "parameter": 0.37}
    angle = 8.0 * hardening.columns(true, history)[:, 0]
    now = raced(history, angle + np.random.default_rng(4).normal(0, 0.05, len(angle)), 0.05)
    start = next(
        i for i, t in enumerate(now.terms)
        if t.owner == "stiffness_hardening" and t.shape["law"] == 0 and t.shape["held"] == 0
        and t.shape["parameter"] == 0.45
    )  # fmt: skip
    found = tuned(now, [start]).shapes[0][1]["parameter"]
    # 8 arcsec over 0.05 arcsec of noise on 300 rows fix the knee to about 0.1 %; torque steps are 3 %
    # of the largest, and between two of them the knee is only seen by its slope
    assert found == pytest.approx(0.37, abs=0.01)


def test_p_values_are_even_where_nothing_is_left() -> None:
    history = swept(cycles=4)
    rng = np.random.default_rng(6)
    found: list[float] = []
    for _ in range(40):
        now = raced(history, rng.normal(0, SIGMA, len(history)))
        prepared = PreparedSweep(
            _sweep(history), PREDICTION, now.columns.rig, now.columns, now.target, now.kept,
            np.zeros(len(history), bool), 0.07 * LARGEST, 56.0, now.noise,
        )  # fmt: skip
        tests = channel_tests(prepared, fit_regressors(now, ()))
        found += [t.p_value for t in tests if t.channel in ("torque_Nm", "temperature_C")]
    share = np.mean(np.array(found) < 0.1)
    # 80 values, half of them nearly independent: 0.1 ± 3·√(0.09/40)
    assert 0.0 < share < 0.24


def test_crossing_finds_an_offset_and_none() -> None:
    rng = np.random.default_rng(8)
    torque = np.tile(np.concatenate([np.linspace(-1, 1, 201), np.linspace(1, -1, 201)]), 3)
    reading = torque + rng.normal(0, 0.01, len(torque))
    for offset in (0.0, 0.13):
        left = 30.0 * np.sign(torque) + rng.normal(0, 1.0, len(torque))
        seen = crossing(reading + offset, left, 60.0, 1.0, 0.01)
        assert seen is not None
        # rows stand 0.01 N·m apart and read 0.01 N·m wrong, and six crossings were seen
        assert seen.offset_Nm == pytest.approx(offset, abs=0.01)
        assert (seen.nats > 20) == (offset != 0)


@pytest.mark.parametrize("offset", [0.0, 0.13])
@pytest.mark.parametrize("width", [0.002, 0.006, 0.01, 0.017, 0.03, 0.04])
@pytest.mark.parametrize("form", [np.tanh, lambda x: np.clip(x / 1.5, -1, 1)], ids=["tanh", "ramp"])
def test_soft_ends_of_the_gap_are_no_offset(
    form: Callable[[np.ndarray], np.ndarray], width: float, offset: float
) -> None:
    """Teeth that take up their load one after another, in little noise: alike in both senses of torque."""
    rng = np.random.default_rng(9)
    torque = np.cos(2 * np.pi * 8 * np.arange(3000) / 3000)
    torque = torque[
        (torque < offset) | (np.arange(3000) % 4 == 0)
    ]  # fewer rows beyond the crossing
    n = len(torque)
    reading = torque + offset + rng.normal(0, 8e-4, n)
    seen = crossing(reading, 30 * form(torque / width) + rng.normal(0, 0.3, n), 60.0, 0.3, 8e-4)
    assert seen is not None
    if offset:
        # within a tenth of the ends, whose form is unknown, or two thirds of what is said at least
        nearest = max(4 * seen.std_Nm, width / 10, min(OFFSET_LEAST) * 2 / 3)
        assert abs(seen.offset_Nm - offset) < nearest
        assert seen.nats > OFFSET_SURE
    else:
        # 0 is among the places: another gains half a nat over it in the mean of noise, two once in 20 times
        assert seen.nats < 2
        # a third of what is said at least; rows stand 0.017 N·m apart at the crossing, and nothing tells
        # places between two of them apart where the ends are narrower
        assert abs(seen.offset_Nm) < (0.017 / 2 if width < 0.017 / 4 else min(OFFSET_LEAST) / 3)


def test_a_crossing_between_rows_is_known_to_no_better_than_they_stand() -> None:
    """Every cycle has the same torques, 0.2 N·m apart: any place between two of them fits as well."""
    steps = np.linspace(-2, 2, 21)
    torque = np.tile(np.concatenate([steps, steps[::-1]]), 4)
    for offset in (0.12, 0.22, 0.31):
        left = 30.0 * np.sign(torque - offset)
        seen = crossing(torque, left, 60.0, 1.0, 0.001)
        assert seen is not None
        # less twice the noise of 0.001 N·m at either row: eight readings there are not all wrong; and a
        # tenth, as soft ends of the gap, which would show at a row near them, are likelier in the middle
        assert seen.std_Nm >= (0.2 - 8 * 0.001) / np.sqrt(12) * 0.9
        assert abs(seen.offset_Nm - offset) < 2 * seen.std_Nm


def test_an_owner_may_give_way_once_the_set_is_whole() -> None:
    """From a wrong cause, kept because the set may not grow, to the true one."""
    history = swept(cycles=2)
    asymmetry = known_causes()["direction_asymmetry"]
    angle = (
        3.0 * asymmetry.columns(asymmetry.shapes(FitContext(PREDICTION, history))[0], history)[:, 0]
    )
    now = raced(history, angle + np.random.default_rng(2).normal(0, SIGMA, len(angle)))
    wrong = next(i for i, t in enumerate(now.terms) if t.owner == "stiffness_hardening")
    search = Search(now, lambda t: t.cause is not None)
    search.run([[wrong]], most=1)
    assert search.exchanged().owners == {"direction_asymmetry"}


def test_no_offset_from_torque_one_way() -> None:
    torque = np.linspace(0.0, 1.0, 300)
    assert crossing(torque, 30.0 * np.sign(torque), 60.0, 1.0, 0.01) is None


@pytest.mark.parametrize("too_high_Nm", [0.0, 0.3])
def test_thinning_keeps_straight_branches_and_both_sides_of_the_gap(too_high_Nm: float) -> None:
    n = 40_000
    torque = 2.0 * np.sin(np.linspace(0, 8 * np.pi, n))
    cycle = np.repeat(np.arange(4), n // 4)
    history = History(torque, np.zeros(n, int), cycle, np.arange(n, dtype=float))
    angle = PREDICTION.angle_arcsec(history)
    short = thinned(_sweep(history.shifted(-too_high_Nm), angle))
    assert len(short) < 1.3 * MOST_FIT_ROWS
    # on a straight branch means of torque and angle stay on it; a mean over the gap would be on neither side.
    # of a row that stays single torque is a mean over seven: of a curve it is off by T''·(0 + 1 + 4 + 9)/7
    off = short.angle_arcsec - PREDICTION.angle_arcsec(short.history.shifted(too_high_Nm))
    assert np.abs(off).max() < PREDICTION.compliance * 2.0 * (8 * np.pi / n) ** 2 * 2
    assert set(np.unique(short.history.cycle)) == {0, 1, 2, 3}


def _sweep(history: History, angle: np.ndarray | None = None) -> Sweep:
    from pathlib import Path

    n = len(history)
    values = np.zeros(n) if angle is None else angle
    plain = replace(history)
    return Sweep(Path("made-up.csv"), plain, values, ("",), ((0.0, 1.0),), np.arange(n), True)
