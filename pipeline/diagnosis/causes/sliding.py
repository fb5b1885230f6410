"""Friction between the measured torque and the teeth: the torque that it carries, and the rest at the
teeth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.special import wrightomega

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.pipeline.diagnosis.causes.operators import last_direction, steadied
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.lost_turns import turning_like
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.robust import rms


@once
def _held_still(history: History) -> History:
    """The history with each hold's torque at its mean.

    A hold's largest reading is due to noise, and a stuck bearing would remember it.
    """
    torque = history.torque_Nm.copy()
    for hold in holds(history):
        torque[hold] = torque[hold].mean()
    return turning_like(history, replace(history, torque_Nm=torque))


ROWS_BESIDE_TURN, STRAIGHT_BESIDE_TURN = 5, 0.02
"""Rows of a way on one side of a turn; of the torque along it, its rms off a line beyond the noise. From the
top of a sine on it is three times that."""
CLEAR = 4.0
"""Shortest way over the deadband, which is two deviations of the torque's noise."""
LEAST_STIFFNESS_RATIO = 1e-6
"""Least stiffness of the bearing over the gear's. A softer bearing carries nothing, and Wright's ω is divided
by the ratio."""


def carried_share(
    history: History, friction_Nm: float, stiffness_ratio: float, deadband_Nm: float
) -> np.ndarray:
    """(n,) friction of an output bearing as a share −1…1 of its largest, from 0 before each unit's first row.

    The bearing sticks to the output with κ = `stiffness_ratio` times the gear's stiffness and slips by
    Dahl's law, dF/dx = κK(1 − z·sgn dx), while the gear takes the rest of the torque, dT = K dx + dF. From a
    reversal on, the share y = 1 − z·sgn dT that is still to come obeys
    κy + ln y = κy₀ + ln y₀ − κ|T − T₀|/F: y is Wright's ω of the right side plus ln κ, over κ. A large κ
    makes the play operator of width F (Krasnosel'skii, Pokrovskii, Systems with Hysteresis (1989),
    section 2.2). Rate-independent; source of the law: Dahl, Aerospace Corporation TOR-158(3107-18) (1968).
    """
    torque = steadied(_held_still(history), deadband_Nm)
    out = np.empty(len(torque))
    friction = max(friction_Nm, LEAST_TORQUE_Nm)
    kappa = max(stiffness_ratio, LEAST_STIFFNESS_RATIO)

    def to_come(left: float, travel_Nm: np.ndarray) -> np.ndarray:
        """y after a travel, from y₀ = `left`."""
        start = kappa * left + np.log(max(kappa * left, ABOVE_ZERO))
        return np.asarray(wrightomega(start - kappa * travel_Nm / friction)) / kappa

    for rows in history.unit_slices:
        moved = np.r_[0.0, torque[rows]]
        step = np.sign(np.diff(moved))
        side = last_direction(step)
        starts = np.flatnonzero(np.diff(side, prepend=np.nan) != 0)
        time = None if history.time_s is None else history.time_s[rows]
        left, turn = 1.0, 0.0
        share = np.zeros(len(rows))
        for a, b in zip(starts, [*starts[1:], len(rows)], strict=True):
            if a > 0:
                where = _turned_at(history.torque_Nm[rows], time, int(a), deadband_Nm)
                before, (turn, earlier) = turn, where or (float(moved[a]), False)
                y = float(to_come(left, np.abs(np.array(turn - before)))) if side[a - 1] else 1.0
                left = max(1 - side[a] * side[a - 1] * (1 - y), ABOVE_ZERO)
                a -= earlier
            if side[b - 1] != 0:
                share[a:b] = side[b - 1] * (1 - to_come(left, np.abs(moved[a + 1 : b + 1] - turn)))
        out[rows] = share
    return out


def _turned_at(
    torque: np.ndarray, time: np.ndarray | None, a: int, deadband_Nm: float
) -> tuple[float, bool] | None:
    """Where torque turned before row a, and whether before row a − 1 already.

    Row a − 1 may lie on either side: the straight ways through the rows before it, and from a on, meet at the
    turn. None where the ways are short against the noise, or bent, or meet elsewhere: then a − 1 is the turn.
    """
    if time is None or a < ROWS_BESIDE_TURN + 1 or a + ROWS_BESIDE_TURN > len(torque):
        return None
    last, lines = a - 2, []
    for rows in (np.arange(a - 1 - ROWS_BESIDE_TURN, a - 1), np.arange(a, a + ROWS_BESIDE_TURN)):
        t = time[rows] - time[last]
        if np.diff(t).min() <= 0:
            return None
        slope, level = np.polyfit(t, torque[rows], 1)
        span = abs(torque[rows[-1]] - torque[rows[0]])
        off = rms(torque[rows] - level - slope * t)
        if span <= CLEAR * deadband_Nm or off > deadband_Nm + STRAIGHT_BESIDE_TURN * span:
            return None
        lines.append((slope, level))
    (before, level), (after, later) = lines
    if before * after >= 0:
        return None
    at = (later - level) / (before - after)
    if not 0 <= at <= time[a] - time[last]:
        return None
    return float(level + before * at), bool(time[last] + at < time[a - 1])
