"""How much each owner of a fitted set adds to the angle, alone and together with others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import less_fitted


def owner_rms(fit: SweepFit, owners: Sequence[str]) -> dict[str, float]:
    """Rms [arcsec] of what each owner adds."""
    return {owner: rms_together(fit, (owner,)) for owner in owners}


def rms_beyond_calibration(fit: SweepFit, *owners: str) -> float:
    """Rms [arcsec] of what owners add together, less what zeros, compliance and gap can be of it."""
    kept = fit.evidence.kept
    return beyond_calibration(fit, sum((fit.added(o) for o in owners), np.zeros(len(kept))))


def beyond_calibration(fit: SweepFit, angle_arcsec: np.ndarray) -> float:
    """Rms [arcsec] over the kept rows of an angle (n,), less what zeros, compliance and gap can be of it."""
    kept, columns = fit.evidence.kept, fit.evidence.columns.base
    straight = columns[kept][:, : fit.units + 2]
    return rms(less_fitted(angle_arcsec[kept], straight))


def rms_together(fit: SweepFit, owners: Sequence[str]) -> float:
    """Rms [arcsec] of what owners add together over the kept rows, each unit's mean removed."""
    kept, unit = fit.evidence.kept, fit.rig.history.unit
    added = sum((fit.added(o) for o in owners), np.zeros(len(kept)))[kept]
    for u in np.unique(unit[kept]):
        added[unit[kept] == u] -= added[unit[kept] == u].mean()
    return rms(added)
