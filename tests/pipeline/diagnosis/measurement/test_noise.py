"""The noise model against noise of known covariance."""

from __future__ import annotations

import numpy as np
import pytest
from histories import sweep as swept
from scipy.linalg import cholesky, toeplitz

from flexspline.pipeline.diagnosis.measurement.crossing_band import crossing_band_Nm
from flexspline.pipeline.diagnosis.measurement.noise import Noise, estimated, stretches_of
from flexspline.pipeline.diagnosis.measurement.outliers import isolated_outliers


@pytest.mark.parametrize(
    "noise", [Noise(1.0, 0.0, 0.5), Noise(0.5, 2.0, 0.9), Noise(0.0, 1.0, 0.7)]
)
def test_whitening_is_the_inverse_of_the_covariance(noise: Noise) -> None:
    n = 60
    first = noise.coloured * noise.memory ** np.arange(n)
    covariance = toeplitz(first) + noise.white * np.eye(n)
    filter_ = noise.whitened(np.eye(n), [slice(0, n)])
    left = filter_ @ covariance @ filter_.T
    # rows start from rest instead of from the exact conditional law: the filter forgets that in a
    # few rows, and only those may be off
    assert np.abs(left - np.eye(n))[12:, 12:].max() < 1e-3
    assert np.allclose(np.diag(left), 1.0, atol=1e-6)


def test_the_parts_of_a_noise_are_found() -> None:
    rng = np.random.default_rng(3)
    n, wanted = 6000, Noise(0.4, 0.6, 0.85)
    covariance = toeplitz(
        wanted.coloured * wanted.memory ** np.arange(400)
    ) + wanted.white * np.eye(400)
    root = cholesky(covariance, lower=True)
    sample = np.concatenate([root @ rng.standard_normal(400) for _ in range(n // 400)])
    found = estimated(sample, [slice(i, i + 400) for i in range(0, n, 400)], 400.0, 0)
    # 6000 rows with a memory of 6 hold about 1000 independent ones: 1/√1000 = 3 % on a variance, and
    # three of that for the difference of two
    assert found.std_arcsec == pytest.approx(1.0, rel=0.05)
    assert found.coloured == pytest.approx(0.6, rel=0.2)
    assert found.memory == pytest.approx(0.85, abs=0.06)


def test_memory_is_capped_so_that_drift_is_not_noise() -> None:
    drift = np.linspace(-1, 1, 1000)
    found = estimated(drift, [slice(0, 1000)], 100.0, 0)
    assert found.memory <= np.exp(-1 / 10) + 1e-9


def test_one_spike_goes_and_three_in_a_row_stay() -> None:
    history = swept(cycles=3)
    residual = np.zeros(len(history))
    residual[50] = 9.0
    residual[100:103] = 9.0
    out = isolated_outliers(residual, history, 1.0)
    assert out[50]
    assert not out[100:103].any()


def test_one_place_in_several_passes_is_a_finding() -> None:
    history = swept(cycles=4)
    rows = len(history) // 4
    residual = np.zeros(len(history))
    residual[[17 + rows * c for c in range(4)]] = 9.0
    assert not isolated_outliers(residual, history, 1.0).any()


def test_band_is_the_issues() -> None:
    history = swept(cycles=2)
    largest = np.abs(history.torque_Nm).max()
    assert crossing_band_Nm(history) == pytest.approx(0.035 * largest)


def test_a_single_dropped_row_does_not_cut_a_stretch() -> None:
    history = swept(cycles=1)
    kept = np.ones(len(history), bool)
    kept[20] = False
    assert len(stretches_of(history, kept)) == 1
    kept[30:40] = False
    assert len(stretches_of(history, kept)) == 2


def test_a_slow_noise_is_seen_over_its_own_length() -> None:
    """A share of it that is lost among the white noise from row to row, over a memory of 40 rows.

    What counts for a drift is the power of slow noise, 2·τ·variance.
    """
    rng, memory = np.random.default_rng(9), np.exp(-1 / 40)
    found = []
    for _ in range(8):
        kick, out = rng.normal(size=3000) * np.sqrt(1 - memory**2), np.zeros(3000)
        for k in range(1, len(out)):
            out[k] = memory * out[k - 1] + kick[k]
        sample = 0.3 * out + 0.7 * rng.normal(size=3000)
        noise = estimated(sample, [slice(i, i + 300) for i in range(0, 3000, 300)], 600.0, 0)
        found.append(noise.coloured * -2 / np.log(noise.memory))
    # 3000 rows hold 38 independent pieces of 2τ rows, among white noise of as much power over 5 rows:
    # each is good to about a third, the mean of eight to an eighth
    assert np.mean(found) == pytest.approx(2 * 40 * 0.09, rel=0.25)


def test_each_stretch_is_whitened_as_if_it_were_alone() -> None:
    noise, values = Noise(0.5, 2.0, 0.9), np.random.default_rng(2).normal(size=(40, 3))
    together = noise.whitened(values, [slice(0, 1), slice(1, 25), slice(25, 40)])
    alone = [noise.whitened(values[s], [slice(0, len(values[s]))])
             for s in (slice(0, 1), slice(1, 25), slice(25, 40))]  # fmt: skip
    np.testing.assert_allclose(together, np.concatenate(alone), atol=1e-12)
