"""Linearised fits of specimens: maximum of the posterior, and evidence by Laplace."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log, pi

import numpy as np
from scipy.special import log_ndtr, logsumexp

from flexspline.pipeline.diagnosis.specimens.compliances import Compliances
from flexspline.pipeline.diagnosis.specimens.parameters import (
    MOST_TOLERANCES,
    SpecimenParameter,
    log_compliance,
)

NOISES = (0.003, 0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.05)
"""Relative standard deviations of a stiffness that are tried if the file states none."""
USUAL_NOISE, NOISE_FACTOR = 0.01, 2.0
"""One percent, within a factor of two, is what torsion rigs reach."""
GAUSS_NEWTON_STEPS = 8
"""Of Gauss-Newton at most: of 333 fits of the example and two made-up sets 303 are done after five, 3 not
after eight."""
NOISE_CHOSEN_IN, SETTLED_SPREADS = (1, 3), 1e-3
"""Rounds, from 0, in which the noise is chosen by what is left; and the step, in prior standard deviations,
below which a later round is the last."""
MOST_STEP = 3.0
"""Prior standard deviations that a round may move a parameter: beyond, the linear model is not trusted."""
DIFFERENCE_STEP = 1e-4
"""Of a prior standard deviation, for forward differences: doubles round them at 1e-12 of it."""
SECOND_TERM_NATS = -1.0
"""Log prior odds of a second term, 1 to 2.7."""
MOST_ZONE = 1.2
"""Largest load zone: 1 is all torque at the lobes; a fifth more is allowed for noise."""
LEAST_MODULUS_STD = 1e-9
"""Of ln E, where the design states no doubt: the modulus then stays, and its column is still divided by a
number above 0."""
LEAST_INSIDE = 1e-9
"""Probability, as 1 less what lies outside: doubles leave such a difference seven digits."""


@dataclass(frozen=True)
class SpecimenData:
    """Measured ln C (n,), what FE says, and what is known of the noise.

    `std` (n,) relative, None where not stated; `solver` relative, added to either. `modulus_std`: of
    ln E, the design's own.
    """

    fe: Compliances
    log_compliance: np.ndarray
    std: np.ndarray | None
    solver: float
    modulus_std: float

    def rows(self, chosen: np.ndarray) -> SpecimenData:
        """Some of the specimens."""
        std = None if self.std is None else self.std[chosen]
        return SpecimenData(
            self.fe.rows(chosen), self.log_compliance[chosen], std, self.solver, self.modulus_std
        )

    @property
    def noises(self) -> tuple[tuple[float, np.ndarray], ...]:
        """(log prior, σ (n,)) of every noise level considered."""
        n = len(self.log_compliance)
        if self.std is not None:
            return ((0.0, np.hypot(self.std, self.solver)),)
        prior = np.array([-((log(s / USUAL_NOISE) / log(NOISE_FACTOR)) ** 2) / 2 for s in NOISES])
        prior -= logsumexp(prior)
        return tuple(
            (float(p), np.full(n, float(np.hypot(s, self.solver))))
            for p, s in zip(prior, NOISES, strict=True)
        )


@dataclass(frozen=True)
class LaplaceFit:
    """A set of terms fitted.

    `score`: log evidence and log prior. `penalised`: largest log likelihood less ½ log n for each
    term. `mean` (1 + terms,) with `covariance`; `noise` (n,) at the likeliest level.
    `allowed`: whether signs and sizes are possible.
    """

    terms: tuple[SpecimenParameter, ...]
    score: float
    penalised: float
    mean: np.ndarray
    covariance: np.ndarray
    noise: np.ndarray
    allowed: bool

    @property
    def causes(self) -> tuple[str, ...]:
        """Ids of its findings: a dimension within its tolerance is none."""
        return tuple(
            t.owner for t, v in zip(self.terms, self.mean[1:], strict=True) if _finding(t, v)
        )

    @property
    def unnamed(self) -> tuple[SpecimenParameter, ...]:
        return tuple(t for t in self.terms if t.owner.startswith("?"))


def _finding(term: SpecimenParameter, value: float) -> bool:
    if not term.named:
        return False
    return term.sensitivity is None or abs(value) > term.sensitivity.tolerance_mm


def fit(data: SpecimenData, terms: Sequence[SpecimenParameter]) -> LaplaceFit:
    """Maximum of the posterior by Gauss-Newton, evidence by Laplace, noise levels summed over."""
    spread = np.array([max(data.modulus_std, LEAST_MODULUS_STD), *(t.spread for t in terms)])
    centre = np.array([0.0, *(t.centre for t in terms)])
    noises = data.noises
    noise = noises[len(noises) // 2][1]
    at = centre.copy()
    slope = np.zeros((len(noise), len(spread)))
    model = log_compliance(data.fe, terms, at)
    scores = np.zeros(len(noises))
    for round_ in range(GAUSS_NEWTON_STEPS):
        for j in range(len(at)):
            moved = at.copy()
            moved[j] += DIFFERENCE_STEP * spread[j]
            # per spread
            slope[:, j] = (log_compliance(data.fe, terms, moved) - model) / DIFFERENCE_STEP
        target = data.log_compliance - model + slope @ ((at - centre) / spread)
        if round_ in NOISE_CHOSEN_IN:
            scores = np.array([p + _evidence(target, slope, s) for p, s in noises])
            noise = noises[int(np.argmax(scores))][1]
        inner = slope.T @ (slope / noise[:, None] ** 2) + np.eye(len(at))
        new = centre + spread * np.linalg.solve(inner, slope.T @ (target / noise**2))
        new = np.clip(new, at - MOST_STEP * spread, at + MOST_STEP * spread)
        done = np.abs((new - at) / spread).max() < SETTLED_SPREADS and round_ > NOISE_CHOSEN_IN[-1]
        at = new
        model = log_compliance(data.fe, terms, at)
        if done:
            break
    scores = np.array([p + _evidence(target, slope, s) for p, s in noises])
    score = (
        float(logsumexp(scores))
        + sum(t.odds for t in terms)
        + SECOND_TERM_NATS * max(0, len(terms) - 1)
    )
    covariance = np.linalg.inv(inner) * np.outer(spread, spread)
    allowed = True
    for t, v, c in zip(terms, at[1:], np.diag(covariance)[1:], strict=True):
        if t.positive:
            score += log(2) + float(log_ndtr(v / c**0.5))
            allowed &= v > 0
        if t.sensitivity is not None:
            score += _where(t, float(v), float(c) ** 0.5)
            allowed &= abs(v) <= MOST_TOLERANCES * t.sensitivity.tolerance_mm
        if t.kind == "zone":
            allowed &= 0 < v * np.sign(t.centre) <= MOST_ZONE
    left = (data.log_compliance - model) / noise
    likelihood = -(float(left @ left) + (at[0] / spread[0]) ** 2) / 2 - float(np.log(noise).sum())
    return LaplaceFit(
        tuple(terms), score if allowed else -np.inf,
        likelihood - len(terms) * log(max(len(noise), 2)) / 2 if allowed else -np.inf,
        at, covariance, noise, bool(allowed),
    )  # fmt: skip


def _where(term: SpecimenParameter, value: float, std: float) -> float:
    """Log of what the posterior has where the term may be, over what its normal prior has there.

    Within the tolerance for a dimension that is right, beyond it for one that is wrong.
    """
    assert term.sensitivity is not None
    limit = term.sensitivity.tolerance_mm

    def log_mass(mean: float, width: float) -> float:
        beyond = np.logaddexp(log_ndtr((-limit - mean) / width), log_ndtr((mean - limit) / width))
        if not term.within:
            return float(beyond)
        inside = -np.expm1(min(float(beyond), 0.0))
        # far outside, what is left inside is the tail of the nearer limit
        return (
            log(inside) if inside > LEAST_INSIDE else float(log_ndtr((limit - abs(mean)) / width))
        )

    return log_mass(value, std) - log_mass(0.0, term.spread)


def _evidence(target: np.ndarray, slope: np.ndarray, noise: np.ndarray) -> float:
    """Log evidence of a linear model with standard normal parameters."""
    weighted = slope / noise[:, None] ** 2
    inner = slope.T @ weighted + np.eye(slope.shape[1])
    right = weighted.T @ target
    quadratic = float((target / noise) @ (target / noise) - right @ np.linalg.solve(inner, right))
    logdet = float(np.linalg.slogdet(inner)[1]) + 2 * float(np.log(noise).sum())
    return -(quadratic + logdet + len(noise) * log(2 * pi)) / 2
