"""By how much a torque reading is late: read so much earlier, it makes loops of all rates as wide."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.rig_faults.half_cycles import HalfCycles

DIFFERENT = 0.3
"""Of the loads' differences in width that a delay may leave: it then makes nine tenths of their power."""
FILTER_MISS = 0.1
"""Of a filter's time constant, by which the delay that makes its loops alike may miss it: 0.45 of 0.5 s in
sweeps that hold at their ends."""
LONGEST_DELAY, TRIED = 0.25, 51
"""Of the quickest load, half of a ramp: a reading later than that is of another way; and the delays tried,
the best of them refined."""

OTHER_LOADS_RATIO = 10.0
"""Times as different as they are, where a delay leaves other loads than there were."""


def torque_delay_s(
    loads: HalfCycles, angle_arcsec: np.ndarray, band_Nm: float
) -> tuple[float, float] | None:
    """The delay [s] and its deviation, by an angle (n,).

    None where rates do not differ, or where it leaves the loops different. What these have in common is
    friction's. The gap is crossed within ± `band_Nm`.
    """
    from scipy.optimize import minimize_scalar

    history, rates = loads.history, loads.rates
    if rates is None:
        return None
    assert history.time_s is not None
    longest = LONGEST_DELAY * min(float(np.ptp(history.time_s[rows])) for rows in loads.rows)

    def widths(delay_s: float) -> np.ndarray:
        early = replace(history, torque_Nm=torque_read_at(history, delay_s))
        return HalfCycles.of(early, band_Nm).widths(angle_arcsec)

    was = widths(0.0)

    def unlike(delay_s: float) -> float:
        measured_widths = widths(delay_s)
        return float(
            (measured_widths if len(measured_widths) == len(was) else OTHER_LOADS_RATIO * was).std()
        )

    tried = np.linspace(0.0, longest, TRIED)
    best = int(np.argmin([unlike(one) for one in tried]))
    if best in (0, TRIED - 1):
        return None
    ends = (tried[best - 1], tried[best + 1])
    delay = float(minimize_scalar(unlike, bounds=ends, method="bounded").x)
    left = widths(delay)
    if len(left) != len(was) or left.std() > DIFFERENT * was.std():
        return None
    # how much of a width's difference goes with the rate for each second
    per_s = float((was - left) @ (rates - rates.mean())) / delay
    unsure = left.std(ddof=2) * rates.std() * len(left) ** 0.5 / abs(per_s)
    if unsure >= delay / 2:
        return None
    return delay, delay * hypot(float(unsure) / delay, FILTER_MISS)


def torque_read_at(history: History, later_s: float) -> np.ndarray:
    """(n,) torque as read so much later than each row, within its unit."""
    assert history.time_s is not None
    out = np.empty(len(history))
    for rows in history.unit_slices:
        time = history.time_s[rows]
        out[rows] = np.interp(time + later_s, time, history.torque_Nm[rows])
    return out
