"""Whether creep explains what a lag explains in a record without holds.

Creep is no term of the race there, as no hold shows how it goes on. Kelvin elements of many retardation times
then look like a lag beside a spring or a little friction.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from flexspline.pipeline.diagnosis.causes.creep import PER_DECADE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s
from flexspline.pipeline.diagnosis.measurement.torque_jitter import by_known_ways
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification

SHORTEST = (0.003, 0.03, 0.3)
"""Shortest retardation times that are tried, over a ramp's time: a decade apart, as of `causes/creep.py`."""
EXPONENTS = (0.0, 0.3)
"""Of the weight of a retardation time: logarithm, and near Andrade's t^⅓."""
LONGEST = 10.0
"""Longest retardation time, over the record's duration: it goes on to creep."""


def creep_explains(identified: Identification) -> bool:
    """Whether a set with creep in place of the lag, and its spring or friction, is not clearly worse."""
    evidence, best = identified.search.evidence, identified.best
    old, history = evidence.columns, evidence.columns.rig.history
    lag = next((i for i in best.terms if evidence.terms[i].owner == RATE), None)
    ramp = ramp_s(history)
    if lag is None or old.ahead is not None or holds(history) or ramp == 0:
        return False
    like = evidence.terms[lag]
    kept, long = evidence.kept, LONGEST * old.rig.duration_s
    torque = by_known_ways(history)
    made = []
    for low, power in product(SHORTEST, EXPONENTS):
        count = 1 + round(PER_DECADE * np.log10(long / (low * ramp)))
        times = np.geomspace(low * ramp, long, count)
        made.append(lags(torque, history, times) @ (times / ramp) ** power)
    size = rms(old.all[kept][:, like.at])
    for without in ({RATE}, {RATE, SERIES}, {RATE, FRICTION}, {RATE, FRICTION, SERIES}):
        beside = [evidence.terms[i] for i in best.terms if evidence.terms[i].owner not in without]
        columns = old.with_terms(
            [*beside, *[like] * len(made)],
            [
                *(old.all[:, t.at] for t in beside),
                *(m[:, None] / rms(m[kept]) * size for m in made),
            ],
        )
        search = Search(gaussian_evidence(columns, evidence.target, kept, evidence.noise))
        others = range(len(beside))
        creeps = range(len(beside), len(columns.terms))
        scores = [search.candidate([*others, k]).score for k in creeps]
        if best.score - max(scores) < RIVAL_EVIDENCE:
            return True
    return False
