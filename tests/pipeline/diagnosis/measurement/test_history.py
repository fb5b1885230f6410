"""Rows of a history told apart by what they belong to."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History


def test_each_cycle_of_each_unit_has_a_number_of_its_own() -> None:
    """Units take turns; the first has two cycles, the second three, and one number is left out."""
    unit = np.array([0, 0, 1, 1, 0, 1, 1])
    cycle = np.array([0, 1, 0, 0, 1, 2, 3])
    history = History(np.ones(7), unit, cycle)
    key = history.unit_and_cycle
    assert len(np.unique(key)) == 5
    order = np.argsort(key, kind="stable")
    assert list(zip(unit[order], cycle[order], strict=True)) == [
        (0, 0), (0, 1), (0, 1), (1, 0), (1, 0), (1, 2), (1, 3),
    ]  # fmt: skip
    assert [rows.tolist() for rows in history.cycle_slices] == [[0], [1, 4], [2, 3], [5], [6]]
