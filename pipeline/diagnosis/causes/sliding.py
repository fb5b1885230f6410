"""Friction between the measured torque and the teeth: what it carries, and what is left for the teeth."""

from __future__ import annotations

import numpy as np
from scipy.special import wrightomega

from flexspline.pipeline.diagnosis.causes.operators import steadied
from flexspline.pipeline.diagnosis.measurement.history import History

LEAST = 1e-300
"""Under a logarithm: a bearing that holds all it can has 0 left."""


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
    torque = steadied(history, deadband_Nm)
    out = np.empty(len(torque))
    friction, kappa = max(friction_Nm, 1e-12), max(stiffness_ratio, 1e-6)
    for rows in history.unit_slices:
        moved = np.r_[0.0, torque[rows]]
        step = np.sign(np.diff(moved))
        last = np.maximum.accumulate(np.where(step != 0, np.arange(len(step)), 0))
        way = step[last]
        starts = np.flatnonzero(np.diff(way, prepend=np.nan) != 0)
        share, z = np.zeros(len(rows)), 0.0
        for a, b in zip(starts, [*starts[1:], len(rows)], strict=True):
            left = max(1 - way[a] * z, LEAST)
            travel = np.abs(moved[a + 1 : b + 1] - moved[a])
            omega = wrightomega(
                kappa * left + np.log(max(kappa * left, LEAST)) - kappa * travel / friction
            )
            share[a:b] = way[a] * (1 - omega / kappa)
            if way[a] == 0:
                share[a:b] = 0.0
            z = float(share[b - 1])
        out[rows] = share
    return out
