"""What each named cause could make the angle look like: columns that span its family, generously.

Used only to say how far a hidden effect stands beyond every other cause. A column may be taken with
a positive amount only; families that work both ways hold each column twice, once reversed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hidden.clearance import lagged, side
from hidden.friction import slipping
from hidden.gear import Gear
from hidden.program import Program
from hidden.surroundings import REFERENCE_C

Columns = list[np.ndarray]


def families(program: Program, gear: Gear) -> dict[str, np.ndarray]:
    """Columns (samples, m) of each cause of the vocabulary that this record could tell of."""
    found = {}
    for cause, make in FAMILIES.items():
        columns = make(program, gear)
        if columns:
            found[cause] = np.stack(columns, axis=1)[program.rows]
    return found


def _friction(p: Program, gear: Gear) -> Columns:
    limits = np.array([0.002, 0.01, 0.03, 0.06, 0.1, 0.16, 0.25, 0.4, 0.65, 1.0])
    z = slipping(p.load, limits) / limits
    loaded = [-z[:, k] * np.abs(p.load) for k in (1, 3, 5)]
    return [*(-z.T), *loaded]


def _hardening(p: Program, gear: Gear) -> Columns:
    a, s = np.abs(p.load), np.sign(p.load)
    bends = (0.05, 0.09, 0.15, 0.22, 0.32, 0.45, 0.6, 0.75)
    return [*(s * np.minimum(a, b) for b in bends), *(-s * np.maximum(a - b, 0) for b in bends)]


def _series(p: Program, gear: Gear) -> Columns:
    return _both([p.load])


def _clearance(p: Program, gear: Gear) -> Columns:
    return _both([side(p)])


def _thermal(p: Program, gear: Gear) -> Columns:
    if "temperature_C" not in p.columns:
        return []
    lags = (0.0, 0.1, 0.3, 0.7)
    warm = [lagged(p.temperature, p.time, lag * p.quickest) - REFERENCE_C for lag in lags]
    return _both([w * side(p) for w in warm])


def _wear(p: Program, gear: Gear) -> Columns:
    c = p.progress
    n = c[-1]
    grown = [c, np.sqrt(c), 1 - np.exp(-c / (0.25 * n)), 1 - np.exp(-c / (0.7 * n)), c * c / n]
    stepped = [p.cycle - 1.0, np.sqrt(p.cycle - 1.0)]
    return [g * side(p) for g in (*grown, *stepped)]


def _turning(p: Program) -> Columns:
    turn = np.radians(p.position)
    return [f(h * turn) for h in (1, 2, 4) for f in (np.sin, np.cos)]


def _kinematic(p: Program, gear: Gear) -> Columns:
    return _both(_turning(p)) if "input_angle_deg" in p.columns else []


def _position_stiffness(p: Program, gear: Gear) -> Columns:
    if "input_angle_deg" not in p.columns:
        return []
    return _both([p.load * c for c in _turning(p)])


def _asymmetry(p: Program, gear: Gear) -> Columns:
    a = np.abs(p.load)
    return _both([a, np.sqrt(p.load**2 + 0.003)])  # powers in both directions would span all evens


def _creep(p: Program, gear: Gear) -> Columns:
    shortest = 0.1 * p.hold or 0.1 * p.quickest
    taus = np.geomspace(shortest, p.time[-1], 8)
    return [lagged(p.load, p.time, tau) for tau in taus]


def _drift(p: Program, gear: Gear) -> Columns:
    u = p.time / p.time[-1]
    return _both([u, 1 - np.exp(-3 * u), 1 - np.exp(-u / 0.8), u * u])


def _torque_offset(p: Program, gear: Gear) -> Columns:
    columns = []
    for share in (0.005, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.2):
        for off in (share, -share):
            columns.append((np.sign(p.load) - np.sign(p.load + off)) / 2)
    return columns


def _rate(p: Program, gear: Gear) -> Columns:
    lags = [
        lagged(p.load, p.time, share * p.quickest) - p.load for share in (0.003, 0.01, 0.03, 0.06)
    ]
    rate = lagged(p.rate, p.time, 0.004 * p.quickest)
    top = np.abs(rate).max()
    curved = [-np.sign(rate) * (np.abs(rate) / top) ** power for power in (0.8, 1.0, 1.2)]
    return [*lags, *curved]


def _both(columns: Columns) -> Columns:
    return [*columns, *(-c for c in columns)]


FAMILIES: dict[str, Callable[[Program, Gear], Columns]] = {
    "friction_hysteresis": _friction,
    "stiffness_hardening": _hardening,
    "series_compliance": _series,
    "clearance_offset": _clearance,
    "thermal_clearance": _thermal,
    "kinematic_error": _kinematic,
    "position_stiffness": _position_stiffness,
    "direction_asymmetry": _asymmetry,
    "creep": _creep,
    "wear": _wear,
    "sensor_drift": _drift,
    "torque_offset": _torque_offset,
    "rate_dependence": _rate,
}
