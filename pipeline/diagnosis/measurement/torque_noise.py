"""The noise of the torque reading, and the apparent reversals that it causes."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.white_noise import white_noise

DEADBAND_SIGMAS = 2.0
"""Half a reversal that may be noise: two rows of noise differ by more than twice this once in 210 times."""
LARGEST_NOISE = 0.02
"""Largest noise over the largest torque. What looks like more is not noise. Judgement."""
COARSE_STEP = (1e-3, 0.035)
"""Of the largest torque: what is read in smaller steps is not seen to be, larger ones are a programme's."""
FEWEST_LEVELS = 30
"""Of torque: a reading in such steps has 60 to 2000 of them, a programme of stairs fewer."""
STEP_SHARE = 0.01
"""Share of a step within which two levels count as whole steps apart: decimals differ by their last bit."""
UNLIKE_RATIO, LEAST_OF_TYPICAL = 2.0, 0.05
"""Times the typical noise from which cycles have their own: by chance one of 24 rows has 1.5 times as much;
and of the typical one at least: a way of few rows is not known better."""
LEVELS_APART, LEVEL_WIDTH, FEWEST_OF_LEVEL = 10.0, 0.3, 3
"""Levels lie this many times as far apart as neighbouring readings typically do; none is wider than this part
of the least distance between two; and readings of each, on the average."""
RESTLESS_SHARE = 0.3
"""Of the rows, at which what is rounded changes its pace: two at each step, of seven rows and fewer."""


def deadband_Nm(history: History) -> float:
    """Half the reversal of torque that may be noise: what has a memory is driven without such."""
    return DEADBAND_SIGMAS * torque_noise_Nm(history)


def torque_noise_Nm(history: History, rows: np.ndarray | None = None) -> float:
    """White noise of the torque [N·m] in rows of the usual number of readings.

    Of the whole record or of some `rows`, those of a unit; the noisiest cycle's where cycles are unlike.
    """
    noise = noise_of_usual_rows_Nm(history)
    return float(noise.max() if rows is None else noise[rows].max())


def torque_noise_of_rows_Nm(history: History) -> np.ndarray:
    """(n,) of each row [N·m]: a mean of more readings has less."""
    noise = noise_of_usual_rows_Nm(history)
    if history.readings is None:
        return noise
    of_usual = np.median(history.readings[_usual(history)])
    return np.asarray(noise * np.sqrt(of_usual / history.readings))


def _usual(history: History) -> np.ndarray:
    """(n,) rows that are means of as many readings as most, within a factor of two."""
    if history.readings is None:
        return np.ones(len(history), bool)
    return np.asarray(2 * history.readings > np.median(history.readings))


@once
def noise_of_usual_rows_Nm(history: History) -> np.ndarray:
    """(n,) in rows of the usual number of readings [N·m].

    That of the typical unit; each cycle's own where one has UNLIKE_RATIO times as much.
    """
    none = np.zeros(len(history))
    if history.exact:
        return none
    usual = _usual(history)

    def of(parts: list[np.ndarray]) -> list[float | None]:
        own = (rows[usual[rows]] for rows in parts)
        return [white_noise(history.torque_Nm[rows], history.time_or_rows(rows)) for rows in own]

    units = [noise for noise in of(history.unit_slices) if noise is not None]
    if not units:
        return none
    most = LARGEST_NOISE * history.largest_Nm
    scatter = [_about_levels(history.torque_Nm[rows[usual[rows]]]) for rows in history.unit_slices]
    about_levels = [noise for noise in scatter if noise is not None]
    rounding = _rounding_Nm(history)
    if len(about_levels) == len(scatter) and not rounding:
        return np.full(len(history), min(float(np.median(about_levels)), most))
    typical = max(float(np.median(units)), rounding)
    cycles = history.cycle_slices
    each = [
        typical if noise is None else max(noise, LEAST_OF_TYPICAL * typical) for noise in of(cycles)
    ]
    if max(each) < UNLIKE_RATIO * typical:
        each = [typical] * len(each)
    noise_Nm = none
    for rows, noise in zip(cycles, each, strict=True):
        noise_Nm[rows] = min(noise, most)
    return noise_Nm


def _about_levels(torque_Nm: np.ndarray) -> float | None:
    """Scatter of readings about their levels [N·m]; None where they do not lie at few levels, far apart.

    A rig with weights, read once at each: from row to row torque moves by whole weights.
    """
    if len(torque_Nm) < FEWEST_OF_LEVEL:
        return None
    in_order = np.sort(torque_Nm)
    apart = np.diff(in_order)
    edges = np.flatnonzero(apart > LEVELS_APART * np.median(apart)) + 1
    levels = np.split(in_order, edges)
    few = 1 < len(levels) < FEWEST_LEVELS  # else they are the digits that a reading is written with
    if not few or len(levels) * FEWEST_OF_LEVEL > len(torque_Nm):
        return None
    if max(map(np.ptp, levels)) > LEVEL_WIDTH * apart[edges - 1].min():
        return None
    off = np.concatenate([level - level.mean() for level in levels])
    return float(np.sqrt((off**2).sum() / (len(off) - len(levels))))


def _rounding_Nm(history: History) -> float:
    """Deviation of what rounding does to a torque that is read in coarse steps, 0 where it is not.

    A programme of stairs has larger steps, and stays on each; ramps of equal steps change at their ends only.
    `torque_step_Nm` asks less: its steps are no noise where torque stays on each for many rows.
    """
    levels = np.unique(history.torque_Nm)
    if len(levels) < FEWEST_LEVELS or history.readings is not None:
        return 0.0
    steps = np.diff(levels)
    step = float(np.median(steps))
    restless = (np.abs(second_differences_Nm(history)) > step / 2).sum()
    seen = restless > RESTLESS_SHARE * len(history) and are_coarse(steps, step, history.largest_Nm)
    return step / np.sqrt(12) if seen else 0.0


def are_coarse(apart: np.ndarray, step: float, largest: float) -> bool:
    """Whether levels are whole steps `apart`, of a size that readings of a `largest` torque may have."""
    alike = np.abs(apart / step - np.round(apart / step)) < STEP_SHARE
    return bool(COARSE_STEP[0] * largest < step < COARSE_STEP[1] * largest and alike.all())


def second_differences_Nm(history: History) -> np.ndarray:
    """Of the torque from row to row, of all units in turn."""
    return np.concatenate([np.diff(history.torque_Nm[rows], 2) for rows in history.unit_slices])
