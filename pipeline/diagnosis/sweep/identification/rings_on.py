"""Whether ringing found beside a loop goes on after its first wave.

Friction or a lag of a form that no element has leaves its largest misfit where torque turns, as ringing
does. The misfit is one hump: it follows the torque until the loop is closed. A rig that rings swings again,
and the second wave is as large as the damping leaves it. So of the waves fitted the part after the first
period of each is given an amplitude of its own: that of ringing is 1, and that of a misfit anything.
"""

from __future__ import annotations

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.measurement.corners import corners_of
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import Regressor

LEAST_LATE = 0.5
"""Of what the waves fitted have after their first period. Damping of 0.2 leaves, beside the most that is
tried, 0.12, 0.6 of it; made-up friction had −0.6 to 0.4."""
LEAST_SHARE, LARGEST_MISFIT = 0.05, 0.5
"""Of a loop's rms. Waves below the first may be its misfit even if they go on, as a misfit of any form does
that three waves fit: 0.02 to 0.05 in made-up records of friction that changes, 0.058 and more in 13 of 14 of
friction with ringing of 0.08 and more of it. A loop's form is never missed by the second, by judgement."""
LATE_SIGMAS = 3.0
"""Deviations by which that amplitude must differ from none: as of a cause's size."""


def is_ringing(term: Regressor) -> bool:
    """Whether a term is a damped wave after the corners of torque."""
    return term.form is not None and term.form.kind == "rings"


def rings_on(evidence: GaussianEvidence, best: Candidate) -> bool:
    """Whether a set's ringing is more than the misfit of a loop beside it; True where it has no such two."""
    terms = [evidence.terms[i] for i in best.terms]
    if not any(map(is_ringing, terms)):
        return True
    fit = fit_regressors(evidence, best.terms)
    since = _since_corner_s(evidence.columns.rig.history)
    waves, late = np.zeros(len(since)), np.zeros(len(since))
    loops = np.zeros(len(since))
    for term, amplitudes in zip(terms, fit.posterior.amplitudes(evidence), strict=True):
        added = evidence.columns.all[:, term.at] @ amplitudes
        if is_ringing(term):
            assert term.form is not None
            assert term.form.period_s is not None
            waves += added
            late += np.where(since > term.form.period_s, added, 0.0)
        elif _opens_loop(term):
            loops += added
    if evidence.columns.ahead is not None:
        loops += fit.added(FRICTION)
    kept = evidence.kept
    share = rms(waves[kept]) / max(rms(loops[kept]), ABOVE_ZERO)
    if not LEAST_SHARE < share < LARGEST_MISFIT:
        return share > LEAST_SHARE
    amplitude, std = _amplitude_of_late(fit, waves - late, late)
    return amplitude > max(LEAST_LATE, LATE_SIGMAS * std)


def _opens_loop(term: Regressor) -> bool:
    changing = term.form is not None and term.form.kind == "changing_loop"
    return changing or term.owner in (FRICTION, RATE)


def _since_corner_s(history: History) -> np.ndarray:
    """(n,) time since the last corner of torque in each unit, 0 before the first."""
    assert history.time_s is not None
    since, corners = np.zeros(len(history)), corners_of(history)
    for unit, rows in enumerate(history.unit_slices):
        times = np.sort([c.time_s for c in corners if c.unit == unit])
        if not len(times):
            continue
        time = history.time_s[rows]
        last = np.searchsorted(times, time, side="right") - 1
        since[rows] = np.where(last < 0, 0.0, time - times[np.maximum(last, 0)])
    return since


def _amplitude_of_late(fit: SweepFit, early: np.ndarray, late: np.ndarray) -> tuple[float, float]:
    """Amplitude of the later waves (n,) beside the early ones and all else that is fitted, and its deviation.

    0 where there are none.
    """
    evidence = fit.evidence
    if not late[evidence.kept].any():
        return 0.0, 0.0
    others = [t for t in fit.regressors if not is_ringing(t)]
    waves = evidence.whitened(np.column_stack([early, late]))
    x, inverse = evidence.base_with([*(evidence.x[:, t.at] for t in others), waves])
    inverse[-2:] = 0.0  # of unknown size
    covariance = np.linalg.pinv(x.T @ x + np.diag(inverse))
    return float((covariance @ (x.T @ evidence.y))[-1]), float(np.sqrt(covariance[-1, -1]))
