"""Whether a drift of the angle reading may instead be a zero that follows the temperature, at once or late.

Where the temperature goes one way while the record runs, it is a clock. No cause has that zero's name, so it
is no rival in the race; the drift is then said with both words.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.decision import is_rival
from flexspline.pipeline.diagnosis.measurement.temperature import temperature_without_noise
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    with_terms,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import Regressor
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification
from flexspline.pipeline.diagnosis.sweep.identification.rivals import penalised
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import to_one

ZERO = UnnamedForm("changing_zero")
LATEST, LATE_LAGS = (0.01, 1.0), 25
"""Of the record, by which the gear warms later than the sensor; and how many lags are tried, a fifth apart:
between two of them a zero that follows a rise is off by less than 1 %."""


def may_follow_temperature(identified: Identification) -> bool:
    """Whether a zero that changes with temperature, in the drift's place, is a rival as causes are."""
    best, search = identified.best, identified.search
    mine = best.log_evidence_with_shapes(search)
    likelihood = penalised(search.evidence, best.terms)
    evidence = _with_late_zeros(search.evidence)
    again = Search(evidence)
    rest = tuple(i for i in best.terms if evidence.terms[i].owner != DRIFT)
    for i, term in enumerate(evidence.terms):
        if not _follows(term) or i in best.terms:
            continue
        other = again.candidate((*rest, i))
        behind = mine - other.log_evidence_with_shapes(again)
        if is_rival(behind, likelihood - penalised(evidence, other.terms)):
            return True
    return False


def _follows(term: Regressor) -> bool:
    """Whether a term is a zero that changes with temperature."""
    return term.channel == "temperature_C" and term.form == ZERO


def _with_late_zeros(evidence: GaussianEvidence) -> GaussianEvidence:
    """The race with zeros that follow the temperature late, where it has one that follows it at once."""
    rig = evidence.columns.rig
    like = next((t for t in evidence.terms if _follows(t) and t.width == 1), None)
    if like is None or rig.duration_s <= 0:
        return evidence
    constants = np.geomspace(*LATEST, LATE_LAGS) * rig.duration_s
    late = lags(temperature_without_noise(rig.history), rig.history, constants)
    late = to_one(late - late.mean(axis=0))
    return with_terms(
        evidence,
        [replace(like, shape={"lag_s": float(c)}) for c in constants],
        np.hsplit(late, LATE_LAGS),
    )
