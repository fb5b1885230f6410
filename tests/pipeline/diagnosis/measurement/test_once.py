"""What is found once for a history, and for each number given beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.once import once

ASKED: list[float] = []


@once
def beyond(history: History, limit_Nm: float) -> int:
    ASKED.append(limit_Nm)
    return int((history.torque_Nm > limit_Nm).sum())


@once
def doubled(history: History) -> np.ndarray:
    return 2.0 * history.torque_Nm


def test_it_is_found_once_for_each_number_and_each_history() -> None:
    ASKED.clear()
    history = History.course(np.array([1.0, 2.0, 3.0]))
    assert [beyond(history, limit) for limit in (1.5, 1.5, 2.5, 1.5)] == [2, 2, 1, 2]
    assert ASKED == [1.5, 2.5]
    assert beyond(replace(history, torque_Nm=np.zeros(3)), 1.5) == 0
    assert ASKED == [1.5, 2.5, 1.5]


def test_what_is_kept_cannot_be_written_to() -> None:
    history = History.course(np.array([1.0, 2.0, 3.0]))
    with pytest.raises(ValueError, match="read-only"):
        doubled(history)[0] = 0.0


def test_what_is_known_is_not_looked_for() -> None:
    ASKED.clear()
    history = History.course(np.array([1.0, 2.0, 3.0]))
    beyond.keep(history, 7, 1.5)
    assert [beyond(history, limit) for limit in (1.5, 2.5)] == [7, 1]
    assert ASKED == [2.5]
