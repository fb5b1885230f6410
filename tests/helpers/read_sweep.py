"""A torque sweep as it would be read from a file, of a course of torque that a test writes out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from histories import PREDICTION

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep

NOISE = 0.5
"""Arcsec."""


def steps(largest_Nm: float, each_quarter: int) -> np.ndarray:
    """One cycle 0 → + → − → 0 in even steps of torque [N·m]."""
    up = np.arange(1, each_quarter + 1) / each_quarter
    down = 1 - np.arange(1, 2 * each_quarter + 1) / each_quarter
    return largest_Nm * np.concatenate([up, down, up - 1])


def history_of(cycle: np.ndarray, count: int, row_s: float = 1.0) -> History:
    """A cycle of torque, again and again, of rows even in time."""
    torque = np.tile(cycle, count)
    number = np.repeat(np.arange(count), len(cycle))
    return History(torque, np.zeros(len(torque), int), number, row_s * np.arange(len(torque)))


def simulated(history: History) -> np.ndarray:
    """(n,) angle [arcsec] of the gear as simulated."""
    return PREDICTION.compliance * history.torque_Nm + PREDICTION.gap_arcsec / 2 * history.sign


def read(history: History, angle_arcsec: np.ndarray, seed: int) -> Sweep:
    """The record, with noise."""
    return as_read(
        history, angle_arcsec + np.random.default_rng(seed).normal(0, NOISE, len(history))
    )


def as_read(history: History, angle_arcsec: np.ndarray) -> Sweep:
    """The record of one unit with these readings, its cycles counted from 1, under a head of one line."""
    cycles = (tuple(np.unique(history.cycle) + 1.0),)
    line = np.arange(len(history)) + 2
    return Sweep(Path("rig.csv"), history, angle_arcsec, ("",), cycles, line, True)
