"""Whether what grows over a record, wear or drift, grows at another rate at its end than at its start."""

from __future__ import annotations

from typing import Literal

from flexspline.pipeline.diagnosis.causes.cause import Shape
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit

Growth = Literal["levels_off", "slows_down", "accelerates"]
SETTLING = ("run_in_cycles", "settling_s")
"""Parameters of a law that comes to rest."""


def growth_of(fit: SweepFit, cause: str) -> Growth | None:
    """How the rate of wear or drift changes; None where even growth explains the record as well.

    The exponent of even growth is fitted too, and is never just 1.
    """
    owners = [t.owner for t in fit.evidence.terms]
    shapes = [t.shape for t in fit.regressors if t.owner == cause]
    even = [i for i, t in enumerate(fit.evidence.terms) if owners[i] == cause and _is_even(t.shape)]
    search = Search(fit.evidence, lambda term: False)
    rest = [i for i in fit.posterior.terms if owners[i] != cause]
    now = search.candidate(fit.posterior.terms).log_evidence
    if any(now - search.candidate((*rest, i)).log_evidence < RIVAL_EVIDENCE for i in even):
        return None
    if any(s.get(key, 0.0) > 0 for s in shapes for key in SETTLING):
        return "levels_off"
    if any(s["exponent"] < 1 for s in shapes):
        return "slows_down"
    return "accelerates" if any(s["exponent"] > 1 for s in shapes) else None


def _is_even(shape: Shape) -> bool:
    return shape["exponent"] == 1.0 and not any(shape.get(key, 0.0) for key in SETTLING)
