"""Whether the terms without a name take back what others of them bring, and what is known without them."""

from __future__ import annotations

from math import hypot

from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import less_zero
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification

MORE_THAN_THERE_IS = 1.5
"""Times what there is to be explained. Right terms beside a calibration a little off had up to 1.2 in made-up
records (stiffness of each cycle's own, gap of each position's own); a joint that softens beyond a load 1.6, a
loose key 2.6, and so had their compliances wrong by 4 and 18 of the deviations then stated."""


def terms_cancel(identified: Identification) -> bool:
    """Whether terms without a name add much more, each by itself, than the simulation as it stands leaves.

    What is independent adds no more than there is to be explained. What cancels, some of it with a compliance
    that is not there, makes room for any compliance and gap.
    """
    unnamed = identified.unnamed(())
    if not unnamed:
        return False
    evidence = identified.search.evidence
    left = less_zero(evidence.target, evidence.kept, evidence.columns.rig.history)[evidence.kept]
    return hypot(*(identified.rms[owner] for owner in unnamed)) > MORE_THAN_THERE_IS * rms(left)


def without_unnamed(identified: Identification) -> SweepFit:
    """The fit of the named causes alone."""
    evidence = identified.search.evidence
    kept = [i for i in identified.best.terms if evidence.terms[i].owner in identified.named]
    return fit_regressors(evidence, kept)
