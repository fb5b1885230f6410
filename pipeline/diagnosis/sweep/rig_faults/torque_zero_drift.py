"""Whether the torque cell's zero moves while a record runs.

Its twist, compliance times the zero, is a drift of the angle to every row but those that cross the gap: they
cross it where the true torque is zero, and a drift of the angle reading leaves that place where it is.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, crossing_of

PARTS = 3
"""Parts of a unit's rows. The place of the crossing in the first part is compared with that in the last."""
MOVED_SIGMAS = 4.0
"""Deviations by which it must differ: chance alone does it once in 16 000 records."""
MADE_SHARE = 0.5
"""Least share of the drift between the two parts that the twist of the moved zero must explain. Judgement."""


def zero_moves(explained: ExplainedSweep) -> bool:
    """Whether, in some unit, the gap's crossing has moved by as much torque as would make the drift found."""
    fit, prepared = explained.identified.fit, explained.prepared
    compliance, drift = fit.measured_rig().compliance, fit.added(DRIFT)
    for unit in prepared.rig.history.unit_slices:
        begin, *_, end = np.array_split(unit[~prepared.outlier[unit]], PARTS)
        first, last = (crossing_of(prepared, fit, rows) for rows in (begin, end))
        if first is None or last is None:
            continue
        moved = last.offset_Nm - first.offset_Nm
        drifted = float(drift[end].mean() - drift[begin].mean())
        sure = abs(moved) > MOVED_SIGMAS * float(np.hypot(first.std_Nm, last.std_Nm))
        if sure and -moved * compliance * np.sign(drifted) > MADE_SHARE * abs(drifted):
            return True
    return False
