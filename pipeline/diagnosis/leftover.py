"""What the best model leaves, tested in every channel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2 as chi2_distribution

from pipeline.diagnosis.noise import stretches_of
from pipeline.diagnosis.sweep import Prepared
from pipeline.diagnosis.effects.operators import rising

BINS = 12
FEWEST_PER_BIN = 5
SIGNIFICANT = 1e-4
"""p-value below which a channel's structure is said; eight channels are tested."""


@dataclass(frozen=True)
class ChannelTest:
    """Means of the residual in bins of one channel: structure's rms [arcsec], and its p-value."""

    channel: str
    rms_arcsec: float
    p_value: float


def channel_tests(prepared: Prepared, left: np.ndarray) -> list[ChannelTest]:
    """Test the residual `left` (n,) of a model against each channel.

    Bin means of the whitened residual are independent with variance 1/count where nothing is left;
    bins are whitened with it, so that coloured noise does not pass for structure.
    """
    history, kept = prepared.rig.history, prepared.kept
    found = []
    for channel, values in _channels(prepared).items():
        codes = _bins(values[kept])
        levels = codes.max() + 1
        if levels < 2:
            continue
        onehot = (codes[:, None] == np.arange(levels)).astype(float)
        stretches = stretches_of(history, kept)
        x = prepared.noise.whitened(onehot, stretches)
        y = prepared.noise.whitened(left[kept], stretches)
        gram = x.T @ x + 1e-9 * np.eye(levels)
        mean = np.linalg.solve(gram, x.T @ y)
        statistic = float(mean @ (x.T @ y))
        share = onehot.mean(axis=0)
        noise_part = float(share @ np.diag(np.linalg.inv(gram)))
        rms = float(np.sqrt(max(0.0, share @ (mean - share @ mean) ** 2 - noise_part)))
        found.append(ChannelTest(channel, rms, float(chi2_distribution.sf(statistic, levels - 1))))
    return found


def _channels(prepared: Prepared) -> dict[str, np.ndarray]:
    h = prepared.rig.history
    side = rising(h, 0.02 * prepared.rig.torque_Nm)
    found: dict[str, np.ndarray] = {
        "torque_Nm": h.torque_Nm,
        "direction": h.torque_Nm + 4 * prepared.rig.torque_Nm * side,
        "cycle": h.cycle.astype(float),
    }
    if prepared.sweep.history.time_s is not None and h.time_s is not None:
        found["time_s"] = h.time_s
    if h.temperature_C is not None:
        found["temperature_C"] = h.temperature_C
    if h.input_angle_deg is not None:
        found["input_angle_deg"] = h.input_angle_deg
    if len(prepared.sweep.units) > 1:
        found["unit"] = h.unit.astype(float)
    return found


def _bins(values: np.ndarray) -> np.ndarray:
    """(n,) bin of each value: levels where they are few, else equal counts."""
    levels = np.unique(values)
    if len(levels) <= BINS:
        return np.searchsorted(levels, values)
    count = int(min(BINS, max(2, len(values) // FEWEST_PER_BIN)))
    edges = np.unique(np.quantile(values, np.linspace(0, 1, count + 1)[1:-1]))
    return np.searchsorted(edges, values, side="right")
