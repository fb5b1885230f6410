"""The noise of readings that follow a programme: of few rows a cycle, at even and at uneven times."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.white_noise import white_noise

ROWS, PER_CYCLE = 400, 32
LARGEST_Nm, NOISE_Nm = 3.0, 0.012
EPOCH_s = 1.8e9
"""As a logger counts: seconds since 1970."""


@pytest.mark.parametrize("begun_s", [0.0, EPOCH_s])
@pytest.mark.parametrize("jitter", [0.0, 0.3])
def test_a_coarse_sine_is_no_noise(jitter: float, begun_s: float) -> None:
    """Of its differences evenly spaced ones leave three times the noise, straight lines five times."""
    rng = np.random.default_rng(1)
    t = np.arange(ROWS) + jitter * rng.uniform(-1, 1, ROWS)
    torque = LARGEST_Nm * np.sin(2 * np.pi * t / PER_CYCLE) + NOISE_Nm * rng.normal(size=ROWS)
    # a median of 400 overlapping differences is good to a tenth; the sine's own third difference adds a tenth
    assert white_noise(torque, begun_s + t) == pytest.approx(NOISE_Nm, rel=0.2)


def test_noise_alone_keeps_its_size_at_uneven_times() -> None:
    rng = np.random.default_rng(2)
    t = np.cumsum(rng.uniform(0, 1, 20_000))
    assert white_noise(rng.normal(size=len(t)), t) == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize("t", [np.zeros(ROWS), np.floor(np.arange(ROWS) / 3)])
def test_a_clock_that_stands_still_gives_a_number(t: np.ndarray) -> None:
    """Rows of one time have no divided difference: the evenly spaced ones are left."""
    noise = white_noise(np.random.default_rng(3).normal(size=ROWS), t)
    assert noise == pytest.approx(1.0, rel=0.25)
