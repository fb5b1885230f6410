"""By how much the encoder's rounding, which is no noise, moves what was fitted.

Rounding that noise does not dither is the same in every cycle, and follows the programme: of torque in even
steps, all readings of a branch may be rounded to one side. More rows do not make it smaller.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from flexspline.pipeline.diagnosis.measurement.encoder_step import (
    ROUNDING_RATIO,
    common_step,
    undithered,
)
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import column_indices
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep

TRIED_GEARS = 48
"""Gears near the fitted one whose readings are rounded: the deviation is then known to a tenth."""
HARMONICS = 12
"""Of the saw-tooth: those beyond hold 5 % of its square."""
LEAST_LEFT = 0.03
"""Of the rms of a rounding that is not dithered. With less, normal noise of 0.42 steps and more, it is less
than a hundredth of a step."""
_GENERATORS = np.array([0.8191725134, 0.6710436067, 0.5497004779])
"""Of a lattice that fills a cube evenly: powers of the inverse of the root of x⁴ = x + 1 (Roberts 2018)."""


@dataclass(frozen=True)
class RoundingError:
    """Errors (k, p) of a fit's parameters, of gears that differ from the fitted one by less than a step.

    The true zero, compliance and gap are not known to a fraction of the encoder's step, and this
    fraction decides which readings are rounded up.
    """

    errors: np.ndarray

    @classmethod
    def of(cls, prepared: PreparedSweep, fit: SweepFit) -> RoundingError:
        """None of the errors is above 0 where noise dithers the encoder."""
        posterior, evidence = fit.posterior, fit.evidence
        step, kept_share = _undithered_step(prepared, fit)
        if kept_share < LEAST_LEFT:
            return cls(np.zeros((1, len(posterior.mean))))
        history = fit.rig.history
        angle = prepared.sweep.angle_arcsec - fit.residual()
        off = (np.arange(TRIED_GEARS)[:, None] * _GENERATORS + 0.5) % 1 - 0.5
        sides = [np.ones(len(angle)), history.sign / 2, history.torque_Nm / history.largest_Nm]
        each = angle[:, None] + step * np.column_stack(sides) @ off.T
        rounded = evidence.whitened(_sawtooth(each / step, kept_share) * step)
        at = column_indices(evidence, posterior.terms)
        scale = np.concatenate([np.ones(posterior.base_count), evidence.scale[at]])
        model = np.hstack([evidence.base, evidence.x[:, at]]) / scale
        return cls((posterior.covariance @ (model.T @ rounded)).T)

    def std(self, slopes: np.ndarray) -> float:
        """Of a quantity with these slopes (p,) for the parameters, in its unit."""
        return float(np.sqrt(np.mean((self.errors @ slopes) ** 2)))


def _undithered_step(prepared: PreparedSweep, fit: SweepFit) -> tuple[float, float]:
    """The encoder's step [arcsec], and the share of its rounding's rms that is not dithered."""
    sweep = prepared.sweep
    step = sweep.encoder_step_arcsec or common_step(sweep.angle_arcsec)
    left = sqrt(undithered(prepared.variance_of_readings(fit.measured_rig().compliance), step))
    return step, left * sqrt(ROUNDING_RATIO) / step if step > 0 else 0.0


def _sawtooth(steps: np.ndarray, kept_share: float) -> np.ndarray:
    """Mean of the rounded less the true reading, both in steps, under noise that keeps a share of its rms."""
    if kept_share > 1 - 1e-6:  # without noise the series below would not fall off
        return np.asarray(np.round(steps) - steps)
    off = np.zeros(steps.shape)
    for k in range(1, HARMONICS + 1):
        size = (-1) ** k * kept_share ** (k**2) / (np.pi * k)
        if abs(size) * np.pi * k < LEAST_LEFT**2:
            break
        off += size * np.sin(2 * np.pi * k * steps)
    return off
