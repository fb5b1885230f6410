"""The p-value of the best of several looks, held against looks at noise."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr

from flexspline.pipeline.diagnosis.sweep.residual.multiple_tests import p_value_of_best

LOOKS, TRIALS = 4, 20_000


def found_below(limit: float, shared: float, independent: bool) -> float:
    """Share of trials of pure noise, `shared` of whose variance all looks have in common, that are below."""
    rng = np.random.default_rng(5)
    own, common = rng.normal(size=(TRIALS, LOOKS)), rng.normal(size=(TRIALS, 1))
    best = (np.sqrt(shared) * common + np.sqrt(1 - shared) * own).max(axis=1)
    each = (p_value_of_best(float(p), LOOKS, independent) for p in ndtr(-best))
    return float(np.mean([p < limit for p in each]))


@pytest.mark.parametrize("limit", [0.05, 0.3])
def test_independent_looks_at_noise_pass_a_limit_as_often_as_it_says(limit: float) -> None:
    # 4 deviations of a share of 20 000
    room = 4 * np.sqrt(limit * (1 - limit) / TRIALS)
    assert found_below(limit, 0.0, independent=True) == pytest.approx(limit, abs=room)


@pytest.mark.parametrize("shared", [0.0, 0.5, 0.9])
def test_looks_that_share_noise_pass_a_limit_no_more_often_than_it_says(shared: float) -> None:
    limit = 0.05
    room = 4 * np.sqrt(limit * (1 - limit) / TRIALS)
    assert found_below(limit, shared, independent=False) < limit + room


def test_no_p_value_is_above_1() -> None:
    assert p_value_of_best(0.5, LOOKS) == 1.0
