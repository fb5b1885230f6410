"""Stiffer one way than the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pipeline.diagnosis.effects.cause import Cause, Element, Rig, Shape
from pipeline.diagnosis.record import History


class DirectionAsymmetry(Cause):
    """Compliance c ± a for torque of either sign: twist a·|T| with a [arcsec per N·m]."""

    id = "direction_asymmetry"
    title = "stiffness that differs with the torque's direction"
    unit = "%"
    reveals = "the same sweep with the gear turned round on the rig, so that the torque cell's own sign is excluded"

    def shapes(self, rig: Rig) -> list[Shape]:
        return [{}]

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return np.abs(history.torque_Nm)[:, None]

    def spread(self, shape: Shape, rig: Rig) -> float:
        return 0.15 * rig.prediction.compliance

    def magnitude(self, elements: Sequence[Element], rig: Rig) -> float:
        """(K₊ − K₋) over their mean: −2a/c for compliances c ± a, exactly."""
        return -200 * sum(e.amplitudes[0] for e in elements) / rig.compliance
