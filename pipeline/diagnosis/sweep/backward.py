"""Whether a record's loops run backwards: the angle leads the torque, and the gear would give energy.

Friction, creep and lag take energy: at one torque the angle is larger while torque falls than while it rises.
Where it is smaller in every loop, no gear did it: the torque reading lags the angle reading. What a late
reading opens grows with the rate and friction's loop does not, so the quickest loops may run backwards alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot

import numpy as np
from scipy.special import gammaincinv

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.outcome import NextMeasurement, Unexplained
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rate_blind import cycle_rates

FEWEST_LOOPS = 2
"""What happens once may be a jolt."""
ALIKE, CONTRARY = 0.9, 2.0
"""Of the loads that must not run forwards, by so many standard deviations each: noise may turn a few."""
FEWEST_ROWS = 8
"""Of a load, on one side of the gap: four each way."""
OPEN = 0.1
"""Of the way up: a load whose way down differs by more has not ended."""
SURE = 4.0
"""Standard deviations below none, on either side of the gap, as a drift widens a loop on one side and narrows
it on the other. By chance one record in a billion has that."""
ONE_SIZE = 0.05
"""Relative difference up to which loads have one amplitude, or one rate."""
FEWEST_ALIKE, LUCK = 4, 0.05
"""Differences between loads that are alike of which a noise is told, and the chance that it is larger."""
QUICK = 1.25
"""Times a load's own rate that the quickest must not exceed, where the quickest are looked at alone."""
DIFFERENT = 0.3
"""Of the loads' differences in width that a delay may leave: it then makes nine tenths of their power."""
FILTER = 0.1
"""Of a filter's time constant, by which the delay that makes its loops alike may miss it: 0.45 of 0.5 s in
sweeps that hold at their ends."""
LONGEST, TRIED = 0.25, 51
"""Of the quickest load, half of a ramp: a reading later than that is of another way; and the delays tried,
the best of them refined."""
SLOW = ("thermal_clearance", "wear", "sensor_drift", "?temperature_C")
"""Owners of terms that follow the time within a load; that of the temperature's has no name."""
ABSENT = {
    "temperature_C": "a gap that shrinks as the gear warms within each load (temperature)",
    "input_angle_deg": "a wave generator that turns with the load (its angle)",
}
"""What an honest gear or rig may do that gives such loops, by the channel that would show it."""
NEXT = NextMeasurement(
    "torque_rate",
    "find_structure",
    doing="compare the filters of the torque and the angle channel, and whether both are read at one "
    "instant; then repeat the sweep ten times slower: what a late reading opens is then a tenth as wide",
)


@dataclass(frozen=True)
class BackwardLoop:
    """Loops run backwards: by how much the angle is lower while torque falls, in the mean [arcsec].

    Attributes
    ----------
    loops : so many. rate_Nm_per_s : of the quickest, where only those do; else None.
    delay_s : by which a late torque reading explains how loops differ with their rate, with its standard
        deviation; None where the rates do not differ, or where that does not explain it. unrecorded : what
        else may look like it, in words, where its channel is missing.
    """

    width_arcsec: float
    loops: int
    rate_Nm_per_s: float | None
    delay_s: tuple[float, float] | None
    unrecorded: tuple[str, ...] = ()

    @property
    def said(self) -> Unexplained:
        """As structure without a name that breaks a limit."""
        late = "by a filter or a delay"
        if self.delay_s is not None:
            delay, std = self.delay_s
            late = f"by {delay:.3g} ± {std:.2g} s at all rates, as with a filter or a delay"
        which = "the loops run" if self.rate_Nm_per_s is None else (
            f"the quickest loops, at {self.rate_Nm_per_s:.3g} N·m/s, run"
        )  # fmt: skip
        what = (
            f"{which} backwards: in the mean of {self.loops} the angle is {self.width_arcsec:.3g} "
            "arcsec lower while torque falls than while it rises, so that the gear would give energy, which "
            f"none does; most likely the torque reading lags the angle reading, {late}, or the two are not "
            "read at one instant"
        )
        if self.unrecorded:
            what += f". Not recorded, and able to look like it: {' and '.join(self.unrecorded)}"
        return Unexplained("torque_rate", self.width_arcsec / 2, 0.0, what, limit=True)


def backward_of(prepared: PreparedSweep, explained: ExplainedSweep) -> BackwardLoop | None:
    """What the loops of a record say; None where they take energy.

    `prepared` : before the race, with the noise that local polynomials leave: what the race leaves holds what
    no cause could make of such loops. Of what it found only that is taken off which changes while a load
    lasts, as a gap that shrinks; a law of the torque opens no loop.
    """
    angle = prepared.sweep.angle_arcsec.copy()
    for owner in SLOW:
        if owner in explained.identified.rms:
            angle -= explained.identified.fit.added(owner)
    history = prepared.sweep.history.shifted(explained.prepared.offset_Nm)
    return backward_loop(history, angle, prepared.band_Nm, prepared.noise)


def backward_loop(
    history: History, angle_arcsec: np.ndarray, band_Nm: float, noise: Noise
) -> BackwardLoop | None:
    """The same of an angle (n,); the gap is crossed within ± `band_Nm`, whose rows decide nothing."""
    loads = _loads(history, band_Nm)
    if not loads:
        return None
    rates = _rates(history, loads)
    noise = _as_repeated(history, angle_arcsec, loads, rates, noise)
    found, quickest = _backward(history, angle_arcsec, loads, noise), None
    if found is None and rates is not None:
        quick = [own for own, rate in zip(loads, rates, strict=True) if rate * QUICK > rates.max()]
        found, quickest = _backward(history, angle_arcsec, quick, noise), float(rates.max())
    if found is None:
        return None
    unrecorded = tuple(
        said for channel, said in ABSENT.items() if getattr(history, channel) is None
    )
    delay = None if rates is None else _delay_s(history, angle_arcsec, band_Nm, rates)
    return BackwardLoop(*found, quickest, delay, unrecorded)


def _as_repeated(
    history: History,
    angle_arcsec: np.ndarray,
    loads: list[np.ndarray],
    rates: np.ndarray | None,
    noise: Noise,
) -> Noise:
    """The noise, lower where loads that are alike have widths more alike than it allows.

    Local polynomials take the gap's step for noise where a late reading moves it out of the crossing; it is
    the same step in every load.
    """
    width = _widths(history, angle_arcsec, loads)
    torque = np.array([np.abs(history.torque_Nm[own]).max() for own in loads])
    kinds = [history.unit[[own[0] for own in loads]], history.sign[[own[0] for own in loads]]]
    for sizes in (torque, rates):
        if sizes is not None:
            kinds.append(np.round(np.log(sizes) / ONE_SIZE))
    _, kind = np.unique(np.column_stack(kinds), axis=0, return_inverse=True)
    count = np.bincount(kind)
    free = len(loads) - len(count)
    if free < FEWEST_ALIKE:
        return noise
    off = width - (np.bincount(kind, width) / count)[kind]
    rows = np.array([len(own) for own in loads])
    chance = 2 * float(gammaincinv(free / 2, LUCK))  # of χ², so much or less
    share = min(1.0, float((off**2 * rows).sum()) / (4 * noise.slow_power) / chance)
    return replace(noise, white=share * noise.white, coloured=share * noise.coloured)


def _backward(
    history: History, angle_arcsec: np.ndarray, loads: list[np.ndarray], noise: Noise
) -> tuple[float, int] | None:
    """By how much these loads run backwards [arcsec], and how many loops; None where they do not surely."""
    side = np.array([history.sign[rows[0]] for rows in loads])
    loops = int(min((side > 0).sum(), (side < 0).sum()))
    if loops < FEWEST_LOOPS:
        return None
    width = _widths(history, angle_arcsec, loads)
    # of the difference of two means over half of the rows each
    variance = np.array([4 * noise.slow_power / len(rows) for rows in loads])
    if np.mean(width < CONTRARY * np.sqrt(variance)) < ALIKE:
        return None
    for own in (side > 0, side < 0):
        if width[own].mean() + SURE * np.sqrt(variance[own].sum()) / own.sum() > 0:
            return None
    mean = -float(width.mean())
    return (mean, loops) if mean >= noise.std_arcsec else None


def _rates(history: History, loads: list[np.ndarray]) -> np.ndarray | None:
    """(k,) [N·m/s] of each load's cycle; None where cycles do not differ in it."""
    rates = cycle_rates(history)
    if rates is None:
        return None
    of_row = np.zeros(len(history))
    for rows, rate in zip(history.cycle_slices, rates, strict=True):
        of_row[rows] = rate
    return np.array([of_row[own[0]] for own in loads])


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
    """Of one load, its last row joined to its first: a row more on one way opens no loop."""
    step, angle = np.diff(torque_Nm, append=torque_Nm[0]), angle_arcsec - angle_arcsec.mean()
    return -float((np.roll(angle, -1) + angle) @ step) / float(np.abs(step).sum())


def _delay_s(
    history: History, angle_arcsec: np.ndarray, band_Nm: float, rates: np.ndarray
) -> tuple[float, float] | None:
    """The delay [s] and its deviation: read so much earlier, the torque makes loops of all rates as wide.

    None where it leaves the loops different. What they have in common is friction's. `rates` : of the loads.
    """
    from scipy.optimize import minimize_scalar

    assert history.time_s is not None
    lasting = [float(np.ptp(history.time_s[rows])) for rows in _loads(history, band_Nm)]
    longest = LONGEST * min(lasting)

    def widths(delay_s: float) -> np.ndarray:
        early = replace(history, torque_Nm=_read_at(history, delay_s))
        return _widths(early, angle_arcsec, _loads(early, band_Nm))

    def unlike(delay_s: float) -> float:
        found = widths(delay_s)
        return float(found.std()) if len(found) == len(rates) else np.inf

    tried = np.linspace(0.0, longest, TRIED)
    best = int(np.argmin([unlike(one) for one in tried]))
    if best in (0, TRIED - 1):
        return None
    ends = (tried[best - 1], tried[best + 1])
    delay = float(minimize_scalar(unlike, bounds=ends, method="bounded").x)
    was, left = widths(0.0), widths(delay)
    if len(left) != len(was) or left.std() > DIFFERENT * was.std():
        return None
    # how much of a width's difference goes with the rate for each second
    per_s = float((was - left) @ (rates - rates.mean())) / delay
    unsure = left.std(ddof=2) * rates.std() * len(left) ** 0.5 / abs(per_s)
    return (delay, delay * hypot(float(unsure) / delay, FILTER)) if unsure < delay / 2 else None


def _read_at(history: History, later_s: float) -> np.ndarray:
    """(n,) torque as read so much later than each row, within its unit."""
    assert history.time_s is not None
    out = np.empty(len(history))
    for rows in history.unit_slices:
        time = history.time_s[rows]
        out[rows] = np.interp(time + later_s, time, history.torque_Nm[rows])
    return out
