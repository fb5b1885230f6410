"""Whether a gap behind friction is crossed against drag: the quicker the torque, the later and the wider.

In the gap the drag takes all the torque beyond the friction, so the crossing is spread over torques. A race
without drag finds more friction, hardening, a lag or another gap there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache

import numpy as np

from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import FINEST_ARCSEC
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_rate, ramp_s
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.structure import DraggedCrossing
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import on_both_sides
from flexspline.pipeline.diagnosis.sweep.crossing.step_fit import DEPENDENT
from flexspline.pipeline.diagnosis.sweep.crossing.torque_offset_guess import FIRST_NATS
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_fit import CrossedRecord
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_forms import (
    SOFT_ENDS,
    Tried,
    behind_friction,
    soft_side,
)
from flexspline.pipeline.diagnosis.sweep.rig_faults.late_angle import COARSE_ROWS, IMITATED

DRAGGED = "drag"
"""Kind of a crossing against drag."""
FRICTIONS, FRICTIONS_TRIED = (0.3, 1.3), 11
"""Times the friction that the race found, from and to, and how many: drag may treble it."""
SPREADS, SPREADS_TRIED = (0.004, 0.4), 10
"""Torques in which the usual ramp crosses the gap, as shares of the largest torque: from less than a row's to
most of a ramp; each 1.67 times the one before."""
FINE_TRIED = 9
"""Values of each that are tried between the neighbours of the best one."""
SAME_DEVIATIONS = 3.0
"""Deviations up to which the race's friction is the same beside drag: one in 370 differs more by chance."""


def dragged_crossing_of(
    prepared: PreparedSweep, explained: ExplainedSweep, causes: Iterable[NamedCause]
) -> DraggedCrossing | None:
    """What the crossing of a gap says of drag; None where that is as likely without, or changes no cause.

    Drag stands beside those causes alone that it is not taken for, any other crossing beside all that were
    found.
    """
    history, ahead = less_jitter(prepared.sweep.history), explained.prepared.ahead
    if ahead is None or ramp_s(history) == 0 or not on_both_sides(history.torque_Nm):
        return None
    identified, friction = explained.identified, float(ahead.amplitudes[0])
    added = {o: identified.fit.added(o) for o in sorted(set(identified.rms) - {CLEARANCE})}
    noise = identified.search.evidence.noise.std_arcsec
    angle, gap = prepared.sweep.angle_arcsec, prepared.prediction.gap_arcsec
    apart = tuple(own for owner, own in added.items() if owner not in IMITATED)
    with_drag = CrossedRecord(history, angle, gap, noise, apart)
    frictions = friction * np.linspace(*FRICTIONS, FRICTIONS_TRIED)
    spreads = history.largest_Nm * np.geomspace(*SPREADS, SPREADS_TRIED)
    tried = against_drag(history, frictions, spreads)
    coarse = replace(with_drag, most_rows=COARSE_ROWS)
    at = int(np.argmax([coarse.of(one).log_likelihood for one in tried]))
    fine = against_drag(history, *_between(frictions, spreads, at))
    fits = [with_drag.of(one) for one in fine]
    # what the race left holds what no cause could make of the crossing
    noise = max(FINEST_ARCSEC, min(noise, min(fit.left_arcsec for fit in fits)))
    with_drag = replace(with_drag, noise_arcsec=noise)
    likelihood = np.array([with_drag.of(one).log_likelihood for one in fine])
    other = replace(with_drag, added=tuple(added.values())).best(_without_drag(history, frictions))
    if (likelihood.max() - other.log_likelihood) / DEPENDENT < FIRST_NATS:
        return None
    best = fine[int(likelihood.argmax())]
    value, std = _weighted(np.array([one.value for one in fine]), likelihood / DEPENDENT)
    # of 6 made-up records the largest error is 1.6 of these steps
    std = float(np.hypot(std, 2 * (frictions[1] - frictions[0]) / (FINE_TRIED - 1)))
    if not _changes(causes, value, std):
        return None
    assert best.followed_Nm is not None
    missed = gap / 2 * rms(best.form(0.0) - np.sign(best.followed_Nm))
    return DraggedCrossing(value, std, missed)


def _changes(causes: Iterable[NamedCause], friction_Nm: float, std_Nm: float) -> bool:
    """Whether drag tells other causes: one that it imitates, or another friction ahead of the gap."""
    for cause in causes:
        if cause.id != FRICTION and cause.id in (*IMITATED, CLEARANCE):
            return True
        unsure = np.hypot(std_Nm, cause.ahead_std_Nm)
        if cause.ahead_Nm and abs(cause.ahead_Nm - friction_Nm) > SAME_DEVIATIONS * unsure:
            return True
    return False


def _between(frictions: np.ndarray, spreads: np.ndarray, at: int) -> tuple[np.ndarray, np.ndarray]:
    """Finer ones about the best pair of a grid."""
    row, column = divmod(at, len(spreads))
    apart, factor = frictions[1] - frictions[0], spreads[1] / spreads[0]
    about = frictions[row] + apart * np.linspace(-1, 1, FINE_TRIED)
    return about, spreads[column] * factor ** np.linspace(-1, 1, FINE_TRIED)


def _weighted(values: np.ndarray, nats: np.ndarray) -> tuple[float, float]:
    """Mean and deviation of values as likely as that."""
    weight = np.exp(nats - nats.max())
    mean = float(weight @ values / weight.sum())
    return mean, float(np.sqrt(weight @ (values - mean) ** 2 / weight.sum()))


def _without_drag(history: History, frictions: np.ndarray) -> list[Tried]:
    """A sharp crossing behind each friction, and crossings with soft ends."""
    fine = np.linspace(frictions[0], frictions[-1], FRICTIONS_TRIED * FINE_TRIED)
    widths = history.largest_Nm * np.geomspace(*SOFT_ENDS, SPREADS_TRIED)
    sharp = behind_friction(history, fine)
    soft = [
        Tried("soft", one.value, soft_side(one.followed_Nm, width), one.followed_Nm)
        for one in behind_friction(history, frictions)
        for width in widths.tolist()
        if one.followed_Nm is not None
    ]
    return [*sharp, *soft]


def against_drag(history: History, frictions_Nm: np.ndarray, spreads_Nm: np.ndarray) -> list[Tried]:
    """Crossings against each friction with each spread, that of the first friction first."""
    friction, spread = (m.ravel() for m in np.meshgrid(frictions_Nm, spreads_Nm, indexing="ij"))

    @cache
    def sides(more_Nm: float) -> np.ndarray:
        return spread_sides(history, friction, spread, more_Nm)

    def side(k: int) -> Callable[[float], np.ndarray]:
        return lambda more_Nm: sides(more_Nm)[:, k]

    behind = [one.followed_Nm for one in behind_friction(history, frictions_Nm)]
    return [
        Tried(DRAGGED, f, side(k), behind[k // len(spreads_Nm)])
        for k, f in enumerate(friction.tolist())
    ]


def spread_sides(
    history: History, friction_Nm: np.ndarray, spread_Nm: np.ndarray, more_Nm: float = 0.0
) -> np.ndarray:
    """(n, m) side of the gap, −1 … 1, where friction F and drag d act ahead of it.

    In the gap d·dθ/dt = T ∓ F, integrated exactly for torque linear between rows. `spread_Nm` (m,) is the
    torque x beyond F in which a ramp of the usual rate r crosses the gap g: d·g = x²/2r.
    """
    assert history.time_s is not None
    torque = history.torque_Nm + more_Nm
    most = spread_Nm**2 / (2 * ramp_rate(history))
    out = np.empty((len(torque), len(friction_Nm)))
    for rows in history.unit_slices:
        own, time = torque[rows, None], history.time_s[rows]
        driven = _impulse(own - friction_Nm, time) - _impulse(-own - friction_Nm, time)
        side = np.full(len(friction_Nm), np.sign(own[0, 0]))
        for row, moved in zip(rows.tolist(), 2 * driven / most, strict=True):
            side = np.clip(side + moved, -1.0, 1.0)
            out[row] = side
    return out


def _impulse(torque_Nm: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """(n, m) ∫ max(T, 0) dt [N·m·s] since the row before, of torques linear between rows."""
    before, after = torque_Nm[:-1], torque_Nm[1:]
    high, low = np.maximum(before, after), np.minimum(before, after)
    crossed = (high > 0) & (low < 0)
    positive = np.where(crossed, high / np.where(crossed, high - low, 1.0), 1.0)
    mean = np.where(crossed, high / 2, np.maximum(before + after, 0.0) / 2)
    return np.vstack([np.zeros(torque_Nm.shape[1]), np.diff(time_s)[:, None] * positive * mean])
