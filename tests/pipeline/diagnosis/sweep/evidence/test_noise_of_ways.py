"""Noise of the torque that is alike in a whole way: columns are whitened by it too."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.known_ways import known_ways
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare

ROWS, DRAWN = 1600, 300


def test_what_the_torque_s_noise_leaves_is_white_afterwards() -> None:
    """Noise drawn as it is said to be, of rows and of each way's two numbers: variance 1 in every direction.

    Of 300 draws a variance is known to √(2/300) = 0.08; of some 20 directions the worst is within four times
    that. Without the ways' own noise it would be 1 + (10 · 0.02 / 0.25)² = 1.64.
    """
    rng = np.random.default_rng(6)
    turn = np.arange(ROWS) * 4 / ROWS
    torque = 4 / np.pi * np.arcsin(np.sin(2 * np.pi * turn)) + rng.normal(0, 0.02, ROWS)
    none = np.zeros(ROWS, int)
    history = History(torque, none, turn.astype(int), np.arange(ROWS, dtype=float))
    angle = PREDICTION.angle_arcsec(history) + rng.normal(0, 0.25, ROWS)
    prepared = prepare(as_read(history, angle), PREDICTION)
    white_rows = Noise(white=0.0625, coloured=0.0, memory=0.0)
    evidence = gaussian_evidence(prepared.columns, prepared.target, prepared.kept, white_rows)
    ways = known_ways(prepared.rig.history)
    assert len(ways) >= 8
    assert all(way.doubt_Nm.shape[1] == 2 for way in ways)
    drawn = white_rows.std_arcsec * rng.normal(size=(ROWS, DRAWN))
    for way in ways:
        drawn[way.rows] += PREDICTION.compliance * way.doubt_Nm @ rng.normal(size=(2, DRAWN))
    white = evidence.whitened(drawn)
    place = np.cumsum(prepared.kept) - 1
    worst = 0.0
    for way in ways:
        kept = way.rows[prepared.kept[way.rows]]
        if len(kept) == 0:  # before the first reversal
            continue
        along, _ = np.linalg.qr(way.doubt_Nm[prepared.kept[way.rows]])
        variance = ((along.T @ white[place[kept]]) ** 2).mean(axis=1)
        worst = max(worst, float(np.abs(variance - 1).max()))
    assert worst < 4 * np.sqrt(2 / DRAWN)
    assert white.var() == pytest.approx(1.0, abs=0.02)
