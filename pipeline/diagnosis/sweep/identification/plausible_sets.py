"""Excludes sets of terms that only fit a misfit or the noise."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.creep import CREEP
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate, Search
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.identification.owner_rms import owner_rms
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import less_fitted

DRIVEN = (
    FRICTION,
    RATE,
    CREEP,
    "?direction",
    "?torque_rate",
    "?torque_amplitude",
)
"""Owners of terms with a memory of the torque."""
OF_TORQUE_NOISE = 0.7
"""Of what the torque's noise is in the angle: the noise drives a memory too, and leaves a trace of it up to
so large. In made-up records true ones begin at 1.2; from noise alone a set of three terms had 0.47."""
TOGETHER_RATIO = 3.0
"""How much larger than their sum many effects may be, each by itself. Judgement."""
CURVES = {SERIES: 1, HARDENING: 2}
"""Causes whose angle is a curve over the torque, and what of such a curve may be the gear's own: its zero;
of a hardening its compliance too. As powers of the torque below that one."""
NEGLIGIBLE_NATS = 20.0
"""Behind the best set, 1 to 500 million: a few hundred such sets change no third digit of a probability."""
UNDONE = 0.5
"""Of such a curve: how much of it unnamed terms may take back. On a locked gear the output's angle is nearly
a function of the torque, and a ripple over it any curve. In made-up records of friction and a joint that
softens beyond a load, such a ripple took back 0.94 to 2.6 times of a hardening that was not there; of the
joint alone, a gear 12 % stiffer."""
UNNAMED_TOGETHER = 2.0
"""The same of two nuisance terms: three quarters of their power is then gone. Nothing says that either is
there, and what a lock lets go and a drift brings back at once has not moved."""


def plausible(evidence: GaussianEvidence, search: Search, best: Candidate) -> Candidate:
    """The best set in which effects do not nearly cancel, and none is the torque's noise through a memory.

    Sets that do fit a misfit, or the noise.
    """
    for c in (best, *sorted(search.best.values(), key=lambda c: -c.score)):
        if not fits_noise(evidence, c):
            return c
    return search.candidate(())


def explanations(evidence: GaussianEvidence, search: Search) -> list[Candidate]:
    """The sets that count for a probability: those near the best by evidence, and plausible."""
    least = search.top.score - NEGLIGIBLE_NATS
    close = [c for c in search.best.values() if c.score > least]
    return [c for c in close if not fits_noise(evidence, c)] or [search.top]


def fits_noise(evidence: GaussianEvidence, c: Candidate) -> bool:
    """Whether a set's effects nearly cancel, or one is the torque's noise through a memory."""
    owners = c.owners
    nuisance = any(o.startswith("?") for o in owners)
    driven = sorted(owners & {*DRIVEN})
    if not nuisance and not driven:
        return False
    fit = fit_regressors(evidence, c.terms)
    if nuisance and (_cancels(fit, owners) or _undone(fit, owners)):
        return True
    return bool(driven) and _is_torque_noise(fit, driven)


def _is_torque_noise(fit: SweepFit, driven: Sequence[str]) -> bool:
    """Whether the noise of the torque that drives a memory may have made what a term of it explains."""
    evidence = fit.evidence
    of_noise = fit.measured_rig().compliance * torque_noise_Nm(evidence.columns.rig.history)
    return min(owner_rms(fit, driven).values()) < OF_TORQUE_NOISE * of_noise


def _cancels(fit: SweepFit, owners: Collection[str]) -> bool:
    """Whether a set with a nuisance term holds large effects that together are small, all or two of them.

    A nuisance term is less what torque and its lags explain. Beside a cause that is not, the two may leave
    those lags, which know the true torque better than its reading does.
    """
    parts = np.array([fit.added(o)[fit.evidence.kept] for o in owners])
    parts -= parts.mean(axis=1, keepdims=True)
    if (parts**2).sum() > TOGETHER_RATIO**2 * (parts.sum(axis=0) ** 2).sum():
        return True
    products = parts @ parts.T
    own = np.add.outer(np.diag(products), np.diag(products))
    nuisance = np.array([o.startswith("?") for o in owners])
    pairs = np.triu(np.logical_or.outer(nuisance, nuisance), 1)
    most = np.where(np.logical_and.outer(nuisance, nuisance), UNNAMED_TOGETHER, TOGETHER_RATIO)
    return bool((pairs & (own > most**2 * (own + 2 * products))).any())


def _undone(fit: SweepFit, owners: Collection[str]) -> bool:
    """Whether unnamed terms take back the curve over the torque that a cause makes."""
    kept = fit.evidence.kept
    torque = fit.evidence.columns.rig.history.torque_Nm[kept]
    unnamed = sum(fit.added(o)[kept] for o in owners if o.startswith("?"))
    for cause_id, powers in CURVES.items():
        if cause_id in owners:
            parts = np.column_stack([fit.added(cause_id)[kept], unnamed])
            basis = torque[:, None] ** np.arange(powers)
            own, others = less_fitted(parts, basis).T
            if own @ others < -UNDONE * (own @ own):
                return True
    return False


def cancels_itself(evidence: GaussianEvidence, c: Candidate, owner: str) -> bool:
    """Whether one cause's elements are large effects that nearly cancel: such sums can form any curve."""
    fit = fit_regressors(evidence, c.terms)
    parts = np.array([
        evidence.columns.all[evidence.kept][:, evidence.terms[i].at] @ amplitudes
        for i, amplitudes in zip(c.terms, fit.posterior.amplitudes(evidence), strict=True)
        if evidence.terms[i].owner == owner
    ])  # fmt: skip
    parts -= parts.mean(axis=1, keepdims=True)
    return bool((parts**2).sum() > TOGETHER_RATIO**2 * (parts.sum(axis=0) ** 2).sum())
