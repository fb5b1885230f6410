"""The race of explanations of specimens: single parameters and pairs, by their evidence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import logsumexp

from flexspline.pipeline.diagnosis.specimens.evidence import LaplaceFit, SpecimenData, fit
from flexspline.pipeline.diagnosis.specimens.parameters import SpecimenParameter

SECOND_FROM = 7
"""Best single terms of which pairs are made, besides every named one. Judgement."""


@dataclass(frozen=True)
class SpecimenRace:
    """All fits, the likeliest first. `null`: log evidence of the simulation within its uncertainty."""

    data: SpecimenData
    fits: tuple[LaplaceFit, ...]
    null: float
    null_fit: LaplaceFit


def race(data: SpecimenData, terms: Sequence[SpecimenParameter]) -> SpecimenRace:
    """Single terms, and pairs of what did best or has a name.

    The null is the simulation with its modulus calibrated and at most one dimension within its
    general tolerance.
    """
    empty = fit(data, ())
    singles = {id(t): fit(data, (t,)) for t in terms}
    within = [f for t, f in ((t, singles[id(t)]) for t in terms) if t.within]
    null = float(
        np.logaddexp(empty.score, logsumexp([f.score for f in within]) if within else -np.inf)
    )
    ranked = sorted(terms, key=lambda t: -singles[id(t)].score)
    chosen = ranked[:SECOND_FROM]
    top = [t for t in terms if t.named and t.kind != "geometry" and t not in chosen]
    fits = [empty, *singles.values()]
    spare = len(data.log_compliance) - 3  # two terms, the modulus and some noise must be seen
    for a, b in combinations([*chosen, *top], 2):
        if a.owner == b.owner or spare < 1:
            continue
        fits.append(fit(data, (a, b)))
    return SpecimenRace(data, tuple(sorted(fits, key=lambda f: -f.score)), null, empty)
