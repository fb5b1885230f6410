"""Physical limits that an explanation of a sweep keeps, whatever its evidence."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import NamedCause, Unexplained
from flexspline.pipeline.diagnosis.plausibility import far_slope, slope_beyond
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import Drowned, LeapingAngle
from flexspline.pipeline.diagnosis.structure import NegativeGap, UnnamedForm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rig_faults.angle_jumps import leaps_of
from flexspline.pipeline.diagnosis.sweep.rig_faults.clamp_slip import slip_of
from flexspline.pipeline.diagnosis.sweep.twist_ratio import simulated_twist_arcsec, sweep_size

MOST_SLOPE_RATIO = 10.0
"""Largest ratio of measured and simulated slope. No part that is left out or stated wrongly exceeds it.
Judgement."""
SLOW_SHARE = 0.04
"""Slow noise over the simulated twist from end to end. With more noise, nothing can be compared.
Judgement."""
NEGATIVE_GAP_DEVIATIONS = 3.0
"""Standard deviations below 0 at which a gap is negative: one in 740."""


def broken_limit(
    sweep: Sweep, explained: ExplainedSweep, causes: tuple[NamedCause, ...]
) -> Unexplained | None:
    """A limit that the best explanation breaks, with its channel; None where it keeps all.

    What springs comes back, a gear is not ten times softer or stiffer than drawn, and no gap is negative.
    """
    prepared, fit = explained.prepared, explained.identified.fit
    slip = slip_of(prepared.rig.history, prepared.sweep.angle_arcsec)
    if slip is not None:
        return Unexplained("torque_Nm", slip.slip_arcsec, 0.0, slip)
    size = sweep_size(prepared.rig.history, prepared.sweep.angle_arcsec, prepared.prediction)
    if size is not None and slope_beyond(size, MOST_SLOPE_RATIO):
        return Unexplained("torque_Nm", size.residual_arcsec, 0.0, far_slope(size, sweep))
    gap, std = _gap(fit, causes, prepared.prediction)
    if gap + NEGATIVE_GAP_DEVIATIONS * std < 0:
        return Unexplained("torque_Nm", abs(gap) / 2, 0.0, NegativeGap(gap, std))
    return None


def slow_noise(explained: ExplainedSweep) -> Unexplained | None:
    """Noise with a memory, where it is too large for a record to agree with a simulation; None else."""
    noise = explained.identified.search.evidence.noise
    twist = simulated_twist_arcsec(
        explained.prepared.rig.history.torque_Nm, explained.prepared.prediction
    )
    rms = noise.coloured**0.5
    if rms <= max(SLOW_SHARE * twist, noise.white**0.5):
        return None
    return Unexplained("time_s", rms, 0.0, (UnnamedForm("slow_noise"),))


def drowned(explained: ExplainedSweep) -> Drowned | LeapingAngle | None:
    """Noise, or leaps that pass for it, that hide everything; None where one reading's is below the twist."""
    prepared = explained.prepared
    noise = explained.identified.search.evidence.noise.std_arcsec
    twist = simulated_twist_arcsec(prepared.rig.history.torque_Nm, prepared.prediction)
    if noise <= twist:
        return None
    leaps = leaps_of(prepared.sweep.history, prepared.sweep.angle_arcsec)
    return Drowned(noise, twist) if leaps is None else LeapingAngle(leaps, twist)


def _gap(
    fit: SweepFit, causes: tuple[NamedCause, ...], prediction: Prediction
) -> tuple[float, float]:
    """The whole gap at 20 °C as the record has it, and its deviation [arcsec]."""
    changed = next((c for c in causes if c.id == CLEARANCE), None)
    if changed is not None:
        return prediction.gap_arcsec + changed.magnitude, changed.magnitude_std
    gap = fit.calibration.gap_arcsec
    return gap.value, gap.std
