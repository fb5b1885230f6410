"""Nuisance terms of the rig: a lock or clamp that gives way, and inertia that rings after steps of torque."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.integrate import cumulative_trapezoid

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.operators import stops
from flexspline.pipeline.diagnosis.measurement.corners import TorqueCorner, corners_of
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TIME_S, ROUNDING_OF_SUMS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import hold_s
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.nuisance.basis_functions import to_one
from flexspline.pipeline.diagnosis.sweep.nuisance.torque_nuisance import Made

YIELDS = (0.4, 0.55, 0.7, 0.85)
"""Torques at which a lock gives way, over the largest torque. At lower ones the gear's own friction has the
same effect."""
MOST_LOADS = 40
"""Most loads of a record in which each load has its own displacement. With more, all follow one law.
Judgement: it limits the columns."""
DAMPING_AND_PERIOD_RATIOS = ((0.05, 1.12), (0.12, 1.3))
"""Damping ratio, and ratio of neighbouring periods: a ring of damping ζ lasts 1/(2πζ) periods, within which
neighbours so near drift apart by less than a sixth of a turn."""
FEWEST_PERIOD_ROWS = 3.0
"""Fewest rows of a period. With fewer, rows do not follow it."""
LONGEST_PERIOD, LONGEST_HELD_PERIOD = 0.5, 1.0
"""Longest period over a ramp, and over a hold. A slower oscillation does not ring in it."""
FINEST_PART = 0.1
"""Of the rows: so many are sampled finely enough for the shortest period tried. Of cycles at several rates
the quickest ring most."""


def giving_way(rig: FitContext) -> Made:
    """The output goes on while torque is high, and does not come back with it.

    At once with the torque (a play operator), at a rate in proportion to what the lock cannot hold, or by
    another way in each load. With the torque: against it, it would take back what friction adds.
    """
    history, largest = rig.history, rig.largest_Nm
    limits = np.array(YIELDS) * largest
    held = stops(history, history.torque_Nm, limits, np.zeros(len(limits)))
    for state in held.T:
        yield "torque_amplitude", UnnamedForm("gives_way"), (history.torque_Nm - state)[:, None]
    for limit in limits:
        way = _ways(history, limit)
        if np.ptp(way) > 0:
            yield "torque_amplitude", UnnamedForm("gives_way"), way[:, None]
    load = _loads(history, limits[0])
    if 2 <= load.max() + 1 <= MOST_LOADS:
        yield "torque_amplitude", UnnamedForm("gives_way"), _own(_ways(history, limits[0]), load)
        for limit in limits[
            1:3
        ]:  # the middle ones: amplitudes of each load's own fit those between
            yield (
                "torque_amplitude",
                UnnamedForm("gives_way"),
                _own(_highest(history, limit, load), load),
            )


def _own(way: np.ndarray, load: np.ndarray) -> np.ndarray:
    """(n, k) a way of each load's own, up to 1, that stays afterwards."""
    steps = np.diff(way, prepend=0.0)
    own = np.column_stack(
        [np.cumsum(np.where(load == k, steps, 0.0)) for k in range(int(load.max()) + 1)]
    )
    moved = np.abs(own).max(axis=0)
    return to_one(own[:, moved > ROUNDING_OF_SUMS * moved.max()])


def _loads(history: History, limit_Nm: float) -> np.ndarray:
    """(n,) load of each row, from 0: one begins where torque of the other sign passes the limit."""
    load, before = np.zeros(len(history), int), 0
    for rows in history.unit_slices:
        side = np.where(np.abs(history.torque_Nm[rows]) > limit_Nm, history.sign[rows], 0.0)
        high = np.flatnonzero(side)
        turned = np.zeros(len(rows), int)
        turned[high[1:]] = side[high[1:]] != side[high[:-1]]
        load[rows] = before + np.cumsum(turned)
        before = int(load[rows[-1]]) + 1
    return load


def _ways(history: History, limit_Nm: float) -> np.ndarray:
    """(n,) ∫(|T| − limit)·sign T dt [N·m·s] of the time beyond, from 0 in each unit."""
    assert history.time_s is not None
    way = np.zeros(len(history))
    for rows in history.unit_slices:
        torque, time = history.torque_Nm[rows], history.time_s[rows]
        beyond = np.sign(torque) * np.maximum(np.abs(torque) - limit_Nm, 0.0)
        way[rows] = cumulative_trapezoid(beyond, time, initial=0.0)
    return way


def _highest(history: History, limit_Nm: float, load: np.ndarray) -> np.ndarray:
    """(n,) sum over the loads so far of the most that each has passed the limit by, with its sign [N·m]."""
    beyond = np.maximum(np.abs(history.torque_Nm) - limit_Nm, 0.0)
    out, before = np.zeros(len(history)), 0.0
    for k in range(int(load.max()) + 1):
        rows = np.flatnonzero(load == k)
        most = np.maximum.accumulate(beyond[rows])
        way = history.sign[rows[np.argmax(beyond[rows])]] * most
        out[rows] = before + way
        before = out[rows[-1]]
    return out


def ringing(rig: FitContext) -> Made:
    """Damped waves that begin wherever torque changes its rate suddenly, in proportion to the change.

    Of any phase, and of any period that rows can follow. They start from the programme's corners and not
    from the torque's reading: what follows that would follow its noise, which the angle shows as well.
    """
    history = rig.history
    ramp, corners = ramp_s(history), corners_of(history)
    if ramp <= 0 or history.time_s is None or not corners:
        return
    spacing = float(
        np.median(
            [
                np.quantile(np.diff(history.time_s[r]), FINEST_PART)
                for r in history.unit_slices
                if len(r) > 1
            ]
        )
    )
    shortest = FEWEST_PERIOD_ROWS * max(spacing, LEAST_TIME_S)
    longest = max(LONGEST_PERIOD * ramp, LONGEST_HELD_PERIOD * hold_s(history))
    for damping, ratio in DAMPING_AND_PERIOD_RATIOS:
        if longest <= shortest:
            break
        count = int(np.log(longest / shortest) / np.log(ratio)) + 1
        omega = 2 * np.pi / (shortest * ratio ** np.arange(count))
        pole = omega * (-damping + 1j * np.sqrt(1 - damping**2))
        for own, wave_s in zip(_rung(history, corners, pole).T, 2 * np.pi / omega, strict=True):
            form = UnnamedForm("rings", period_s=float(wave_s))
            yield "torque_rate", form, np.column_stack([own.real, own.imag])


def _rung(history: History, corners: Sequence[TorqueCorner], pole: np.ndarray) -> np.ndarray:
    """(n, m) Σ change·exp(pole·(t − corner)) of the corners so far, for each pole (m,) [1/s]."""
    assert history.time_s is not None
    out = np.zeros((len(history), len(pole)), complex)
    for unit, rows in enumerate(history.unit_slices):
        own = [c for c in corners if c.unit == unit]
        time = history.time_s[rows]
        state, at = np.zeros(len(pole), complex), time[0]
        met = np.maximum.accumulate([c.time_s for c in own])  # one after the other
        edges = [*np.searchsorted(time, met).tolist(), len(time)]
        for corner, (first, last) in zip(own, pairwise(edges), strict=True):
            state = state * np.exp(pole * (corner.time_s - at)) + corner.change
            at = corner.time_s
            out[rows[first:last]] = state * np.exp(pole * (time[first:last, None] - at))
    return out
