"""Whether the gap follows the temperature late, and the uncertainty of its size by that."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.thermal_clearance import COLDER, STAGES, THERMAL, WARMER
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification


@dataclass(frozen=True)
class ThermalLag:
    """Lags that stand in the model.

    Attributes
    ----------
    lags_s : of each element that has one, shortest first. stages : of thermal masses, one behind the other.
    warmer_K : by which the gear was warmer than the sensor when the record began; negative: colder.
    shown : whether the record is explained much worse without a lag.
    """

    lags_s: tuple[float, ...]
    stages: int
    warmer_K: float
    shown: bool


def thermal_lag(identified: Identification) -> ThermalLag | None:
    """The lag of the gap behind the temperature; None where the model has none."""
    if THERMAL not in identified.named:
        return None
    shapes = [e.shape for e in identified.fit.elements()[THERMAL] if e.shape["lag_s"] > 0]
    if not shapes:
        return None
    without = [c for c in _other_sets(identified) if _is_at_once(identified, c)]
    shown = all(identified.best.score - c.score > RIVAL_EVIDENCE for c in without)
    return ThermalLag(
        tuple(sorted(s["lag_s"] for s in shapes)),
        int(max(s.get(STAGES, 1) for s in shapes)),
        sum(s.get(WARMER, 0.0) - s.get(COLDER, 0.0) for s in shapes),
        shown,
    )


def lag_std(identified: Identification, magnitude: float) -> float:
    """Standard deviation of a thermal gap's size, by the sizes that other lags, and no lag, give it.

    Root mean square difference from the best set's. Each counts by its score, over all that were tried of one
    element, the rest of the best set as it is.
    """
    evidence, others = identified.search.evidence, list(_other_sets(identified))
    weight = np.exp([min(c.score - identified.best.score, 0.0) for c in others])
    size = np.array([fit_regressors(evidence, c.terms).magnitudes()[THERMAL] for c in others])
    return float(np.sqrt(weight @ (size - magnitude) ** 2 / (1 + weight.sum())))


def _other_sets(identified: Identification) -> Iterator[Candidate]:
    """The best set with another element in the place of all that follow temperature, each that was evaluated
    before any was tuned."""
    evidence, terms = identified.search.evidence, identified.best.terms
    rest = tuple(i for i in terms if evidence.terms[i].owner != THERMAL)
    for i, term in enumerate(evidence.terms[: evidence.columns.tuned_from]):
        if term.owner == THERMAL and i not in terms:
            yield identified.search.candidate((*rest, i))


def _is_at_once(identified: Identification, c: Candidate) -> bool:
    terms = identified.search.evidence.terms
    return all(terms[i].shape["lag_s"] == 0 for i in c.terms if terms[i].owner == THERMAL)
