"""Whether a soft wind-up may be the soft ends of a gap: teeth that take up their load one after another.

Where a wind-up is over within a tenth of the torque, both are one curve. How much of it is gap is then a
word's choice, and no row's.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate, Search
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    with_terms,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import Regressor
from flexspline.pipeline.diagnosis.sweep.identification.leakage import effect_size
from flexspline.pipeline.diagnosis.sweep.magnitudes.other_fits import SHAPE_NATS, OtherFits, odds

NARROWEST, WIDEST, WIDTHS = 0.01, 0.1, 24
"""Shares of the largest torque, in even steps of their logs. Narrower ends lie in the crossing, of which no
row counts; a law that is wider is a wind-up (`../../causes/stiffness_hardening.py`, its limits)."""
MOST_OF_GAP = 1.05
"""Of the gap, by which its ends may be softer than sharp: all of it, but for the noise. Judgement."""
CURVES = ("?torque_Nm", "?angle_arcsec")
"""Owners of terms without a name that stand in for a bend near zero torque."""
WITHOUT = tuple(
    frozenset(owners)
    for owners in (
        {HARDENING},
        {HARDENING, CLEARANCE},
        {HARDENING, *CURVES},
        {HARDENING, CLEARANCE, *CURVES},
    )
)
"""Owners that soft ends may replace."""


@once
def soft_ends(fit: SweepFit) -> OtherFits:
    """The best fit of the same record with soft ends of the gap in place of its wind-up.

    No fit where nothing may be a wind-up, or no gap softens by so much.

    What a law leaves of its best shape weighs as in the doubt of sizes: no gear has one of these forms.
    """
    evidence, chosen = fit.evidence, fit.posterior.terms
    owners = {t.owner for t in fit.regressors}
    if not owners & {HARDENING, *CURVES}:
        return OtherFits()
    wider = with_terms(evidence, *_terms(evidence))
    search = Search(wider, lambda term: False)
    others: dict[tuple[int, ...], Candidate] = {}
    for without in WITHOUT:
        rest = [i for i in chosen if wider.terms[i].owner not in without]
        if len(rest) == len(chosen):
            continue
        for i in range(len(evidence.terms), len(wider.terms)):
            others[(*rest, i)] = search.candidate((*rest, i))
    for other in sorted(others.values(), key=lambda c: -c.log_evidence):
        soft = fit_regressors(wider, other.terms)
        if 0 < float(soft.posterior.mean[-1]) < MOST_OF_GAP * soft.measured_rig().gap_arcsec:
            gained = other.log_evidence - search.candidate(chosen).log_evidence
            ratio = odds(gained, _shape_nats(fit, owners))
            return OtherFits((soft,), (ratio / (1 + ratio),))
    return OtherFits()


def _shape_nats(fit: SweepFit, owners: Collection[str]) -> float:
    """Nats by which one law is better than another, though neither is the gear's."""
    if HARDENING not in owners:
        return SHAPE_NATS
    left = known_causes()[HARDENING].shape_doubt * effect_size(fit, HARDENING)
    return max(SHAPE_NATS, left**2 / 2)


def _terms(evidence: GaussianEvidence) -> tuple[list[Regressor], list[np.ndarray]]:
    """What soft ends of several forms and widths take off a gap of 1 arcsec."""
    rig = evidence.columns.rig
    torque = np.abs(rig.history.torque_Nm) / rig.largest_Nm
    spread = np.array([rig.prediction.gap_arcsec + rig.prediction.gap_std_arcsec])
    terms, blocks = [], []
    for width in np.geomspace(NARROWEST, WIDEST, WIDTHS):
        x = torque / width
        for rest in (1 - np.tanh(x), np.exp(-x), np.maximum(1 - x, 0.0), 1 / (1 + x)):
            terms.append(Regressor(None, {}, "torque_Nm", None, slice(0, 1), spread, False, 0.0))
            blocks.append((-rest * rig.history.sign / 2)[:, None])
    return terms, blocks
