"""Whether a drift of the angle reading may as well be a zero that follows the temperature.

Where the temperature goes one way while the record runs, it is a clock. No cause has that zero's name, so it
is no rival in the race; the drift is then said with both words.
"""

from __future__ import annotations

from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.decision import is_rival
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.identification import Identification
from flexspline.pipeline.diagnosis.sweep.rivals import penalised

ZERO = UnnamedForm("changing_zero")
"""Of the channel temperature, the only one that has it."""


def may_follow_temperature(identified: Identification) -> bool:
    """Whether a zero that changes with temperature, in the drift's place, is a rival as causes are."""
    evidence, best, search = identified.search.evidence, identified.best, identified.search
    rest = tuple(i for i in best.terms if evidence.terms[i].owner != DRIFT)
    mine, likelihood = best.log_evidence_with_shapes(search), penalised(evidence, best.terms)
    for i, term in enumerate(evidence.terms):
        if term.form != ZERO or i in best.terms:
            continue
        other = search.candidate((*rest, i))
        behind = mine - other.log_evidence_with_shapes(search)
        if is_rival(behind, likelihood - penalised(evidence, other.terms)):
            return True
    return False
