"""A stiffness that differs between the two directions of torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_jitter import by_known_ways

ASYMMETRY = "direction_asymmetry"
"""This cause's id."""
STARTS = ((1.0, 0.0), (0.88, 0.0), (1.12, 0.0), (1.0, 0.07), (1.0, 0.14))
"""Exponent, and rounding as a share of the largest torque; both are refined within `possible`."""
LEAST_EXPONENT, MOST_EXPONENT = 0.8, 1.2
"""Of torque, when refined: two stiffnesses have 1, and at half the torque these differ from it by 15 %."""
LEAST_AT_HALF = 0.41
"""Of the twist at the largest torque, at half of it: |T| has 0.5, with an exponent of 1.2 it is 0.435,
rounded over a fifth of the torque 0.413; T², which is no two stiffnesses, has 0.25."""


class DirectionAsymmetry(Cause):
    """Compliance c ± a for torque of either sign: twist a·|T| with a [arcsec per N·m].

    a holds at the largest torque. Below it, the difference may grow a little slower or faster than torque
    (`exponent`), or begin smoothly (`rounding_Nm`).
    """

    id = ASYMMETRY
    title = "stiffness that differs with the torque's direction"
    unit = "%"
    per_torque = True
    spread_share = 0.15
    """Both directions load the same parts; keys, bolts and flanks differ by some tenths at most."""
    ratio = "difference between the two directions in % of their mean"
    tunable = ("exponent", "rounding_Nm")
    elastic = True
    shape_doubt = 0.02
    """One and two deviations cover 75 and 96 % of 28 sizes."""
    reveals = "the same sweep with the gear turned round on the rig, to exclude the torque cell"

    def shapes(self, rig: FitContext) -> list[Shape]:
        return [
            {"exponent": n, "rounding_Nm": r * rig.largest_Nm, "largest_torque_Nm": rig.largest_Nm}
            for n, r in STARTS
        ]

    def stands_alone(self, shape: Shape) -> bool:
        """Differences of such curves would be any even function."""
        return True

    def possible(self, shape: Shape) -> bool:
        """Far from |T| the curve is some other even function, not two stiffnesses."""
        half = _share(np.array([0.5]), shape["rounding_Nm"] / shape["largest_torque_Nm"])
        at_half = float(half[0]) ** shape["exponent"]
        return LEAST_EXPONENT <= shape["exponent"] <= MOST_EXPONENT and at_half >= LEAST_AT_HALF

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        largest = shape["largest_torque_Nm"]
        x = _share(by_known_ways(history) / largest, shape["rounding_Nm"] / largest)
        return (largest * x ** shape["exponent"])[:, None]

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        """(K₊ − K₋) over their mean: −2a/c for chord compliances c ± a, exactly."""
        return -200 * sum(e.amplitudes[0] for e in elements) / rig.compliance


def _share(load: np.ndarray, rounding: float) -> np.ndarray:
    """(n,) rounded |load|, 1 at load 1."""
    return (np.hypot(load, rounding) - rounding) / (np.hypot(1.0, rounding) - rounding)
