"""Error in the angle by the rounding of both readings: a saw-tooth, the same at every pass."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

from flexspline.pipeline.diagnosis.measurement.encoder_step import undithered
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.measurement.torque_step import torque_step_Nm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep

FINEST_ENCODER = 1e-5
"""Step over the twist's span: finer ones, 29 bits a turn at 200 arcsec, are a file's last digits."""
NOISE_SHARE = 0.5
"""Share of the variance of white noise. If rounding leaves less, it is not visible in the noise."""


@dataclass(frozen=True)
class Rounding:
    """Of one reading.

    Attributes
    ----------
    step : between two readings, arcsec or N·m.
    left_arcsec : rms in the angle.
    is_seen : whether that is not lost in the angle's white noise, and the step is no file's last digit.
    """

    step: float
    left_arcsec: float
    is_seen: bool


def rounding_left_arcsec(prepared: PreparedSweep, fit: SweepFit) -> float:
    """Rms [arcsec] by both readings: no effect of angle or torque can be told below it."""
    angle, torque = rounding_of_angle(prepared, fit), rounding_of_torque(prepared, fit)
    return hypot(angle.left_arcsec, torque.left_arcsec)


def rounding_of_angle(prepared: PreparedSweep, fit: SweepFit) -> Rounding:
    """By the encoder's steps: a saw-tooth over the angle, the same at every pass.

    Means of a programme in step with the encoder keep all of it.
    """
    angle, step = prepared.sweep.angle_arcsec, prepared.sweep.encoder_step_arcsec
    left = sqrt(undithered(prepared.variance_of_readings(fit.measured_rig().compliance), step))
    is_steps = step >= FINEST_ENCODER * (angle.max() - angle.min())
    return Rounding(step, left, is_steps and _is_seen(left, prepared))


def rounding_of_torque(prepared: PreparedSweep, fit: SweepFit) -> Rounding:
    """By the steps of the torque reading, through the compliance that `fit` measured."""
    history = prepared.sweep.history
    step = torque_step_Nm(history)
    left = fit.measured_rig().compliance * sqrt(undithered(torque_noise_Nm(history) ** 2, step))
    return Rounding(step, left, _is_seen(left, prepared))


def _is_seen(left_arcsec: float, prepared: PreparedSweep) -> bool:
    return left_arcsec > 0 and left_arcsec**2 >= NOISE_SHARE * prepared.noise.white
