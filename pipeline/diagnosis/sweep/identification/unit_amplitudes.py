"""Several units in one file: which effects are common to them, and which belong to one unit."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import log_evidence
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification

OWN_NATS = 5.0
"""Nats that separate amplitudes must gain over a common one: odds of 150 to 1, by judgement, as each cause of
each record is asked and one that differs has the units judged apart."""
SHARE_STD = 2.0
"""Prior standard deviation of a unit's amplitude, over the common one: a ratio of 0 or 3 is likely."""
SHOWS, SHOWS_NOT = 4.0, 2.0
"""Standard deviations from zero of an amplitude that a unit certainly has, and that it need not have."""


@dataclass(frozen=True)
class UnitAmplitudes:
    """How much of a cause each unit shows: amplitude relative to the common one, with its deviation.

    `nats` is what separate amplitudes gain over a common one; arrays (units,).
    """

    share: np.ndarray
    share_std: np.ndarray
    nats: float

    @property
    def differ(self) -> bool:
        """Whether the units differ beyond doubt."""
        return self.nats > OWN_NATS

    @property
    def own(self) -> tuple[int, ...]:
        """Units that alone show the cause; empty where all do."""
        z = np.abs(self.share) / self.share_std
        shown = np.flatnonzero(z > SHOWS)
        if not self.differ or len(shown) == len(z) or not (z < SHOWS_NOT).any():
            return ()
        return tuple(int(u) for u in shown)


def unit_amplitudes(identified: Identification, cause: str) -> UnitAmplitudes:
    """Scale a named cause's fitted effect separately in each unit.

    The cause's shapes and the proportions of its elements stay as fitted; everything else in the model
    is free again.
    """
    evidence, fit = identified.search.evidence, identified.fit
    unit = fit.rig.history.unit
    count = int(unit.max()) + 1
    effect = fit.added(cause)
    others = [
        evidence.x[:, evidence.terms[i].at]
        for i in fit.posterior.terms
        if evidence.terms[i].owner != cause
    ]
    rest, prior = evidence.base_with(others)
    apart = evidence.whitened(np.column_stack([effect * (unit == u) for u in range(count)]))
    common = apart.sum(axis=1, keepdims=True)
    shared, separate = _fit(evidence.y, rest, prior, apart)
    _, together = _fit(evidence.y, rest, prior, common)
    mean, covariance = shared
    return UnitAmplitudes(mean, np.sqrt(np.diag(covariance)), separate - together)


def _fit(
    y: np.ndarray, rest: np.ndarray, prior: np.ndarray, apart: np.ndarray
) -> tuple[tuple[np.ndarray, np.ndarray], float]:
    """Amplitudes (k,) of `apart` with covariance, and the evidence; their prior is 0 ± SHARE_STD."""
    k = apart.shape[1]
    x = np.hstack([rest, apart])
    precision = np.diag(np.concatenate([prior, np.full(k, SHARE_STD**-2)]))
    matrix, right = x.T @ x + precision, x.T @ y
    inverse = np.linalg.inv(matrix)
    evidence = log_evidence(matrix, right) - k * log(SHARE_STD)
    return ((inverse @ right)[-k:], inverse[-k:, -k:]), evidence
