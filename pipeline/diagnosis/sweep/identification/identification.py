"""From a finished race to causes: which are identified, and which rivals remain."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable
from dataclasses import dataclass, field
from typing import Any

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate, Search, owned_by
from flexspline.pipeline.diagnosis.sweep.evidence.fit import LINEAR, SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import Regressor
from flexspline.pipeline.diagnosis.sweep.identification.gear_curve_error import beyond_curve_doubt
from flexspline.pipeline.diagnosis.sweep.identification.owner_rms import (
    owner_rms,
    rms_beyond_calibration,
    rms_together,
)
from flexspline.pipeline.diagnosis.sweep.identification.plausible_sets import (
    CURVES,
    fits_noise,
    plausible,
)
from flexspline.pipeline.diagnosis.sweep.identification.rivals import rivals_of
from flexspline.pipeline.diagnosis.sweep.identification.significance import SizeDoubt

ALONE_NATS, SECOND_NATS = 4.5, 7.0
"""A cause must raise the score by this over the best set without it, odds of 90 and of 1100 to 1: beside
others by more, as their misfit may feed it, unless they have but one shape."""
STATED_NATS = 1.0
"""The same of a compliance or a gap alone, or of more rms than all causes of several shapes have together,
whose misfit it is not: the evidence is then that of its stated uncertainty, and neither has a shape to miss.
About four deviations are named, as one right simulation in 10 000 would be."""
STAND_IN_NATS = 3.0
"""The same over a set with a nuisance term in its place: something is there, and of two that explain it alike
the nuisance term, which costs 4.5 more, is not the one."""
MINOR_SHARE = 0.045
"""An effect below this share of the main one's rms may be only that one's shape misfit, unless that one
has but one shape. Of a hardening what zero, compliance and gap can be is no part of that rms: it is mostly a
straight spring, which misses nothing."""
MORE_WITHOUT = 2
"""Terms that a set without a cause may have more than the best set: another law takes two or three elements
for one."""


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
    memo: dict[tuple[Hashable, ...], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """Results computed from it and needed again (`../../measurement/once.py`)."""

    def unnamed(self, attributed: Collection[str]) -> tuple[str, ...]:
        """Owners in the best set that are none of the `attributed` causes, found or rivals."""
        return tuple(sorted(o for o in self.rms if o not in {*self.named, *attributed}))

    def unnamed_rms(self, attributed: Collection[str]) -> float:
        """Of what they add together [arcsec]: what one takes and another brings back is not there."""
        return rms_together(self.fit, self.unnamed(attributed))


def identify(search: Search, beside: bool = False) -> Identification:
    """Decide a search that has run; `beside`: another cause is already known."""
    evidence = search.evidence
    beside |= evidence.columns.ahead is not None
    best = plausible(evidence, search, search.top)
    while True:
        nats, weak = _worth(evidence, best, beside)
        if not weak:
            break
        best = _best_of_owners(evidence, weak[min(weak, key=lambda c: nats[c])])
    best = beyond_curve_doubt(search, best)
    fit = fit_regressors(evidence, best.terms)
    ahead = {FRICTION} if evidence.columns.ahead else set()
    rms = owner_rms(fit, sorted(best.owners | ahead))
    held = best.named(evidence) | ahead
    largest = max((_shaped_rms(fit, c, rms[c]) for c in held), default=0.0)
    doubt = SizeDoubt.of(fit)

    def is_sure(cause: str) -> bool:  # of one shape: that it is there is sure where its size is not
        return known_causes()[cause].exact and nats[cause] >= SECOND_NATS

    named = sorted(
        (
            c
            for c in held
            if c in ahead
            or (rms[c] >= MINOR_SHARE * largest and (doubt.is_significant(c) or is_sure(c)))
        ),
        key=lambda c: -rms[c],
    )
    rivals: dict[str, tuple[str, ...]] = {}
    rival_sets: dict[str, Candidate] = {}
    for cause in named:
        if cause in ahead:  # no other cause changes where the gap is crossed each way
            rivals[cause] = ()
            continue
        rivals[cause], rival_set = rivals_of(evidence, best, cause)
        if rival_set is not None:
            rival_sets[cause] = rival_set
    return Identification(search, best, fit, doubt, tuple(named), rms, rivals, rival_sets, nats)


def _shaped_rms(fit: SweepFit, cause: str, rms: float) -> float:
    """Rms [arcsec] of what a cause's shape may miss a part of."""
    if known_causes()[cause].exact:
        return 0.0
    return rms_beyond_calibration(fit, cause) if cause in CURVES else rms


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
    fit = fit_regressors(evidence, best.terms)
    of_misfit = rms_together(fit, sorted(inexact))

    def too_little(without: Candidate, cause: str) -> bool:
        if _stands_in(evidence, best, without):
            needed = STAND_IN_NATS
        elif cause in LINEAR and not beside and rms_together(fit, (cause,)) > of_misfit:
            needed = STATED_NATS
        elif beside or inexact - {cause}:
            needed = SECOND_NATS
        else:
            needed = ALONE_NATS
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


def _without(
    evidence: GaussianEvidence, best: Candidate, allowed: Callable[[Regressor], bool]
) -> Candidate:
    """The best set of the terms allowed, beginning with those of the best set of all."""
    start = [i for i in best.terms if allowed(evidence.terms[i])]
    search = Search(evidence, allowed)
    return plausible(evidence, search, search.run([start, ()], most=len(best.terms) + MORE_WITHOUT))


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
    owners = known.owners
    search = Search(evidence, owned_by(owners))
    searched = search.run([known.terms, ()], most=max(len(known.terms), 1))
    same = searched.owners == owners and not fits_noise(evidence, searched)
    return searched if same and searched.score > known.score else known
