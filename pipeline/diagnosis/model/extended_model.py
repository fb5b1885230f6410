"""The extended model: the calibrated simulation and the causes found, as one forward model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.geometry.ranges import TORQUE_Nm
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.measurement.errors import ChannelError
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.shape_check import channels_needed

BEYOND_GEARS = f"is beyond ±{TORQUE_Nm.high:g} N·m, which no gear carries"
Channel = Sequence[float] | np.ndarray
"""One value for each row of a history."""


@dataclass(frozen=True)
class ExtendedModel:
    """θ = θ0 + T·compliance + sign(T)·gap/2 + what each cause adds; T is the true torque at the teeth.

    Attributes
    ----------
    compliance : [arcsec per N·m]; gap_arcsec : as calibrated within the design's uncertainty.
    zeros_arcsec : zero of each unit, by its name.
    own : of each unit, by its name, deviation of compliance and gap from the common ones.
    elements : of each cause, by its id.
    bend : of the simulated curve, None where it is a straight line.
    """

    compliance: float
    gap_arcsec: float
    zeros_arcsec: Mapping[str, float]
    elements: Mapping[str, tuple[Element, ...]]
    own: Mapping[str, tuple[float, float]]
    bend: Bend | None = None

    def angle_arcsec(
        self,
        torque_Nm: Channel,
        time_s: Channel | None = None,
        temperature_C: Channel | None = None,
        input_angle_deg: Channel | None = None,
        cycle: Channel | None = None,
        unit: str = "",
    ) -> np.ndarray:
        """(n,) angle [arcsec] for a history of torque, row by row; `unit` names the unit under test.

        Raises
        ------
        ChannelError : a channel that a cause of the model needs is missing, holds no finite numbers, or
            is not as long as the torque; time runs backwards; or a torque that no gear carries.
        """
        torque = _channel("torque_Nm", torque_Nm, torque_Nm)
        if (no_gear_s := first_beyond(torque)) is not None:
            raise ChannelError("torque_Nm", f"= {torque[no_gear_s]:g} {BEYOND_GEARS}")

        def maybe(name: str, values: Channel | None) -> np.ndarray | None:
            return None if values is None else _channel(name, values, torque)

        history = History(
            torque,
            np.zeros(len(torque), int),
            np.zeros(len(torque), int)
            if cycle is None
            else _channel("cycle", cycle, torque).astype(int),
            maybe("time_s", time_s),
            maybe("temperature_C", temperature_C),
            maybe("input_angle_deg", input_angle_deg),
            exact=True,
        )
        if history.time_s is not None and (np.diff(history.time_s) < 0).any():
            raise ChannelError("time_s", "runs backwards")
        for cause_id, elements in self.elements.items():
            for channel in channels_needed(known_causes()[cause_id], elements):
                if getattr(history, channel) is None:
                    raise ChannelError(channel, f"is missing; {cause_id} needs it")
        if not len(history):
            return np.empty(0)
        return self.angle_of(history, (unit,))

    def angle_of(self, history: History, units: tuple[str, ...] = ("",)) -> np.ndarray:
        """(n,) angle; `units` names the history's units. A unit not fitted has zero 0.

        Raises
        ------
        ValueError : the history lacks a channel that a cause needs.
        """
        true = self.at_teeth(self.true_history(history))
        angle = true.torque_Nm * self.compliance + true.sign * self.gap_arcsec / 2
        if self.bend is not None:
            angle += self.bend.at(true.torque_Nm)
        for cause_id, elements in self.elements.items():
            angle += known_causes()[cause_id].angle_arcsec(elements, true)
        for code, name in enumerate(units):
            rows = true.unit == code
            compliance, gap = self.own.get(name, (0.0, 0.0))
            angle[rows] += self.zeros_arcsec.get(name, 0.0)
            angle[rows] += compliance * true.torque_Nm[rows] + gap * true.sign[rows] / 2
        return angle

    def true_history(self, history: History) -> History:
        """The true history: the reading less what the causes find wrong in it."""
        for cause_id, elements in self.elements.items():
            history = known_causes()[cause_id].corrected(elements, history)
        return history

    def at_teeth(self, history: History) -> History:
        """A true history with the torque that is left for the teeth."""
        for cause_id, elements in self.elements.items():
            history = known_causes()[cause_id].at_teeth(elements, history)
        return history


def first_beyond(torque_Nm: np.ndarray) -> int | None:
    """The first torque (n,) that no gear carries, None where all may be."""
    beyond = np.flatnonzero(np.abs(torque_Nm) > TORQUE_Nm.high)
    return int(beyond[0]) if len(beyond) else None


def _channel(
    name: str, values: Sequence[float] | np.ndarray, torque: Sequence[float] | np.ndarray
) -> np.ndarray:
    """The values as numbers (n,), as many as torques."""
    try:
        channel, rows = np.atleast_1d(np.asarray(values, float)), np.size(torque)
    except (TypeError, ValueError):
        raise ChannelError(name, "must hold numbers, one for each row") from None
    if channel.ndim != 1 or len(channel) != rows:
        raise ChannelError(name, f"has the shape {channel.shape}, the torque has {rows} values")
    if not np.isfinite(channel).all():
        raise ChannelError(name, "holds a value that is not finite")
    return channel
