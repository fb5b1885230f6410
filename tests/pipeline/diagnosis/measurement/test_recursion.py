"""First-order recursions against what they are written as, step by step."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.recursion import first_order

RNG = np.random.default_rng(4)
DRIVE = RNG.normal(size=(30, 3))


@pytest.mark.parametrize("keep", [RNG.uniform(-1, 1, 29), 0.7])
def test_each_value_is_what_is_kept_of_the_last_and_the_drive(keep: np.ndarray | float) -> None:
    given = DRIVE.copy()
    each = np.broadcast_to(keep, 29)
    state, wanted = np.zeros(3), np.empty((30, 3))
    for i in range(30):
        state = (each[i - 1] * state if i else 0.0) + DRIVE[i]
        wanted[i] = state
    # thirty roundings of numbers near 1
    np.testing.assert_allclose(first_order(keep, given), wanted, atol=1e-13)
    np.testing.assert_array_equal(given, DRIVE)


def test_one_column_keeps_its_shape() -> None:
    assert first_order(0.5, np.ones(4)) == pytest.approx([1, 1.5, 1.75, 1.875])
