"""Sizes of two causes that share one effect: each may have all of it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import sqrt

from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search, owned_by
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification


def shared_std(
    identified: Identification, cause: str, magnitude: Mapping[str, float], rivals: Collection[str]
) -> float:
    """Of a cause's size beside its own rival: the distance to what it is without that one, at even odds.

    0 where no rival stands in the best set. How the effect is shared out between the two is the choice of
    their shapes, which no row tells apart.
    """
    evidence, best = identified.search.evidence, identified.best
    off = [0.0]
    for rival in sorted({*rivals} & {*identified.named} - {cause}):
        start = [i for i in best.terms if evidence.terms[i].owner != rival]
        alone = Search(evidence, owned_by(best.owners - {rival})).run([start])
        sizes = fit_regressors(evidence, alone.terms).magnitudes()
        if cause in sizes:
            off.append(abs(sizes[cause] - magnitude[cause]))
    return max(off) / sqrt(2)
