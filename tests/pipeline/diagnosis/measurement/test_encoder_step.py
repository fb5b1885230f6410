"""What rounding to an encoder's steps leaves, against readings that were rounded."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.encoder_step import encoder_step, undithered


@pytest.mark.parametrize("step", [2.0, 20.0])
@pytest.mark.parametrize("share", [0.02, 0.3, 0.6])
def test_a_ramp_s_rounding_leaves_that_rms_at_every_pass(step: float, share: float) -> None:
    """Of 400 passes of one ramp the mean is the saw-tooth; noise of 0.6 steps hides all of it."""
    ramp = np.linspace(-60, 60, 3001)
    noise = share * step * np.random.default_rng(5).normal(size=(400, len(ramp)))
    read = step * np.round((ramp + noise) / step)
    assert encoder_step(read.ravel()) == pytest.approx(step, rel=1e-6)
    left = read - ramp
    saw_tooth = np.sqrt(np.mean(left.mean(axis=0) ** 2))
    # a mean of 400 is off by 1/20 of the readings' deviation, which adds in squares
    by_chance = left.std() / 20
    found = undithered(float(left.var()), encoder_step(read.ravel())) ** 0.5
    # the first harmonic's decay is taken for all: the jumps' edges, of many harmonics, are 6 % of the rms
    assert found == pytest.approx(saw_tooth, rel=0.08, abs=1.2 * by_chance)


def test_readings_of_many_digits_are_not_rounded() -> None:
    angle = np.random.default_rng(1).normal(0, 50, 3000)
    assert undithered(0.04, encoder_step(angle)) ** 0.5 < 1e-3


def test_a_motion_that_repeats_without_noise_has_no_steps() -> None:
    """Its few readings lie as its sine puts them: the least difference between two is no encoder's."""
    sine = 61 * np.sin(np.linspace(0, 2 * np.pi, 240, endpoint=False))
    repeated = np.tile(sine, 3)
    assert encoder_step(repeated) == 0
    assert encoder_step(0.5 * np.round(repeated / 0.5)) == pytest.approx(0.5)
    # written in another unit, to four digits
    assert encoder_step(np.round(0.1374 * np.round(repeated / 0.1374), 4)) == pytest.approx(
        0.1374, abs=1e-4
    )
