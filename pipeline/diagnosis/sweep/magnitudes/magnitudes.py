"""Magnitudes of the named causes and their standard deviations, by all sets that explain the record."""

from __future__ import annotations

from math import hypot

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.causes.thermal_clearance import THERMAL
from flexspline.pipeline.diagnosis.decision import weights
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
)
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification
from flexspline.pipeline.diagnosis.sweep.identification.leakage import effect_size
from flexspline.pipeline.diagnosis.sweep.magnitudes.friction_place import (
    hardening_std,
    width_share_std,
)
from flexspline.pipeline.diagnosis.sweep.magnitudes.long_lags import long_lags
from flexspline.pipeline.diagnosis.sweep.magnitudes.other_fits import SHAPE_NATS
from flexspline.pipeline.diagnosis.sweep.magnitudes.soft_ends import soft_ends
from flexspline.pipeline.diagnosis.sweep.magnitudes.spring_changes import spring_std
from flexspline.pipeline.diagnosis.sweep.magnitudes.thermal_lag import lag_std

FEWEST_WEIGHT_LOGS = 6.0
"""Sets with a weight below e^−6 = 0.25 % are left out."""
NEAR_ZERO = 0.15
"""Share of the largest torque. Rows within it show the width of a loop at T = 0, whatever shape was found.
Judgement."""
MOST_SHAPES = 24
"""Most of these sets, the likeliest ones. Each is fitted again for its standard deviation. Judgement: it
limits the time."""


def magnitudes(identified: Identification) -> tuple[dict[str, float], dict[str, float]]:
    """Magnitude of each named cause and its standard deviation, doubt of the shapes included."""
    evidence = identified.search.evidence
    names = identified.best.named(evidence)
    fits, weight = fits_alike(identified)
    each = [fit.magnitudes() for fit in fits]
    doubt = identified.size_doubt
    best = doubt.magnitude
    std = {}
    for cause in identified.named:
        values = np.array([m[cause] for m in each])
        # their mean distance: one set far off does not make it as wide
        spread = float(weight @ np.abs(values - best[cause]))
        std[cause] = hypot(doubt.std[cause], spread)
    if HARDENING in std:
        std[HARDENING] = hypot(std[HARDENING], hardening_std(identified.fit))
    if THERMAL in std:
        std[THERMAL] = hypot(std[THERMAL], lag_std(identified, best[THERMAL]))
    if SERIES in std:
        of_laws = 100 * spring_std(identified.fit) / identified.fit.rig.prediction.compliance
        std[SERIES] = hypot(std[SERIES], of_laws)
    for others in (soft_ends(identified.fit), long_lags(identified.fit)):
        std = {c: hypot(own, others.deviation(best[c], c)) for c, own in std.items()}
    # a loop in proportion to load has no width at T = 0 by its shape alone; ahead of the teeth there is none
    if FRICTION in std and FRICTION in names:
        std[FRICTION] = max(std[FRICTION], _width_std_arcsec(evidence))
        by_place = width_share_std(identified.fit) * best[FRICTION]
        std[FRICTION] = hypot(std[FRICTION], by_place)
    return best, std


@once
def fits_alike(identified: Identification) -> tuple[list[SweepFit], np.ndarray]:
    """Fits of the sets of the same causes by any shapes, the best one's among them; how much each counts."""
    evidence = identified.search.evidence
    names = identified.best.named(evidence)
    alike = sorted(
        {
            c.terms: c
            for c in (*identified.search.tried, identified.best)
            if c.named(evidence) == names
            and c.score <= identified.best.score  # others were refused
        }.values(),
        key=lambda c: -c.score,
    )[:MOST_SHAPES]
    nats = _shape_nats(identified)
    alike = [c for c in alike if c.score > identified.best.score - FEWEST_WEIGHT_LOGS * nats]
    fits = [fit_regressors(evidence, c.terms) for c in alike]
    return fits, weights([c.score / nats for c in alike])


def _width_std_arcsec(evidence: GaussianEvidence) -> float:
    """Standard deviation of a loop's width at T = 0 by the rows next to it: a difference of two means, each
    of half of the rows."""
    history = evidence.columns.rig.history
    near = np.abs(history.torque_Nm) < NEAR_ZERO * history.largest_Nm
    rows = max(1, int((near & evidence.kept).sum()))
    return 2 * evidence.noise.std_arcsec / rows**0.5


def _shape_nats(identified: Identification) -> float:
    """Nats by which one set of shapes is better than another, though neither is the gear's.

    What a law leaves of its best shape, a share s of its length L in the noise's deviations, is worth
    (s·L)²/2.
    """
    doubts = [
        known_causes()[c].shape_doubt * effect_size(identified.fit, c) for c in identified.named
    ]
    return max(SHAPE_NATS, float(np.square(doubts).sum()) / 2)
