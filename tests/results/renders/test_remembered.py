"""An answer is found again for the same objects, and for none else."""

from __future__ import annotations

import numpy as np

from flexspline.results.renders.remembered import remembered


def test_the_same_objects_have_the_same_answer_and_equal_ones_have_another() -> None:
    @remembered(1)
    def doubled(values: np.ndarray, by: float = 2.0) -> np.ndarray:
        return by * values

    one, equal = np.ones(3), np.ones(3)
    first = doubled(one)
    assert doubled(one) is first
    assert doubled(equal) is not first
    assert (doubled(one, 3.0) == 3.0).all()


def test_the_oldest_answer_is_forgotten() -> None:
    calls: list[object] = []

    @remembered(2)
    def noted(value: object) -> object:
        calls.append(value)
        return value

    first, second, third = object(), object(), object()
    for value in (first, second, first, third, first):
        noted(value)
    assert calls == [first, second, third, first]
