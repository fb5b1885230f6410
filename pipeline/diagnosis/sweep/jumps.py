"""Whether the output sticks and breaks away at random: jumps of the residual with the torque's motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.noise import stretches_of
from flexspline.pipeline.diagnosis.sweep.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep

BLOCKS = (1, 2, 4, 8)
"""Rows whose means are compared: a jump stands for longer than noise does."""
SURE = 1e-5
"""p-value: eight channels and this are tested, and the verdict rests on it."""
FINEST_ARCSEC = 1e-4
"""Readings that differ by less differ by the digits of a conversion: no encoder is finer."""
FEWEST = 20
"""Steps: of so few large ones z reaches 4.5 at the most, which is what `SURE` asks for."""


@dataclass(frozen=True)
class Jumps:
    """The p-value of jumps with the motion, and the saw-tooth's rms."""

    p_value: float
    rms_arcsec: float


def jumps_of(prepared: PreparedSweep, fit: SweepFit) -> Jumps | None:
    """Jumps that the best explanation leaves; None where they are no more with the motion than by chance.

    An output that sticks falls behind the torque little by little and comes after at once: its residual
    creeps against the motion and jumps with it, so its steps along the motion, less their median, are skew.
    Those of noise of any colour, and of a smooth misfit, go either way alike: with their signs exchanged at
    random Σf³/√Σf⁶ has the mean 0 and the deviation 1, whatever their distribution. The saw-tooth passes for
    coloured noise: its rms is that of the residual less the white part. An encoder's own saw-tooth has
    an rms of 1/√12 of its step: what is below a whole step is none.
    """
    history, kept = prepared.rig.history, prepared.kept
    left, motion = fit.residual()[kept], direction_of_loading(history)[kept]
    pieces = stretches_of(history, kept)
    found = [_skewness(left, motion, pieces, rows) for rows in BLOCKS]
    p_value = min(1.0, len(BLOCKS) * float(ndtr(-max(found))))
    if p_value > SURE:
        return None
    saw_tooth = float(np.sqrt(max(float(np.var(left)) - prepared.noise.white, 0.0)))
    if saw_tooth < _encoder_step(prepared.sweep.angle_arcsec):
        return None
    return Jumps(p_value, saw_tooth)


def _encoder_step(angle_arcsec: np.ndarray) -> float:
    """Least difference between two readings [arcsec]: an encoder's readings jump with the motion too."""
    apart = np.diff(np.unique(np.round(angle_arcsec / FINEST_ARCSEC))) * FINEST_ARCSEC
    return float(apart.min()) if len(apart) else 0.0


def _skewness(left: np.ndarray, motion: np.ndarray, pieces: list[slice], rows: int) -> float:
    """Σf³/√Σf⁶ of the steps f along the motion between means of so many rows; 0 of too few."""
    steps = []
    for s in pieces:
        count = (s.stop - s.start) // rows
        whole = slice(s.start, s.start + count * rows)
        means = left[whole].reshape(count, rows).mean(axis=1)
        ways = motion[whole].reshape(count, rows)
        steady = (ways == ways[:, :1]).all(axis=1)
        way = ways[:, 0]
        same = steady[1:] & steady[:-1] & (way[1:] == way[:-1])
        steps.append((np.diff(means) * way[1:])[same & (way[1:] != 0)])
    along = np.concatenate(steps) if steps else np.empty(0)
    if len(along) < FEWEST:
        return 0.0
    along = along - np.median(along)
    power = float((along**6).sum())
    return float((along**3).sum()) / power**0.5 if power > 0 else 0.0
