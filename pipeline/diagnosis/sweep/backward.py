"""Whether a record's loops run backwards: the angle leads the torque, and the gear would give energy.

Friction, creep and lag take energy: at one torque the angle is larger while torque falls than while it rises.
Where it is smaller in every loop, no gear did it: the torque reading lags the angle reading.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.outcome import NextMeasurement, Unexplained
from flexspline.pipeline.diagnosis.sweep.plausible_sets import DRIVEN
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rate_blind import at_one_rate

FEWEST_LOOPS = 2
"""What happens once may be a jolt."""
ALIKE = 0.9
"""Of the loads that must run backwards: noise may turn a few."""
FEWEST_ROWS = 8
"""Of a load, on one side of the gap: four each way."""
OPEN = 0.1
"""Of the way up: a load whose way down differs by more has not ended."""
SURE = 4.0
"""Standard deviations below none, on either side of the gap, as a drift widens a loop on one side and narrows
it on the other. By chance one record in a billion has that."""
DIFFERENT = 0.3
"""Of the loads' differences in width that a delay may leave: it then makes nine tenths of their power."""
LONGEST, DIGITS = 0.25, 1e-4
"""Of the quickest load, half of a ramp: a reading later than that is of another way; and how well it is
sought."""
OF_TEMPERATURE = "?temperature_C"
"""Owner of the terms without a name that follow the temperature."""
NEXT = NextMeasurement(
    "torque_rate",
    "find_structure",
    doing="compare the filters of the torque and the angle channel, and whether both are read at one "
    "instant; then repeat the sweep ten times slower: what a late reading opens is then a tenth as wide",
)


@dataclass(frozen=True)
class BackwardLoop:
    """Loops run backwards: by how much the angle is lower while torque falls, in the mean [arcsec].

    `delay_s` : by which a late torque reading explains it at all rates, with its standard deviation; None
    where the rates do not differ, or where that does not explain it.
    """

    width_arcsec: float
    loops: int
    delay_s: tuple[float, float] | None

    @property
    def said(self) -> Unexplained:
        """As structure without a name that breaks a limit."""
        late = "by a filter or a delay"
        if self.delay_s is not None:
            delay, std = self.delay_s
            late = f"by {delay:.3g} ± {std:.2g} s at all rates, as with a filter or a delay"
        what = (
            f"the loops run backwards: in the mean of {self.loops} the angle is {self.width_arcsec:.3g} "
            "arcsec lower while torque falls than while it rises, so that the gear would give energy, which "
            f"none does; most likely the torque reading lags the angle reading, {late}, or the two are not "
            "read at one instant"
        )
        return Unexplained("torque_rate", self.width_arcsec / 2, 0.0, what, limit=True)


def backward_of(prepared: PreparedSweep, explained: ExplainedSweep) -> BackwardLoop | None:
    """What the loops of a record say; None where they take energy.

    `prepared` : before the race, with the noise that local polynomials leave: what the race leaves holds what
    no cause could make of such loops. What it found that opens no loop by itself, but a gap that shrinks or a
    gear that stiffens while the torque is on, is taken off.
    """
    fit = explained.identified.fit
    others = [o for o in explained.identified.rms if o == OF_TEMPERATURE or o[0] != "?"]
    angle = prepared.sweep.angle_arcsec.copy()
    for owner in others:
        if owner not in DRIVEN:
            angle -= fit.added(owner)
    history = prepared.sweep.history.shifted(explained.prepared.offset_Nm)
    return backward_loop(history, angle, prepared.band_Nm, prepared.noise)


def backward_loop(
    history: History, angle_arcsec: np.ndarray, band_Nm: float, noise: Noise
) -> BackwardLoop | None:
    """The same of an angle (n,); the gap is crossed within ± `band_Nm`, whose rows decide nothing."""
    loads = _loads(history, band_Nm)
    side = np.array([history.sign[rows[0]] for rows in loads])
    loops = int(min((side > 0).sum(), (side < 0).sum()))
    if loops < FEWEST_LOOPS:
        return None
    width = _widths(history, angle_arcsec, loads)
    # of the difference of two means over half of the rows each
    variance = np.array([4 * noise.slow_power / len(rows) for rows in loads])
    if np.mean(width < 0) < ALIKE:
        return None
    for own in (side > 0, side < 0):
        if width[own].mean() + SURE * np.sqrt(variance[own].sum()) / own.sum() > 0:
            return None
    mean = -float(width.mean())
    if mean < noise.std_arcsec:
        return None
    return BackwardLoop(mean, loops, _delay_s(history, angle_arcsec, band_Nm))


def _loads(history: History, band_Nm: float) -> list[np.ndarray]:
    """Rows of each load, from where torque leaves the gap's crossing to where it comes back."""
    found = []
    for rows in history.unit_slices:
        torque = history.torque_Nm[rows]
        side = np.where(np.abs(torque) > band_Nm, np.sign(torque), 0)
        parts = np.split(rows, np.flatnonzero(np.diff(side)) + 1)
        found += [own for own in parts if side[own[0] - rows[0]] and _returns(history, own)]
    return found


def _returns(history: History, rows: np.ndarray) -> bool:
    step = np.diff(history.torque_Nm[rows])
    return len(rows) >= FEWEST_ROWS and abs(step.sum()) < OPEN / 2 * np.abs(step).sum()


def _widths(history: History, angle_arcsec: np.ndarray, loads: list[np.ndarray]) -> np.ndarray:
    """(k,) by how much the angle is larger while torque falls, −∮θ dT over the way up."""
    return np.array([_width(history.torque_Nm[own], angle_arcsec[own]) for own in loads])


def _width(torque_Nm: np.ndarray, angle_arcsec: np.ndarray) -> float:
    step, angle = np.diff(torque_Nm), angle_arcsec - angle_arcsec.mean()
    return -float((angle[1:] + angle[:-1]) @ step) / float(np.abs(step).sum())


def _delay_s(
    history: History, angle_arcsec: np.ndarray, band_Nm: float
) -> tuple[float, float] | None:
    """The delay [s] and its deviation: read so much earlier, the torque closes the loops of every rate.

    None where the rates do not differ, or where it leaves them different.
    """
    from scipy.optimize import brentq

    if history.time_s is None or at_one_rate(history) is None:
        return None

    def open_by(delay_s: float) -> np.ndarray:
        early = replace(history, torque_Nm=_read_at(history, delay_s))
        return _widths(early, angle_arcsec, _loads(early, band_Nm))

    def mean(delay_s: float) -> float:
        found = open_by(delay_s)
        return float(found.mean()) if len(found) else np.inf

    lasting = [float(np.ptp(history.time_s[rows])) for rows in _loads(history, band_Nm)]
    longest = LONGEST * min(lasting)
    if mean(longest) < 0:
        return None
    delay = float(brentq(mean, 0.0, longest, xtol=DIGITS * longest))
    was, left = open_by(0.0), open_by(delay)
    if len(left) != len(was) or left.std() > DIFFERENT * was.std():
        return None
    return delay, delay * float((left / was).std(ddof=1)) / len(was) ** 0.5


def _read_at(history: History, later_s: float) -> np.ndarray:
    """(n,) torque as read so much later than each row, within its unit."""
    assert history.time_s is not None
    out = np.empty(len(history))
    for rows in history.unit_slices:
        time = history.time_s[rows]
        out[rows] = np.interp(time + later_s, time, history.torque_Nm[rows])
    return out
