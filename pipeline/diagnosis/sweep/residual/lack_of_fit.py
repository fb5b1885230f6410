"""What the best explanation misses at the same torques in every cycle.

The noise is estimated from what an explanation leaves, so a misfit at a few torques passes for noise. Noise
does not come back: rows of one torque on one branch share what is missed, and differ by the noise (a test of
lack of fit by repeated readings: Draper, Smith, Applied Regression Analysis, 3rd ed. (1998), chapter 2).
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading, steadied
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import (
    STEADY_SIGMAS,
    UNKNOWN_P_VALUE,
    ChannelTest,
    Residual,
)
from flexspline.pipeline.diagnosis.sweep.residual.rounding import rounding_left_arcsec

PLACE_WIDTHS = (0.01, 0.02, 0.05)
"""Widths of a place over the largest torque. The first that gives no more than `MOST_TORQUE_PLACES` is
used."""
MOST_TORQUE_PLACES = 120
"""Most places: fifty steps of torque on two branches, and some more."""
FEWEST_RETURNS = 3
"""Fewest cycles in which torque comes to a place. Of two, one may be unusual."""


def repeated_misfit(prepared: PreparedSweep, fit: SweepFit) -> ChannelTest | None:
    """The misfit that comes back; None where there is none beyond doubt.

    Nor where rounding or the torque's noise may do as much: a loop in the torque without its noise is a
    little another one.
    """
    codes = _places(prepared)
    if codes is None:
        return None
    misfit = Residual.of(prepared, fit).tested("torque_Nm", codes)
    rounding = rounding_left_arcsec(prepared, fit)
    of_torque = fit.measured_rig().compliance * torque_noise_Nm(prepared.rig.history)
    if misfit.p_value > UNKNOWN_P_VALUE or misfit.rms_arcsec < max(rounding, of_torque):
        return None
    return misfit


def _places(prepared: PreparedSweep) -> np.ndarray | None:
    """(n,) number of each row's place, a torque on a branch; 0 of rows whose torque does not come back."""
    history = prepared.rig.history
    torque = steadied(history, STEADY_SIGMAS * torque_noise_Nm(history))
    up = direction_of_loading(history) > 0
    for width in PLACE_WIDTHS:
        step = np.round(torque / (width * prepared.rig.largest_Nm)).astype(int)
        _, place = np.unique(2 * step + up, return_inverse=True)
        visits = np.unique(
            np.column_stack([place, history.unit, history.cycle])[prepared.kept], axis=0
        )
        often = np.bincount(visits[:, 0], minlength=place.max() + 1) >= FEWEST_RETURNS
        if 1 <= often.sum() <= MOST_TORQUE_PLACES:
            return np.where(often[place], np.cumsum(often)[place], 0)
    return None
