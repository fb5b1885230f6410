"""Sizes beside a lag that may be longer than those of the race: at one rate the record hardly shows how long.

The twist that lags by a cycle or more goes by as c·∫T/τ dt. Its compliance c and its time τ are known by how
the record begins, and by what the design states of the compliance.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import with_shapes
from flexspline.pipeline.diagnosis.sweep.magnitudes.other_fits import OtherFits, odds

SHORTEST, LONGEST, TIMES = 0.5, 16.0, 16
"""Over the longest lag found, and over the longest of the race, in even steps of their logs. Of
lags of four times the race's longest and more, only a parabola is left within a cycle. Judgement."""


@once
def long_lags(fit: SweepFit) -> OtherFits:
    """The same record with one lag of another time in the place of those found, and of a drift beside them.

    No fits where no lag was found, or where torque is held.
    """
    lags = [t for t in fit.regressors if t.owner == RATE and "longest_s" in t.shape]
    if not lags:
        return OtherFits()
    longest = max(lags, key=lambda t: t.shape["lag_s"])
    ends = SHORTEST * longest.shape["lag_s"], LONGEST / 4 * longest.shape["longest_s"]
    shapes = [
        {**longest.shape, "lag_s": float(s), "exponent": 1.0} for s in np.geomspace(*ends, TIMES)
    ]
    evidence = with_shapes(fit.evidence, [(longest, shape) for shape in shapes])
    search = Search(evidence, lambda term: False)
    now = search.candidate(fit.posterior.terms).log_evidence
    likely: dict[tuple[int, ...], float] = {}
    for less in ({RATE}, {RATE, DRIFT}):
        rest = [i for i in fit.posterior.terms if evidence.terms[i].owner not in less]
        for i in range(len(fit.evidence.terms), len(evidence.terms)):
            likely[(*rest, i)] = odds(search.candidate((*rest, i)).log_evidence - now)
    fits = [fit_regressors(evidence, terms) for terms in likely]
    # amplitudes that would release energy are none
    good = [k for k, other in enumerate(fits) if other.posterior.mean[-1] > 0]
    values = list(likely.values())
    total = 1.0 + sum(values[k] for k in good)
    return OtherFits(tuple(fits[k] for k in good), tuple(values[k] / total for k in good))
