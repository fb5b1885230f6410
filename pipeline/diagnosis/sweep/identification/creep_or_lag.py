"""Whether creep explains what a lag explains, or a lag what creep does, in a record without holds under load.

Creep is no term of the race without holds, as no hold shows how it goes on. Kelvin elements of many
retardation times then look like a lag beside a spring or a little friction. Where the torque rests at zero
alone, creep is one; a single Kelvin element is a lag then, of whatever time, also beyond those of the race.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from flexspline.pipeline.diagnosis.causes.creep import CREEP, PER_DECADE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE
from flexspline.pipeline.diagnosis.measurement.holds import loaded_holds
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
SHORTEST_LAG, LAGS, ZOOMS = 0.05, 16, 3
"""Shortest time of a lag over a ramp's; times tried at once, by equal factors up to the longest; and how
often about the best of them, a fourth as far apart each time: they are then 1 % apart."""


def creep_explains(identified: Identification) -> bool:
    """Whether a set with creep in place of the lag, and its spring or friction, is not clearly worse."""
    if not _may_be_other(identified, RATE):
        return False
    rig = identified.search.evidence.columns.rig
    torque, ramp, long = by_known_ways(rig.history), ramp_s(rig.history), LONGEST * rig.duration_s
    made = []
    for low, power in product(SHORTEST, EXPONENTS):
        count = 1 + round(PER_DECADE * np.log10(long / (low * ramp)))
        times = np.geomspace(low * ramp, long, count)
        made.append(lags(torque, rig.history, times) @ (times / ramp) ** power)
    return _is_rival(identified, _scores(identified, RATE, made))


def lag_explains(identified: Identification) -> bool:
    """Whether a set with one Kelvin element in place of creep, and its spring, is not clearly worse."""
    if not _may_be_other(identified, CREEP):
        return False
    rig = identified.search.evidence.columns.rig
    torque = by_known_ways(rig.history)
    times = np.geomspace(SHORTEST_LAG * ramp_s(rig.history), LONGEST * rig.duration_s, LAGS)
    factor = times[1] / times[0]
    for _ in range(1 + ZOOMS):
        scores = _scores(identified, CREEP, [*lags(torque, rig.history, times).T])
        if _is_rival(identified, scores):
            return True
        factor = factor ** (1 / 4)
        times = times[scores.argmax()] * factor ** np.arange(-4.0, 5.0)
    return False


def _may_be_other(identified: Identification, cause: str) -> bool:
    """Whether a cause is in the best set, and no hold under load tells it from the other one."""
    columns = identified.search.evidence.columns
    history = columns.rig.history
    there = cause in identified.best.owners
    return there and columns.ahead is None and not loaded_holds(history) and ramp_s(history) > 0


def _is_rival(identified: Identification, scores: np.ndarray) -> bool:
    return bool(identified.best.score - scores.max() < RIVAL_EVIDENCE)


def _scores(identified: Identification, cause: str, made: Sequence[np.ndarray]) -> np.ndarray:
    """(m,) best score with each column (n,) in place of a cause, with that one's prior.

    A spring and friction beside it may go too.
    """
    evidence, best = identified.search.evidence, identified.best
    old, kept = evidence.columns, evidence.kept
    like = next(evidence.terms[i] for i in best.terms if evidence.terms[i].owner == cause)
    size = rms(old.all[kept][:, like.at])
    scores = []
    for without in ({cause}, {cause, SERIES}, {cause, FRICTION}, {cause, FRICTION, SERIES}):
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
        each = range(len(beside), len(columns.terms))
        scores.append([search.candidate([*others, k]).score for k in each])
    return np.max(scores, axis=0)
