"""Torque histories for tests, written out by hand: triangles, holds, units, every channel."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.prediction import Prediction

PREDICTION = Prediction(compliance=10.0, compliance_std=0.3, gap_arcsec=60.0, gap_std_arcsec=10.0)
LARGEST = 2.0  # N·m


def triangle(rows: int = 40, hold: int = 8) -> np.ndarray:
    """0 → +2 → (hold) → −2 → (hold) → 0 N·m."""
    q = rows // 4
    up = LARGEST * np.arange(1, q + 1) / q
    down = LARGEST * (1 - np.arange(1, 2 * q + 1) / q)
    ends = np.full(hold, LARGEST)
    return np.concatenate([up, ends, down, -ends, up - LARGEST])


def sweep(cycles: int = 4, units: int = 1, hold: int = 8, rows: int = 40) -> History:
    """A record with every channel; 5 s a row; warmer and at another position in each cycle."""
    one = triangle(rows, hold)
    n = len(one) * cycles
    cycle = np.repeat(np.arange(cycles), len(one))
    single = History(
        np.tile(one, cycles),
        np.zeros(n, int),
        cycle,
        5.0 * np.arange(n),
        20.0 + 12.0 * ((cycle * 3) % 5) / 4 + 0.5 * np.sin(np.arange(n) / 9),
        (cycle * 47.0) % 360,
    )
    return joined([replace(single, unit=np.full(n, u)) for u in range(units)])


def joined(parts: list[History]) -> History:
    """Histories one after the other."""
    return History(*(
        np.concatenate([getattr(p, name) for p in parts])
        for name in ("torque_Nm", "unit", "cycle", "time_s", "temperature_C", "input_angle_deg")
    ))  # fmt: skip


def shape_of(cause_id: str, history: History | None = None, /, **wanted: float) -> dict[str, float]:
    """The first shape that a cause tries with these parameters, or, where none has, given them."""
    shapes = known_causes()[cause_id].shapes(FitContext(PREDICTION, history or sweep()))
    alike = [s for s in shapes if all(s.get(k) == v for k, v in wanted.items())]
    return {**(alike or shapes)[0], **wanted}
