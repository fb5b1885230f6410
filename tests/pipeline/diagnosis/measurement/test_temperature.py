"""The noise of a temperature reading, and what is no noise."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.temperature import temperature_without_noise

NOISE_K = 0.05


def history(temperature_C: np.ndarray, unit: np.ndarray | None = None) -> History:
    n = len(temperature_C)
    none = np.zeros(n, int)
    return History(
        np.zeros(n), none if unit is None else unit, none, np.arange(n, dtype=float), temperature_C
    )


def noise(n: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(0, NOISE_K, n)


def test_noise_goes_and_warming_stays() -> None:
    true = 20 + 7 * (1 - np.exp(-np.arange(800) / 150))
    off = temperature_without_noise(history(true + noise(800, 1))) - true
    # means of nine rows and more leave a third of the noise, and their bias is within their intervals
    assert np.std(off) < NOISE_K / 3
    # no lag: where it warms, readings before and after have equal weight
    assert abs(np.mean(off[:150])) < NOISE_K / 5


def test_a_step_between_two_rows_stays_where_it_is() -> None:
    true = np.repeat([21.0, 28.0, 24.5], 100)
    off = temperature_without_noise(history(true + noise(300, 2))) - true
    assert np.abs(off).max() < 4 * NOISE_K  # a mean across the step would be 3.5 K off


def test_a_rounded_reading_is_nearer_to_the_temperature_than_it_says() -> None:
    """Steps of 0.2 K on a rise of 0.01 K a row: off by 0.2/√12 = 0.058 K as read."""
    true = 20 + 0.01 * np.arange(600)
    found = temperature_without_noise(history(np.round(true / 0.2) * 0.2))
    assert np.std(found - true) < 0.5 * 0.2 / np.sqrt(12)


@pytest.mark.parametrize(
    "exact",
    [np.repeat([20.0, 25.0, 21.0], 40), np.linspace(20, 23, 400) ** 2 / 20, np.full(50, 22.0)],
)
def test_readings_without_noise_are_left_as_they_are(exact: np.ndarray) -> None:
    assert np.array_equal(temperature_without_noise(history(exact)), exact)


def test_units_are_not_mixed() -> None:
    unit = np.repeat([0, 1], 60)
    true = np.where(
        unit == 0, 20.0, 20.1
    )  # two deviations apart: one mean over both would be allowed
    both = temperature_without_noise(history(true + noise(120, 3), unit))
    alone = temperature_without_noise(history((true + noise(120, 3))[:60]))
    assert np.array_equal(both[:60], alone)
