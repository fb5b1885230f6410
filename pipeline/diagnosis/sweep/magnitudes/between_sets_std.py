"""How far other sets of terms, which explain a record about as well, leave a cause's size open."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification


def std_over(
    identified: Identification, others: Iterable[Candidate], cause: str, magnitude: float
) -> float:
    """Root mean square of how far each set leaves the size, 0 of the best one's; each counts by its score."""
    evidence, best = identified.search.evidence, identified.best
    found = list(others)
    weight = np.exp([min(c.score - best.score, 0.0) for c in found])
    size = np.array([fit_regressors(evidence, c.terms).magnitudes()[cause] for c in found])
    return float(np.sqrt(weight @ (size - magnitude) ** 2 / (1 + weight.sum())))
