"""Uncertainty of hardening's and friction's sizes because no row shows where friction takes its torque.

Friction found behind the gap adds twist in proportion to its torque. Where it takes that torque before it
reaches the soft wind-up, the wind-up's own slope stands in the place of the mean one: the loop is wider where
the gear is softer, at small torque, and the fit makes hardening of a part of that.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import column_indices

SLOPE_SHARE = 1e-3
"""Of the largest torque, to either side, for the wind-up's slope: a hundredth of its narrowest knee."""
LEAST_OTHER_SIDE = 0.15
"""Torque is on both sides of zero where the smaller side has more than this share of the larger: a loop
closes within some percent of its turn, and noise is less."""
EVEN_ODDS = 0.5
"""Probability that friction acts before the wind-up, and not beside it: even odds."""


def hardening_std(fit: SweepFit) -> float:
    """Of the hardening's size, by friction's place; 0 where friction lies ahead of the gap, or there is none.

    To first order: what the other place would add to the angle is fitted by the set as it is, and moves the
    size by so much or, with even odds, not at all.
    """
    if not _place_open(fit):
        return 0.0
    evidence = fit.evidence
    other = evidence.whitened((fit.added(FRICTION) * _softer(fit))[:, None])[:, 0]
    posterior = fit.posterior
    at = column_indices(evidence, posterior.terms)
    scale = np.concatenate([np.ones(posterior.base_count), evidence.scale[at]])
    model = np.hstack([evidence.base, evidence.x[:, at]]) / scale
    moved = posterior.covariance @ (model.T @ other)
    return EVEN_ODDS**0.5 * abs(float(fit.magnitude_slopes()[HARDENING] @ moved))


def width_share_std(fit: SweepFit) -> float:
    """Of friction's size, as a share of it, by friction's place, where torque stays on one side of zero.

    The loop at T = 0 is then told by loops elsewhere. Friction before the wind-up, or in parallel with it,
    makes it wider there by as much as the gear is softer, about by the hardening's ratio, or, with even odds,
    not at all. Where torque reaches both sides of zero the rows next to it show the width.
    """
    torque = fit.rig.history.torque_Nm[fit.evidence.kept]
    least, most = sorted([max(0.0, float(torque.max())), max(0.0, -float(torque.min()))])
    if not _place_open(fit) or least > LEAST_OTHER_SIDE * most:
        return 0.0
    return EVEN_ODDS**0.5 * abs(fit.magnitudes()[HARDENING] - 1)


def _place_open(fit: SweepFit) -> bool:
    """Whether friction lies beside hardening, and not ahead of the gap."""
    return fit.evidence.columns.ahead is None and {FRICTION, HARDENING} <= set(fit.elements())


def _softer(fit: SweepFit) -> np.ndarray:
    """(n,) slope of the hardening's own twist, over the measured compliance."""
    history, cause = fit.rig.history, known_causes()[HARDENING]
    step = SLOPE_SHARE * fit.rig.largest_Nm
    either = [
        cause.angle_arcsec(
            fit.elements()[HARDENING], replace(history, torque_Nm=history.torque_Nm + side * step)
        )
        for side in (1, -1)
    ]
    return (either[0] - either[1]) / (2 * step) / fit.measured_rig().compliance
