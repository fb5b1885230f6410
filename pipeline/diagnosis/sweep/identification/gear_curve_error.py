"""The whole gear's simulated curve: what it may be off by itself, and what of its bend a record lacks.

No structure over the torque is told below the first.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.bend import NUMERICAL_SHARE
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Candidate, Search
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.identification.owner_rms import (
    beyond_calibration,
    rms_beyond_calibration,
)

RIPPLED = ("?angle_arcsec", "?torque_Nm")
"""Owners of what is a function of angle or torque alone and has no name: on a locked gear the output's angle
is nearly a function of the torque."""
OVER_TORQUE = ("torque_Nm", "direction")
"""Channels in which a misfit of the curve shows: bins of the second are of torque on one branch."""
LOST_P = 1e-6
"""Said of a bend that is lost: the odds are no lower (`whole_gear/scaled_bend.py`)."""


def curve_doubt_arcsec(prediction: Prediction, torque_Nm: np.ndarray) -> float:
    """Rms [arcsec] over these rows, by the model's own discretisation; 0 of a straight line."""
    if prediction.bend is None:
        return 0.0
    wind_up = prediction.compliance * torque_Nm + prediction.bend.at(torque_Nm)
    return NUMERICAL_SHARE * rms(wind_up)


def beyond_curve_doubt(search: Search, best: Candidate) -> Candidate:
    """The set without its functions of torque alone, where they are less than the curve itself is off by.

    What zeros, compliance and gap can be of them does not count: fitted together, one takes what another
    brings back.
    """
    owners = sorted(best.owners & {*RIPPLED})
    if not owners:
        return best
    doubt = _doubt(search.evidence)
    fit = fit_regressors(search.evidence, best.terms)
    if rms_beyond_calibration(fit, *owners) > doubt:
        return best
    terms = search.evidence.terms
    return search.candidate([i for i in best.terms if terms[i].owner not in owners])


def lost_bend(fit: SweepFit) -> Unexplained | None:
    """What of the simulated curve's bend the record does not have; None where it has all."""
    rig = fit.rig
    lost = rig.prediction.lost_bend
    if lost is None:
        return None
    missing = beyond_calibration(fit, lost.at(rig.history.torque_Nm))
    return Unexplained("torque_Nm", missing, LOST_P, (UnnamedForm("less_bend"),))


def _doubt(evidence: GaussianEvidence) -> float:
    rig = evidence.columns.rig
    return curve_doubt_arcsec(rig.prediction, rig.history.torque_Nm[evidence.kept])
