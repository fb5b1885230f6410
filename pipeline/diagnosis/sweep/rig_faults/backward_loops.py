"""Whether a record's loops run backwards: the angle leads the torque, and the gear would give energy.

Friction, creep and lag take energy: at one torque the angle is larger while torque falls than while it rises.
Where it is smaller in every loop, no gear did it: the torque reading lags the angle reading. What a late
reading opens grows with the rate and friction's loop does not, so the quickest loops may run backwards alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.special import gammaincinv

from flexspline.pipeline.diagnosis.causes.kinematic_error import KINEMATIC
from flexspline.pipeline.diagnosis.causes.position_stiffness import POSITION
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.causes.thermal_clearance import THERMAL
from flexspline.pipeline.diagnosis.causes.wear import WEAR
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import FINEST_ARCSEC, Noise
from flexspline.pipeline.diagnosis.structure import BackwardLoop
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rig_faults.half_cycles import HalfCycles
from flexspline.pipeline.diagnosis.sweep.rig_faults.torque_delay import torque_delay_s

FEWEST_LOOPS = 2
"""Fewest backward loops. A single one may be a jolt."""
BACKWARD_SHARE, LOAD_DEVIATIONS = 0.9, 2.0
"""Of the loads that must not run forwards, by so many standard deviations each: noise may turn a few."""
BACKWARD_DEVIATIONS = 4.0
"""Standard deviations below none, on either side of the gap, as a drift widens a loop on one side and narrows
it on the other. By chance one record in a billion has that."""
FEWEST_ALIKE, LUCK = 4, 0.05
"""Differences between loads that are alike of which a noise is told, and the chance that it is larger."""
QUICK_RATIO = 1.25
"""Times a load's own rate that the quickest must not exceed, where the quickest are looked at alone."""
WITHIN_LOADS = (
    THERMAL, WEAR, DRIFT, "?temperature_C", KINEMATIC, POSITION,
)  # fmt: skip
"""Owners of terms that change with time or the input within a load; that of the temperature has no name."""
WOULD_SHOW = ("temperature_C", "input_angle_deg")
"""Channels that would show what else may give such loops: a gap that shrinks as the gear warms, a wave
generator that turns with the load."""
RATE_SHARE = 0.2
"""Share of the slowest loads' width that goes with the rate, up to which loops do not grow: all of a late
reading's does."""


def backward_of(prepared: PreparedSweep, explained: ExplainedSweep) -> BackwardLoop | None:
    """What the loops of a record say; None where they take energy.

    `prepared` : before the race, with the noise that local polynomials leave: what the race leaves holds what
    no cause could make of such loops. Of what it found only that is taken off which changes while a load
    lasts, as a gap that shrinks; a law of the torque opens no loop, nor does a shift of its reading, which
    the race may have made of a late one.
    """
    angle = prepared.sweep.angle_arcsec.copy()
    for owner in WITHIN_LOADS:
        if owner in explained.identified.rms:
            angle -= explained.identified.fit.added(owner)
    return backward_loop(prepared.sweep.history, angle, prepared.band_Nm, prepared.noise)


def backward_loop(
    history: History, angle_arcsec: np.ndarray, band_Nm: float, noise: Noise
) -> BackwardLoop | None:
    """The same of an angle (n,); the gap is crossed within ± `band_Nm`, whose rows decide nothing."""
    loads = HalfCycles.of(history, band_Nm)
    if not len(loads):
        return None
    noise = _as_repeated(loads, angle_arcsec, noise)
    loop, quickest = _backward(loads, angle_arcsec, noise), None
    if loop is None and loads.rates is not None:
        quickest = float(loads.rates.max())
        loop = _backward(loads.only(loads.rates * QUICK_RATIO > quickest), angle_arcsec, noise)
    if loop is None:
        return None
    unrecorded = tuple(channel for channel in WOULD_SHOW if getattr(history, channel) is None)
    delay = torque_delay_s(loads, angle_arcsec, band_Nm)
    grows = True if quickest or delay else _grow(loads, angle_arcsec)
    return BackwardLoop(*loop, quickest, delay, grows, unrecorded)


def _grow(loads: HalfCycles, angle_arcsec: np.ndarray) -> bool | None:
    """Whether backward loops are the wider the quicker; None where rates do not differ."""
    if loads.rates is None:
        return None
    slope, at_rest = np.polyfit(loads.rates, loads.widths(angle_arcsec), 1)
    with_rate = slope * loads.rates.min()
    return bool(with_rate / (at_rest + with_rate) > RATE_SHARE)


def _as_repeated(loads: HalfCycles, angle_arcsec: np.ndarray, noise: Noise) -> Noise:
    """The noise, lower where loads of one kind have widths more alike than it allows.

    Local polynomials take the gap's step for noise where a late reading moves it out of the crossing; it is
    the same step in every load.
    """
    width, kind = loads.widths(angle_arcsec), loads.kinds
    count = np.bincount(kind)
    free = len(loads) - len(count)
    if free < FEWEST_ALIKE:
        return noise
    off = width - (np.bincount(kind, width) / count)[kind]
    power = off**2 * loads.counts
    chance = 2 * float(gammaincinv((free - 1) / 2, LUCK))  # of χ², so much or less
    # without the one that is most unlike: a record may end within a load
    seen = float(power.sum() - power.max()) / (4 * noise.slow_power) / chance
    share = float(np.clip(seen, FINEST_ARCSEC**2 / noise.variance, 1.0))
    return replace(noise, white=share * noise.white, coloured=share * noise.coloured)


def _backward(
    loads: HalfCycles, angle_arcsec: np.ndarray, noise: Noise
) -> tuple[float, int] | None:
    """By how much these loads run backwards [arcsec], and how many loops; None where they do not surely."""
    above = loads.side > 0
    loops = int(min(above.sum(), (~above).sum()))
    if loops < FEWEST_LOOPS:
        return None
    width = loads.widths(angle_arcsec)
    # of the difference of two means over half of the rows each
    variance = 4 * noise.slow_power / loads.counts
    if np.mean(width < LOAD_DEVIATIONS * np.sqrt(variance)) < BACKWARD_SHARE:
        return None
    for own in (above, ~above):
        if width[own].mean() + BACKWARD_DEVIATIONS * np.sqrt(variance[own].sum()) / own.sum() > 0:
            return None
    mean = -float(width.mean())
    return (mean, loops) if mean >= noise.std_arcsec else None
