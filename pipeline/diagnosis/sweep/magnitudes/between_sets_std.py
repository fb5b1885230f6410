"""Uncertainty of a cause's size because other sets of terms explain a record about as well."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification


def std_over(
    identified: Identification, others: Iterable[Candidate], cause: str, magnitude: float
) -> float:
    """Root mean square difference of each set's size from the best set's, weighted by the sets' scores."""
    evidence, best = identified.search.evidence, identified.best
    found = list(others)
    weight = np.exp([min(c.score - best.score, 0.0) for c in found])
    size = np.array([fit_regressors(evidence, c.terms).magnitudes()[cause] for c in found])
    return float(np.sqrt(weight @ (size - magnitude) ** 2 / (1 + weight.sum())))
