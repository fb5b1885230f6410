"""What is said of an effect that is there and whose size is not known, and of structure without a name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.results.diagnosis.words import sure_words

DRIFT = NamedCause("sensor_drift", 0.99, (), -23.0, 13.0, "arcsec/h", 12.0, 4.0)
HARDENING = NamedCause("stiffness_hardening", 0.99, (), 1.03, 0.02, "1", 12.0, 4.0)


@pytest.mark.parametrize(
    ("cause", "said"),
    [
        (DRIFT, "beyond doubt, size uncertain"),  # 1.8 deviations from none
        (replace(DRIFT, magnitude_std=5.0), "beyond doubt"),
        (replace(DRIFT, magnitude_std=31.0), "an effect exists, its size is not known"),
        (HARDENING, "beyond doubt, size uncertain"),  # a ratio of 1 is no hardening
        (replace(HARDENING, magnitude=1.2), "beyond doubt"),
        (replace(DRIFT, alternatives=("creep",)), "not decided"),
    ],
)
def test_a_size_within_two_deviations_of_none_is_not_sure(cause: NamedCause, said: str) -> None:
    assert sure_words(cause) == said
