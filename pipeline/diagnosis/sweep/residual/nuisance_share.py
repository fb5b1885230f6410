"""What the causes explain by themselves, and what the terms without a name explain after them.

An effect that no cause explains may be shared out between a large cause and a nuisance term that takes most
of it back: the cause's own rms is then no measure of what it explains. Here the causes come first and have
all that they can get (sequential sums of squares: Draper, Smith, Applied Regression Analysis, 3rd ed. (1998),
chapter 6).
"""

from __future__ import annotations

from collections.abc import Collection
from math import sqrt

from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import posterior_of
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification

LEAST_CHI_SQUARE = 1e-9
"""[χ²] Causes that explain less explain nothing: rounding."""


def unnamed_share(identified: Identification, attributed: Collection[str]) -> float:
    """Rms that terms of owners beside the `attributed` explain after the causes, of what these explain first.

    0 where the best set has no such terms. 0 too with friction ahead of the teeth, whose torque is not the
    one read: without it there is no fit to compare with.
    """
    evidence, best = identified.search.evidence, identified.best.terms
    causes = [i for i in best if evidence.terms[i].owner in {*identified.named, *attributed}]
    if not causes or len(causes) == len(best) or evidence.columns.ahead is not None:
        return 0.0
    none, named, whole = (
        posterior_of(evidence, terms).misfit(evidence) for terms in ((), causes, best)
    )
    return sqrt(max(named - whole, 0.0) / max(none - named, LEAST_CHI_SQUARE))
