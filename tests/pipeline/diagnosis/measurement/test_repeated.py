"""A file that was appended to itself is known by its last digits; a record without noise is not one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from histories import joined, sweep
from read_sweep import as_read

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.repeated import copied_rows

ONCE = sweep(cycles=3)
TWICE = joined([ONCE, replace(ONCE, cycle=ONCE.cycle + 3)])


def read(history: History, seed: int) -> np.ndarray:
    """Angles with noise, to the digits of a file."""
    noise = np.random.default_rng(seed).normal(size=len(history))
    return np.round(10.0 * history.torque_Nm + noise, 3)


def test_a_record_appended_to_itself_is_seen() -> None:
    angle = read(ONCE, 1)
    assert copied_rows(as_read(TWICE, np.tile(angle, 2))) == len(ONCE)


def test_the_same_programme_measured_again_is_no_copy() -> None:
    assert copied_rows(as_read(TWICE, np.concatenate([read(ONCE, 1), read(ONCE, 2)]))) == 0


def test_cycles_without_noise_are_no_copies() -> None:
    assert copied_rows(as_read(TWICE, 10.0 * TWICE.torque_Nm)) == 0
