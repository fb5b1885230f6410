"""Whether the output sticks and breaks away at random: jumps of the residual with the torque's motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.measurement.encoder_step import ROUNDING_RATIO
from flexspline.pipeline.diagnosis.measurement.noise import stretches_of
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.residual.multiple_tests import p_value_of_best
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import STRUCTURE_P_VALUE
from flexspline.pipeline.diagnosis.sweep.residual.rounding import rounding_of_angle

JUMP_BLOCK_ROWS = (1, 2, 4, 8)
"""Rows whose means are compared: a jump stands for longer than noise does."""
FEWEST_JUMP_STEPS = 20
"""Steps: of so few large ones the test reaches 4.5 deviations at the most, and `STRUCTURE_P_VALUE` asks for
4.1."""


@dataclass(frozen=True)
class Jumps:
    """The p-value of jumps with the motion, and the saw-tooth's rms."""

    p_value: float
    rms_arcsec: float


def largest(*jumps: Jumps | None) -> Jumps | None:
    """Of the same saw-tooth, seen by several tests: the largest rms; None where none sees any."""
    return max((f for f in jumps if f is not None), key=lambda f: f.rms_arcsec, default=None)


def jumps_of(prepared: PreparedSweep, fit: SweepFit) -> Jumps | None:
    """Jumps that the best explanation leaves; None where they are no more with the motion than by chance.

    An output that sticks falls behind the torque little by little and comes after at once: its residual
    creeps against the motion and jumps with it, so its steps f along the motion, less their mean, are skew.
    Those of noise of any colour, and of a smooth misfit, go either way alike: Σ(f³ − 3σ²f), of which the part
    in f is zero, has the mean 0 and the deviation √Σ(f³ − 3σ²f)². The saw-tooth passes for
    coloured noise: its rms is that of the residual less the white part, or, where jumps from row to row have
    passed for white noise as well, that of all the residual. An encoder's own saw-tooth has
    an rms of 1/√12 of its step: what is below a whole step is none, unless noise dithers the readings.
    """
    history, kept = prepared.rig.history, prepared.kept
    left, motion = fit.residual()[kept], direction_of_loading(history)[kept]
    pieces = stretches_of(history, kept)
    skewnesses = [_skewness(left, motion, pieces, rows) for rows in JUMP_BLOCK_ROWS]
    p_value = p_value_of_best(float(ndtr(-max(skewnesses))), len(skewnesses))
    if p_value > STRUCTURE_P_VALUE:
        return None
    every = float(np.var(left))
    coloured = every - prepared.noise.white
    saw_tooth = float(np.sqrt(coloured if coloured > 0 else every))
    if saw_tooth**2 < ROUNDING_RATIO * rounding_of_angle(prepared, fit).left_arcsec ** 2:
        return None
    return Jumps(p_value, saw_tooth)


def _skewness(left: np.ndarray, motion: np.ndarray, pieces: list[slice], rows: int) -> float:
    """Of the steps along the motion between means of so many rows, in deviations; 0 of too few."""
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
    if len(along) < FEWEST_JUMP_STEPS:
        return 0.0
    along = along - along.mean()
    skew = along**3 - 3 * float((along**2).mean()) * along
    power = float((skew**2).sum())
    return float(skew.sum()) / power**0.5 if power > 0 else 0.0
