"""What the rounding of both readings leaves in the angle: a saw-tooth, the same at every pass."""

from __future__ import annotations

from math import hypot, sqrt

from flexspline.pipeline.diagnosis.measurement.encoder_step import rounding_arcsec, undithered
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.measurement.torque_step import torque_step_Nm
from flexspline.pipeline.diagnosis.sweep.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep


def rounding_left_arcsec(prepared: PreparedSweep, fit: SweepFit) -> float:
    """Rms [arcsec]: no effect of angle or torque can be told below it."""
    of_angle = rounding_arcsec(prepared.sweep.angle_arcsec, prepared.noise.white)
    return hypot(of_angle, torque_rounding_left_arcsec(prepared, fit))


def torque_rounding_left_arcsec(prepared: PreparedSweep, fit: SweepFit) -> float:
    """That of a torque read in coarse steps alone."""
    history = prepared.sweep.history
    rounded = undithered(torque_noise_Nm(history) ** 2, torque_step_Nm(history))
    return fit.measured_rig().compliance * sqrt(rounded)
