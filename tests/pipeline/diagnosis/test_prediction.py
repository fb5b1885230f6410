"""The predicted twist between two torques."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION

from flexspline.pipeline.diagnosis.measurement.history import History


@pytest.mark.parametrize(
    ("low", "high", "twist"),
    # compliance 10 arcsec per N·m, gap 60 arcsec
    [(-0.5, 0.5, 70.0), (-0.25, 0.5, 67.5), (0.25, 0.5, 2.5), (-0.5, -0.25, 2.5), (0.0, 0.5, 5.0)],
)
def test_the_gap_lies_between_torques_of_either_sign(low: float, high: float, twist: float) -> None:
    assert PREDICTION.twist_arcsec(low, high) == pytest.approx(twist)
    ends = PREDICTION.twist_arcsec(np.array([low, -1.0]), np.array([high, 1.0]))
    assert ends == pytest.approx([twist, 80.0])


def test_a_total_is_the_distance_of_the_two_predicted_angles() -> None:
    torque = np.array([-0.7, 0.7])
    low, high = PREDICTION.angle_arcsec(History.course(torque))
    assert PREDICTION.twist_arcsec(-0.7, 0.7) == pytest.approx(high - low)
