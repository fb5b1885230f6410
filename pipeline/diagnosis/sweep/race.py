"""The race on a prepared sweep: noise estimated anew from the best set, shapes tuned, causes decided."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.noise import (
    estimated,
    isolated_outliers,
    stretches_of,
)
from flexspline.pipeline.diagnosis.sweep.decision import Decision, decide
from flexspline.pipeline.diagnosis.sweep.evidence import (
    GaussianEvidence,
    gaussian_evidence,
    with_shapes,
)
from flexspline.pipeline.diagnosis.sweep.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.row_selection import naming_rows
from flexspline.pipeline.diagnosis.sweep.search import Candidate, Search
from flexspline.pipeline.diagnosis.sweep.shape_tuning import tuned

ROUNDS = 1
"""Of noise estimated from what the best set leaves."""
TUNINGS, KINDS = 3, 3


def explain(prepared: PreparedSweep) -> tuple[PreparedSweep, Decision]:
    """Race, with the noise estimated anew from what the best set leaves, and shapes tuned."""
    for _ in range(ROUNDS):
        now = _tuned_race(_race(prepared))
        best = Search(now).run()
        left = fit_regressors(now, best.terms).residual()
        prepared = replace(_with_noise(prepared, left, len(best.terms)), columns=now.columns)
    now = _tuned_race(_race(prepared))
    return replace(prepared, columns=now.columns), decide(now, prepared.offset_Nm != 0.0)


def _tuned_race(now: GaussianEvidence) -> GaussianEvidence:
    """The race with tuned shapes: of the best named set, of each cause alone, of the best of all.

    Named causes are tuned before any competitor is let in: a shape from a coarse grid leaves a
    misfit, which a competitor would fill.
    """
    named = Search(now, lambda t: t.cause is not None)
    best = named.run()
    for _ in range(TUNINGS):
        sets = [best.terms, *_alone(named, best)]
        shapes = [pair for terms in sets if terms for pair in tuned(now, terms).shapes]
        wider = with_shapes(now, shapes)
        if wider is now:
            break
        now = wider
        named = Search(now, lambda t: t.cause is not None)
        before, best = best.score, named.run([best.terms, ()])
        if best.score < before + 1.0:
            break
    return now


def _alone(search: Search, best: Candidate) -> list[tuple[int, ...]]:
    """Sets of one cause alone that explain a good part of what the best set does.

    The best set of each cause, and its best few single shapes of different kinds: which kind is best
    may change once each is tuned.
    """
    evidence = search.evidence
    enough = 0.5 * best.log_evidence
    found = {
        c.terms for owners, c in search.best.items() if len(owners) == 1 and c.log_evidence > enough
    }
    kinds: dict[str, dict[tuple[float, ...], Candidate]] = {}
    for c in sorted(search.tried, key=lambda c: -c.log_evidence):
        if len(c.terms) != 1 or c.log_evidence < enough:
            continue
        term = evidence.terms[c.terms[0]]
        assert term.cause is not None
        kind = tuple(v for k, v in sorted(term.shape.items()) if k not in term.cause.tunable)
        mine = kinds.setdefault(term.owner, {})
        if len(mine) < KINDS:
            mine.setdefault(kind, c)
    found |= {c.terms for mine in kinds.values() for c in mine.values()}
    return sorted(found - {best.terms})


def _race(prepared: PreparedSweep) -> GaussianEvidence:
    return gaussian_evidence(prepared.columns, prepared.target, prepared.kept, prepared.noise)


def _with_noise(prepared: PreparedSweep, left: np.ndarray, used: int) -> PreparedSweep:
    history = prepared.rig.history
    inside = naming_rows(history, prepared.band_Nm)
    spread = 1.4826 * float(np.median(np.abs(left[inside & ~prepared.outlier])))
    outlier = np.zeros(len(left), bool)
    outlier[inside] = isolated_outliers(left[inside], history.rows(inside), spread + 1e-9)
    kept = inside & ~outlier
    noise = estimated(left[kept], stretches_of(history, kept), prepared.rows_per_cycle, used + 3)
    return replace(prepared, noise=noise, kept=kept, outlier=outlier)
