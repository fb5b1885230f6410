"""Micro-slip: friction with thresholds up to any torque, so that no measured loop saturates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Shape
from flexspline.pipeline.diagnosis.causes.operators import steadied, stops
from flexspline.pipeline.diagnosis.measurement.history import History

POWER = "power"
"""The parameter of an element of micro-slip, and of no other: the exponent p of its twist over torque."""
POWERS = (1.3, 1.6, 2.0, 2.5, 3.2)
"""Tried: joints of bolts lose energy as T^(p + 1) = T^2.3 to T^3 (Segalman, J. Appl. Mech. 72, 752 (2005));
a spread of thresholds that is even between two values has more."""
LEAST_POWER, MOST_POWER = 1.3, 4.0
"""Limits of the exponent in refinement. The lower is the least of bolted joints: near 1, twist is
proportional to torque without a loop, and a spring in series would pass for friction. Above 4 all of the loop
lies in the last fifth of torque."""
INSIDE, OUTSIDE, THRESHOLD_RATIO = 24, 10, 4.0
"""Elements with thresholds up to the largest torque, and beyond it up to `THRESHOLD_RATIO` times that, for
predictions. The loop's width at the largest torque is then good to 0.5 %."""


def thresholds(power: float, largest_Nm: float) -> tuple[np.ndarray, np.ndarray]:
    """Thresholds (m,) [N·m] of play operators and their weights (m,) [1/N·m].

    Σw·play is (T/L)^p when first loaded, L the largest torque. Its second derivative, p(p − 1)T^(p−2)/L^p,
    is the density of thresholds. Each cell's is taken at its centroid: the first load is exact at its ends.
    """
    edge = np.r_[
        np.linspace(0, 1, INSIDE + 1) ** 2, np.geomspace(1, THRESHOLD_RATIO, OUTSIDE + 1)[1:]
    ]
    weight = power * np.diff(edge ** (power - 1))
    centroid = (power - 1) * np.diff(edge**power) / weight
    return centroid * largest_Nm, weight / largest_Nm


def micro_slips(shapes: Sequence[Shape], history: History) -> list[np.ndarray]:
    """Columns (n, 1) of elements: twist that torque adds, 1 at the largest torque when first loaded.

    Masing's rule follows of itself: from each reversal on the twist is twice that of half the way back. So
    the tangent after a reversal is the elastic one, and the loop grows as T^p. With `held` = 0 the chord to
    the largest torque is taken off, where the simulated stiffness has it.
    Source: Krasnosel'skii, Pokrovskii, Systems with Hysteresis (1989), section 2.2 (play operators).
    """
    if not shapes:
        return []
    torque = steadied(history, shapes[0]["deadband_Nm"])
    parts = [thresholds(s[POWER], s["largest_torque_Nm"]) for s in shapes]
    each = np.concatenate([r for r, _ in parts])
    play = torque[:, None] - stops(history, torque, each, np.zeros(len(each)))
    columns, at = [], 0
    for s, (r, weight) in zip(shapes, parts, strict=True):
        twist = play[:, at : at + len(r)] @ weight
        at += len(r)
        if not s["held"]:
            twist = twist - history.torque_Nm / s["largest_torque_Nm"]
        columns.append(twist[:, None])
    return columns
