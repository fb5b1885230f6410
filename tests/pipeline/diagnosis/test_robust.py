"""A scale of noise that outliers do not move."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.robust import SIGMA_PER_MAD, robust_std


@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (400,), (401,), (20, 3)])
def test_it_is_by_numpys_median(shape: tuple[int, ...]) -> None:
    values = np.random.default_rng(3).standard_normal(shape)
    assert robust_std(values) == SIGMA_PER_MAD * np.median(np.abs(values))
    assert robust_std(values.tolist()) == robust_std(values)


def test_what_is_no_number_stays_none() -> None:
    assert np.isnan(robust_std([1.0, np.nan, 2.0]))
