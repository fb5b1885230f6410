"""Data of the sweep figures: residuals, branches and channels as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.analysis import SweepAnalysis
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import calibrated_residual, less_zero
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import ChannelTest
from flexspline.pipeline.diagnosis.timeless import over_rows
from flexspline.results.diagnosis.channels import CHANNELS

MOST_DRAWN_POINTS = 4000
"""Drawn in one panel; of more, every k-th is drawn."""
LONGEST_NAME = 12
"""Letters of a name below an axis; where one is longer, all are numbered instead."""


@dataclass(frozen=True)
class PlotChannel:
    """A recorded channel: its axis label, values (n,), and names of its levels where it has any."""

    key: str
    label: str
    values: np.ndarray
    levels: tuple[str, ...] = ()


@dataclass(frozen=True)
class SweepPictureData:
    """A sweep's diagnosis as arrays over its rows."""

    diagnosis: Diagnosis
    analysis: SweepAnalysis

    @property
    def explained(self) -> ExplainedSweep:
        return self.analysis.explained

    @property
    def tests(self) -> tuple[ChannelTest, ...]:
        """Of what the best model leaves, in each channel."""
        return self.analysis.tests

    @property
    def fit(self) -> SweepFit:
        return self.explained.identified.fit

    @property
    def history(self) -> History:
        """The true history: a shifted torque reading is corrected, its torque that at the teeth."""
        return self.explained.prepared.rig.history

    @cached_property
    def carried_Nm(self) -> np.ndarray:
        """(n,) what friction takes of the torque ahead of the teeth; 0 where there is none."""
        ahead = self.fit.evidence.columns.ahead
        return np.zeros(len(self.history)) if ahead is None else ahead.carried_Nm

    @cached_property
    def output_Nm(self) -> np.ndarray:
        """(n,) torque on the output: the reading, put right where it is shifted."""
        return self.history.torque_Nm + self.carried_Nm

    @property
    def kept(self) -> np.ndarray:
        return self.explained.prepared.kept

    @property
    def largest_Nm(self) -> float:
        return float(np.abs(self.output_Nm).max())

    @property
    def noise_arcsec(self) -> float:
        return self.explained.prepared.noise.std_arcsec

    @cached_property
    def rises(self) -> np.ndarray:
        """(n,) whether torque rises."""
        return direction_of_loading(self.history) >= 0

    @cached_property
    def left(self) -> np.ndarray:
        """(n,) measured less the best model."""
        return self.fit.residual()

    @cached_property
    def calibrated(self) -> np.ndarray:
        """(n,) measured less the simulation alone, calibrated as far as its uncertainty goes."""
        return calibrated_residual(self.fit.evidence)

    @cached_property
    def nominal(self) -> np.ndarray:
        """(n,) measured less the angle simulated at the output's torque, the zero of each unit fitted."""
        prepared = self.explained.prepared
        at_output = replace(self.history, torque_Nm=self.output_Nm)
        off = prepared.sweep.angle_arcsec - prepared.prediction.angle_arcsec(at_output)
        return less_zero(off, self.kept, self.history)

    @property
    def channels(self) -> list[PlotChannel]:
        """Channels that were recorded and vary."""
        sweep, h = self.explained.prepared.sweep, self.history
        recorded = [PlotChannel("torque_Nm", CHANNELS["torque_Nm"].label, self.output_Nm)]
        if sweep.history.time_s is not None and h.time_s is not None:
            recorded.append(_time(h.time_s))
        if h.cycle.max() > 0:
            recorded.append(PlotChannel("cycle", CHANNELS["cycle"].label, sweep.own_cycle))
        if h.temperature_C is not None:
            recorded.append(
                PlotChannel("temperature_C", CHANNELS["temperature_C"].label, h.temperature_C)
            )
        if h.input_angle_deg is not None:
            recorded.append(
                PlotChannel("input_angle_deg", CHANNELS["input_angle_deg"].label, h.input_angle_deg)
            )
        if len(sweep.units) > 1:
            names = plain_names(sweep.units)
            recorded.append(
                PlotChannel("unit", CHANNELS["unit"].label, h.unit.astype(float), names)
            )
        return [c for c in recorded if np.ptp(c.values) > 0]

    def channel_name(self, key: str) -> str:
        """The name by which structure in a channel is said: in time only where time was recorded."""
        timed = self.explained.prepared.sweep.history.time_s is not None
        return key if timed else over_rows(key)

    def channel(self, key: str) -> PlotChannel:
        """The channel of that name; torque where it was not recorded."""
        return next((c for c in self.channels if c.key == key), self.channels[0])


def seen(diagnosis: Diagnosis) -> SweepPictureData | None:
    """None where no race was run."""
    return None if diagnosis.sweep is None else SweepPictureData(diagnosis, diagnosis.sweep)


def thinned(rows: np.ndarray) -> np.ndarray:
    """Row numbers of a mask, no more than can be told apart."""
    indices = np.flatnonzero(rows)
    return indices[:: max(1, -(-len(indices) // MOST_DRAWN_POINTS))]


def plain_names(names: tuple[str, ...]) -> tuple[str, ...]:
    """Names short and plain enough for an axis; else their numbers."""
    good = all(n.isascii() and n.isprintable() and len(n) <= LONGEST_NAME for n in names)
    return tuple(n.replace("$", r"\$") if good else f"{i + 1}" for i, n in enumerate(names))


def _time(seconds: np.ndarray) -> PlotChannel:
    passed = seconds - seconds.min()
    longest = passed.max()
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if longest > 3 * size:
            return PlotChannel("time_s", f"time in {unit}", passed / size)
    return PlotChannel("time_s", CHANNELS["time_s"].label, passed)
