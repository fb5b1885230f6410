"""What stands beside an effect without a name."""

from __future__ import annotations

import pytest

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
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
