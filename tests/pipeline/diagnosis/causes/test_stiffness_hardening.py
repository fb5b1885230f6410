"""Hardening as a spring with a cubic term, against the spring's own equation."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.causes.cause import Shape
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import LAWS, StiffnessHardening
from flexspline.pipeline.diagnosis.measurement.history import History

LARGEST_NM = 40.0


def twist(shape: Shape, torque_Nm: np.ndarray) -> np.ndarray:
    return StiffnessHardening().columns(shape, History.course(torque_Nm))[:, 0]


def spring(cubic_share: float, held: int) -> Shape:
    law = {"law": LAWS["cubic spring"], "parameter": cubic_share}
    return {**law, "held": held, "largest_torque_Nm": LARGEST_NM}


@pytest.mark.parametrize("cubic_share", [0.3, 1.4, 20.0])
def test_a_cubic_spring_obeys_its_equation(cubic_share: float) -> None:
    theta = np.linspace(-1, 1, 21)
    torque = LARGEST_NM * (theta + cubic_share * theta**3) / (1 + cubic_share)
    on_the_chord = theta - torque / LARGEST_NM  # what is left of it beside the simulated chord
    assert twist(spring(cubic_share, held=1), torque) == pytest.approx(on_the_chord, abs=1e-12)


@pytest.mark.parametrize(("held", "at_Nm"), [(0, LARGEST_NM), (2, 0.0)])
def test_it_is_as_stiff_as_simulated_where_it_is_held(held: int, at_Nm: float) -> None:
    step = 1e-4 * LARGEST_NM
    before, after = twist(spring(1.4, held), np.array([at_Nm - step, at_Nm + step]))
    furthest = np.abs(twist(spring(1.4, held), np.linspace(0, LARGEST_NM, 50))).max()
    assert abs(after - before) < 1e-6 * furthest  # of second order in the step, 1e-8
