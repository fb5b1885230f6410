"""Whether the torque cell's zero moves while a record runs.

Its twist, compliance times the zero, is a drift of the angle to every row but those that cross the gap: they
cross it where the true torque is zero, and a drift of the angle reading leaves that place where it is.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.torque_offset import crossing

PARTS = 3
"""Of a unit's rows: the place of the crossing in the first is held against that in the last."""
MOVED_SIGMAS = 5.0
"""Deviations by which it must differ: each place is known to 2.3 of its own (`torque_offset.UNSURE`)."""
MADE_SHARE = 0.5
"""Of the drift between the two parts, what the twist of the moved zero must make."""


def zero_moves(explained: ExplainedSweep) -> bool:
    """Whether, in some unit, the gap's crossing has moved by as much torque as would make the drift found."""
    fit, prepared = explained.identified.fit, explained.prepared
    history, rig = prepared.rig.history, fit.measured_rig()
    left = fit.residual() + history.sign * rig.gap_arcsec / 2
    drift = fit.added(DRIFT)
    for unit in history.unit_slices:
        rows = unit[~prepared.outlier[unit]]
        parts = np.array_split(rows, PARTS)
        first, last = (
            crossing(
                history.torque_Nm[part], left[part], rig.gap_arcsec, prepared.noise.std_arcsec,
                torque_noise_Nm(history),
            )
            for part in (parts[0], parts[-1])
        )  # fmt: skip
        if first is None or last is None:
            continue
        moved = last.offset_Nm - first.offset_Nm
        drifted = float(drift[parts[-1]].mean() - drift[parts[0]].mean())
        sure = abs(moved) > MOVED_SIGMAS * float(np.hypot(first.std_Nm, last.std_Nm))
        if sure and -moved * rig.compliance * np.sign(drifted) > MADE_SHARE * abs(drifted):
            return True
    return False
