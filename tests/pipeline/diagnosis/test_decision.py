"""What stands beside an effect without a name."""

from __future__ import annotations

import pytest

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.decision import decided
from flexspline.pipeline.diagnosis.outcome import NamedCause


@pytest.mark.parametrize(("probability", "stays"), [(0.01, False), (0.49, False), (0.6, True)])
def test_an_unlikely_cause_does_not_stand_beside_the_unknown(
    probability: float, stays: bool
) -> None:
    """However much it gains over the best explanation of its own kind without it."""
    cause = NamedCause(FRICTION, probability, (), 5.0, 0.5, "arcsec", 90.0, 2.0)
    found = decided([cause], [], named_rms=2.0, unnamed_rms=3.0)
    assert found.verdict == "unknown"
    assert bool(found.causes) == stays


@pytest.mark.parametrize(("size", "stays"), [(1.4, False), (1.9, False), (2.1, True)])
def test_a_size_near_none_does_not_stand_beside_the_unknown(size: float, stays: bool) -> None:
    """2.8, 3.8 and 4.2 standard deviations: what a step of the rig left of terms of no form."""
    cause = NamedCause(RATE, 1.0, (), size, 0.5, "arcsec per N·m/s", 14.0, 2.0)
    assert bool(decided([cause], [], named_rms=2.0, unnamed_rms=3.0).causes) == stays
    assert decided([cause], [], named_rms=2.0, unnamed_rms=0.0).causes == (cause,)
