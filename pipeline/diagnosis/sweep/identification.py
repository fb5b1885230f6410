"""From a finished race to causes: which are identified, and which rivals remain."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from math import log

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.decision import is_rival
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.fit import SweepFit, fit_regressors, owner_rms
from flexspline.pipeline.diagnosis.sweep.regressors import Regressor
from flexspline.pipeline.diagnosis.sweep.search import Candidate, Search
from flexspline.pipeline.diagnosis.sweep.size_doubt import SizeDoubt

NAMING_NATS, SECOND_NATS = 4.5, 7.0
"""A cause must raise the score by this over the best set without it: beside others by more, as their misfit
may feed it, unless they have but one shape."""
STAND_IN_NATS = 3.0
"""The same over a set with a nuisance term in its place: something is there, and of two that explain it alike
the nuisance term, which costs 4.5 more, is not the one."""
MINOR_SHARE = 0.045
"""An effect below this share of the main one's rms may be only that one's shape misfit, unless that one
has but one shape."""
MORE_WITHOUT, MORE_OF_RIVAL = 2, 3
"""Terms that a set without a cause, or with a rival in its place, may have more than the best set: another
law takes two or three elements for one."""
DRIVEN = (
    "friction_hysteresis",
    "rate_dependence",
    "creep",
    "?direction",
    "?torque_rate",
    "?torque_amplitude",
)
"""Owners of terms with a memory of the torque."""
OF_TORQUE_NOISE = 0.3
"""Of what the torque's noise is in the angle: the noise drives a memory too, and leaves a trace of it up to
so large. In made-up records true ones begin at 1.2; one from noise alone had 0.1."""
TOGETHER = 3.0
"""Times that many effects may be larger, each for itself, than what they are together."""


@dataclass(frozen=True)
class Identification:
    """The causes of the best set of regressors.

    Attributes
    ----------
    fit : the best set of terms, fitted. size_doubt : how well it knows the sizes.
    named : ids of its causes, largest first. rms : of each owner [arcsec].
    rivals : of each cause, ids that explain the record as well.
    evidence_nats : of each cause, nats over the best set without it.
    """

    search: Search
    best: Candidate
    fit: SweepFit
    size_doubt: SizeDoubt
    named: tuple[str, ...]
    rms: dict[str, float]
    rivals: dict[str, tuple[str, ...]]
    rival_sets: dict[str, Candidate]
    evidence_nats: dict[str, float]

    @property
    def unnamed_rms(self) -> float:
        """Of all nuisance terms and minor causes in the best set [arcsec]."""
        return float(np.sqrt(sum(r**2 for o, r in self.rms.items() if o not in self.named)))


def identify(search: Search, beside: bool = False) -> Identification:
    """Decide a search that has run; `beside`: another cause is already known."""
    evidence = search.evidence
    beside |= evidence.columns.ahead is not None
    best = _plausible(evidence, search, search.top)
    while True:
        nats, weak = _worth(evidence, best, beside)
        if not weak:
            break
        best = _best_of_owners(evidence, weak[min(weak, key=lambda c: nats[c])])
    fit = fit_regressors(evidence, best.terms)
    ahead = {FRICTION} if evidence.columns.ahead else set()
    rms = owner_rms(fit, sorted(best.owners(evidence) | ahead))
    held = best.named(evidence) | ahead
    largest = max((rms[c] for c in held if not known_causes()[c].exact), default=0.0)
    doubt = SizeDoubt.of(fit)
    named = sorted(
        (c for c in held if c in ahead or (rms[c] >= MINOR_SHARE * largest and doubt.is_any(c))),
        key=lambda c: -rms[c],
    )
    rivals: dict[str, tuple[str, ...]] = {}
    rival_sets: dict[str, Candidate] = {}
    for cause in named:
        if cause in ahead:  # no other cause changes where the gap is crossed each way
            rivals[cause] = ()
            continue
        rivals[cause], found = _rivals(evidence, best, cause)
        if found is not None:
            rival_sets[cause] = found
    return Identification(search, best, fit, doubt, tuple(named), rms, rivals, rival_sets, nats)


def _worth(
    evidence: GaussianEvidence, best: Candidate, beside: bool
) -> tuple[dict[str, float], dict[str, Candidate]]:
    """Nats of each cause over the best set without it, and of each that is not worth its place that set.

    Where another cause alone would stand in for it nearly as well, something is there, and the two are
    rivals: it is weak if it is little better than a set without either. Where a nuisance term must help, what
    is there has no name.
    """
    nats: dict[str, float] = {}
    weak: dict[str, Candidate] = {}
    present = best.named(evidence)
    inexact = {c for c in present if not known_causes()[c].exact}

    def too_little(without: Candidate, cause: str) -> bool:
        if _stands_in(evidence, best, without):
            needed = STAND_IN_NATS
        else:
            needed = SECOND_NATS if beside or inexact - {cause} else NAMING_NATS
        return best.score - without.score < needed

    for cause in present:
        without = _without(evidence, best, _other_than(cause))
        nats[cause] = best.score - without.score
        if not too_little(without, cause):
            continue
        if without.named(evidence) - present and not _stands_in(evidence, best, without):
            rest = present - {cause}
            without = _without(evidence, best, _unnamed_or(rest))
        if too_little(without, cause):
            weak[cause] = without
    return nats, weak


def _plausible(evidence: GaussianEvidence, search: Search, best: Candidate) -> Candidate:
    """The best set in which effects do not nearly cancel, and none is the torque's noise through a memory.

    Sets that do fit a misfit, or the noise.
    """
    for c in (best, *sorted(search.best.values(), key=lambda c: -c.score)):
        if not _fits_noise(evidence, c):
            return c
    return search.candidate(())


def _fits_noise(evidence: GaussianEvidence, c: Candidate) -> bool:
    """Whether a set's effects nearly cancel, or one is the torque's noise through a memory."""
    owners = c.owners(evidence)
    nuisance = any(o.startswith("?") for o in owners)
    driven = sorted(owners & {*DRIVEN})
    if not nuisance and not driven:
        return False
    fit = fit_regressors(evidence, c.terms)
    if nuisance and _cancels(fit, owners):
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
    if (parts**2).sum() > TOGETHER**2 * (parts.sum(axis=0) ** 2).sum():
        return True
    products = parts @ parts.T
    own = np.add.outer(np.diag(products), np.diag(products))
    nuisance = np.array([o.startswith("?") for o in owners])
    pairs = np.triu(np.logical_or.outer(nuisance, nuisance), 1)
    return bool((pairs & (own > TOGETHER**2 * (own + 2 * products))).any())


def _cancels_itself(evidence: GaussianEvidence, c: Candidate, owner: str) -> bool:
    """Whether one cause's elements are large effects that together are small: that makes any curve."""
    fit = fit_regressors(evidence, c.terms)
    parts = np.array([
        evidence.columns.all[evidence.kept][:, evidence.terms[i].at] @ amplitudes
        for i, amplitudes in zip(c.terms, fit.posterior.amplitudes(evidence), strict=True)
        if evidence.terms[i].owner == owner
    ])  # fmt: skip
    parts -= parts.mean(axis=1, keepdims=True)
    return bool((parts**2).sum() > TOGETHER**2 * (parts.sum(axis=0) ** 2).sum())


def _without(
    evidence: GaussianEvidence, best: Candidate, allowed: Callable[[Regressor], bool]
) -> Candidate:
    """The best set of the terms allowed, beginning with those of the best set of all."""
    start = [i for i in best.terms if allowed(evidence.terms[i])]
    search = Search(evidence, allowed)
    return _plausible(
        evidence, search, search.run([start, ()], most=len(best.terms) + MORE_WITHOUT)
    )


def _stands_in(evidence: GaussianEvidence, best: Candidate, without: Candidate) -> bool:
    """Whether a set that does without a cause has a nuisance term more."""

    def count(c: Candidate) -> int:
        return sum(evidence.terms[i].cause is None for i in c.terms)

    return count(without) > count(best)


def _other_than(cause: str) -> Callable[[Regressor], bool]:
    return lambda term: term.owner != cause


def _unnamed_or(causes: Collection[str]) -> Callable[[Regressor], bool]:
    return lambda term: term.cause is None or term.owner in causes


def _best_of_owners(evidence: GaussianEvidence, known: Candidate) -> Candidate:
    """The best set of the same owners: where others were let in, theirs had not the whole beam."""
    owners = known.owners(evidence)
    search = Search(evidence, owned_by(owners))
    found = search.run([known.terms, ()], most=max(len(known.terms), 1))
    same = found.owners(evidence) == owners and not _fits_noise(evidence, found)
    return found if same and found.score > known.score else known


def owned_by(owners: Collection[str]) -> Callable[[Regressor], bool]:
    """Lets in the terms of these owners."""
    return lambda term: term.owner in owners


def _rivals(
    evidence: GaussianEvidence, best: Candidate, cause: str
) -> tuple[tuple[str, ...], Candidate | None]:
    """Ids of other causes that, in the place of this one, explain the record as well.

    Or in the place of several: of all that another cause may be made of.
    """

    def without(owners: Collection[str]) -> tuple[int, ...]:
        return tuple(i for i in best.terms if evidence.terms[i].owner not in owners)

    present = {evidence.terms[i].owner for i in best.terms}
    others = {t.cause.id for t in evidence.terms if t.cause} - present
    if evidence.columns.ahead:
        others -= {FRICTION}
    mine = penalised(evidence, best.terms)
    found: list[tuple[float, str, Candidate]] = []
    for other in sorted(others):
        allowed = {other, *(p for p in present - {cause} if not p.startswith("?"))}
        parts = known_causes()[other].made_of
        starts = [without({cause})]
        if cause in parts <= present:
            starts.append(without(parts))
        search = Search(evidence, owned_by(allowed))
        rival = search.run(starts, most=len(best.terms) + MORE_OF_RIVAL)
        if other not in rival.named(evidence) or _cancels_itself(evidence, rival, other):
            continue
        elements = fit_regressors(evidence, rival.terms).elements()[other]
        if not known_causes()[other].plausible(elements):
            continue
        gap = best.log_evidence_with_shapes(search) - rival.log_evidence_with_shapes(search)
        if is_rival(gap, mine - penalised(evidence, rival.terms)):
            found.append((gap, other, rival))
    found.sort(key=lambda f: f[0])
    return tuple(f[1] for f in found), (found[0][2] if found else None)


def penalised(evidence: GaussianEvidence, terms: tuple[int, ...]) -> float:
    """Log likelihood less ½ log n for each amplitude.

    The calibration counts by its stated uncertainty, which is known as the rows are: an explanation that
    needs a compliance or a gap far beyond it does not explain the record as well.
    """
    fit = fit_regressors(evidence, terms).posterior
    count = len(fit.mean) - fit.base_count
    off = fit.mean[: fit.base_count] / evidence.columns.base_prior
    return -(fit.chi2 + float(off @ off)) / 2 - count * log(max(evidence.rows, 2)) / 2
