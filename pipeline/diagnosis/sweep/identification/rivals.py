"""Which other causes explain a record as well, in the place of one that is named."""

from __future__ import annotations

from collections.abc import Collection
from itertools import product
from math import inf, log

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.creep import CREEP
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE, is_rival
from flexspline.pipeline.diagnosis.measurement.holds import loaded_holds
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate, Search, owned_by
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.identification.plausible_sets import cancels_itself
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import less_fitted

MORE_OF_RIVAL = 3
"""Terms that a set with a rival in a cause's place may have more than the best set: another law takes two or
three elements for one."""


def rivals_of(
    evidence: GaussianEvidence, best: Candidate, cause: str
) -> tuple[tuple[str, ...], Candidate | None]:
    """Ids of other causes that, in the place of this one, explain the record as well.

    Or in the place of several: of all that another cause may be made of.
    """

    def without(owners: Collection[str]) -> tuple[int, ...]:
        return tuple(i for i in best.terms if evidence.terms[i].owner not in owners)

    present = {evidence.terms[i].owner for i in best.terms}
    others = {t.cause.id for t in evidence.terms if t.cause} - present
    beside: tuple[set[str], ...] = (set(),)
    if evidence.columns.ahead:  # behind the gap too it may stand beside a rival
        others -= {FRICTION}
        beside = (set(), {FRICTION})
    mine = penalised(evidence, best.terms)
    best_by_cause: dict[str, tuple[float, Candidate]] = {}
    for other, more in product(sorted(others), beside):
        allowed = {other, *more, *(p for p in present - {cause} if not p.startswith("?"))}
        if (cause, other) == (FRICTION, RATE):
            allowed.add(SERIES)  # a lag beside a spring is one Kelvin element
        if other in known_causes()[cause].made_of:
            allowed |= known_causes()[cause].made_of  # together they imitate it, one alone may not
        parts = known_causes()[other].made_of
        starts = [without({cause})]
        if cause in parts <= present:
            starts.append(without(parts))
        search = Search(evidence, owned_by(allowed))
        rival = search.run(starts, most=len(best.terms) + MORE_OF_RIVAL)
        if other not in rival.named(evidence) or cancels_itself(evidence, rival, other):
            continue
        if (cause, other) == (CREEP, RATE) and _is_chain(evidence, rival):
            continue
        fit = fit_regressors(evidence, rival.terms)
        if not known_causes()[other].plausible(fit.elements()[other], evidence.columns.rig):
            continue
        # a soft wind-up that ends below the least torque recorded: nobody can say that it is no gap
        if (cause, other) == (CLEARANCE, HARDENING) and _is_calibration(fit, other):
            continue
        gap = best.log_evidence_with_shapes(search) - rival.log_evidence_with_shapes(search)
        if is_rival(gap, mine - penalised(evidence, rival.terms)):
            best_by_cause[other] = min(
                best_by_cause.get(other, (inf, rival)), (gap, rival), key=lambda f: f[0]
            )
    order = sorted(best_by_cause, key=lambda other: best_by_cause[other][0])
    return tuple(order), (best_by_cause[order[0]][1] if order else None)


def _is_chain(evidence: GaussianEvidence, rival: Candidate) -> bool:
    """Whether lags of several times stand for creep with nothing held under load: together they are it."""
    lags = sum(evidence.terms[i].owner == RATE for i in rival.terms)
    return lags > 1 and not loaded_holds(evidence.columns.rig.history)


def _is_calibration(fit: SweepFit, owner: str) -> bool:
    """Whether the record shows nothing of an owner's effect but a change of zero, compliance and gap."""
    evidence = fit.evidence
    effect = evidence.whitened(fit.added(owner)[:, None])[:, 0]
    left = less_fitted(effect, evidence.base)
    return float(left @ left) / 2 < RIVAL_EVIDENCE


def penalised(evidence: GaussianEvidence, terms: tuple[int, ...]) -> float:
    """Log likelihood less ½ log n for each amplitude.

    The calibration counts by its stated uncertainty, which is known as the rows are: an explanation that
    needs a compliance or a gap far beyond it does not explain the record as well.
    """
    fit = fit_regressors(evidence, terms).posterior
    count = len(fit.mean) - fit.base_count
    return -fit.misfit(evidence) / 2 - count * log(max(evidence.rows, 2)) / 2
