"""Stiffer one way than the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, Rig, Shape
from flexspline.pipeline.diagnosis.measurement.history import History

STARTS = ((1.0, 0.0), (0.88, 0.0), (1.12, 0.0), (1.0, 0.12), (1.0, 0.3))
"""Exponent, and rounding as a share of the largest torque; both are refined within `possible`."""


class DirectionAsymmetry(Cause):
    """Compliance c ± a for torque of either sign: twist a·|T| with a [arcsec per N·m].

    At the largest torque; between, the difference may grow a little slower or faster than torque
    (`exponent`), or set in smoothly (`rounding_Nm`).
    """

    id = "direction_asymmetry"
    title = "stiffness that differs with the torque's direction"
    unit = "%"
    tunable = ("exponent", "rounding_Nm")
    shape_doubt = 0.03
    """With 0.02 one and two deviations cover 58 and 89 % of 19 made-up records, most of them pairs."""
    reveals = "the same sweep with the gear turned round on the rig, to exclude the torque cell"

    def shapes(self, rig: Rig) -> list[Shape]:
        return [
            {"exponent": n, "rounding_Nm": r * rig.torque_Nm, "largest_torque_Nm": rig.torque_Nm}
            for n, r in STARTS
        ]

    def possible(self, shape: Shape) -> bool:
        """Far from |T| the curve is some other even function, not two stiffnesses."""
        rounding = shape["rounding_Nm"] / shape["largest_torque_Nm"]
        return 0.8 <= shape["exponent"] <= 1.2 and rounding <= 0.35

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        largest, rounding = shape["largest_torque_Nm"], shape["rounding_Nm"]
        x = (np.hypot(history.torque_Nm, rounding) - rounding) / (
            np.hypot(largest, rounding) - rounding
        )
        return (largest * x ** shape["exponent"])[:, None]

    def spread(self, shape: Shape, rig: Rig) -> float:
        return 0.15 * rig.prediction.compliance

    def magnitude(self, elements: Sequence[Element], rig: Rig) -> float:
        """(K₊ − K₋) over their mean: −2a/c for chord compliances c ± a, exactly."""
        return -200 * sum(e.amplitudes[0] for e in elements) / rig.compliance
