"""A shifted torque reading on staircases with holds of a few rows, that rest at zero for as many."""

from __future__ import annotations

import numpy as np
import pytest
from histories import LARGEST, PREDICTION
from read_sweep import as_read, simulated

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

TORQUE_NOISE, NOISE = 0.002, 0.2
"""N·m; arcsec."""


def staircase(levels: int, rows: int) -> np.ndarray:
    """(n,) true torque of one cycle: up and down on each side, each level and zero held for so many rows."""
    up = np.arange(1, levels + 1) / levels
    side = np.concatenate([up, up[-2::-1], [0.0]])
    return LARGEST * np.repeat(np.concatenate([side, -side]), rows)


def told(levels: int, rows: int, offset_Nm: float) -> dict[str, tuple[float, float]]:
    """Size and deviation of what is named. At zero torque the output stays on the side that it comes from."""
    torque, rng = staircase(levels, rows), np.random.default_rng(levels + 10 * rows)
    last = np.maximum.accumulate(np.where(torque != 0, np.arange(len(torque)), 0))
    n = len(torque)
    zero, time = np.zeros(n, int), np.arange(n) * 1.0
    true = History(torque, zero, zero, time)
    angle = simulated(true)
    angle += PREDICTION.gap_arcsec / 2 * np.sign(torque[last]) * (torque == 0)
    read = torque + offset_Nm + rng.normal(0, TORQUE_NOISE, n)
    history = History(read, zero, zero, time)
    found = diagnose_sweep(as_read(history, angle + rng.normal(0, NOISE, n)), PREDICTION)[0]
    assert found.verdict in ("named", "consistent")
    return {c.id: (c.magnitude, c.magnitude_std) for c in found.causes}


LEVELS_AND_ROWS = [(5, 3), (5, 4), (6, 3), (4, 5), (7, 4)]


@pytest.mark.parametrize(("levels", "rows"), LEVELS_AND_ROWS)
@pytest.mark.parametrize("offset_Nm", [0.05, -0.09])
def test_an_offset_is_named(levels: int, rows: int, offset_Nm: float) -> None:
    size, std = told(levels, rows, offset_Nm)["torque_offset"]
    assert abs(size - offset_Nm) < 3 * std
    assert std < abs(offset_Nm) / 4


@pytest.mark.parametrize(("levels", "rows"), LEVELS_AND_ROWS)
def test_none_is_made_up(levels: int, rows: int) -> None:
    assert told(levels, rows, 0.0) == {}
