"""How well the size of a cause is known by one set of shapes, and whether it differs from none."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.decision import differs_from_none
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.identification.leakage import leaked
from flexspline.pipeline.diagnosis.sweep.identification.shape_posterior import magnitude_stds

CANCELLED_DOUBT = 0.003
"""Of what cancels between a cause's elements: two lags of opposite sign may stand for a delay. Of nine
made-up records with one, two deviations hold the truth in five without this, one deviation in all with it."""


@dataclass(frozen=True)
class SizeDoubt:
    """Magnitudes of a fit's causes by id, and the standard deviation of each but for other sets of shapes.

    It holds the posterior's of amplitudes and shapes together, the doubt that a law has any of these shapes,
    what cancels between a cause's elements, and what the misfit of other causes' shapes adds.
    """

    fit: SweepFit
    magnitude: dict[str, float]
    std: dict[str, float]

    @classmethod
    def of(cls, fit: SweepFit) -> SizeDoubt:
        """Of all causes of a fit."""
        magnitude, slopes = fit.magnitudes(), fit.magnitude_slopes()
        own, of_others = magnitude_stds(fit, slopes), leaked(fit, slopes)
        std = {
            c: hypot(
                own[c],
                known_causes()[c].shape_doubt * abs(value),
                CANCELLED_DOUBT * _cancelled(fit, c, value),
                of_others[c],
            )
            for c, value in magnitude.items()
        }
        return cls(fit, magnitude, std)

    def is_significant(self, cause: str) -> bool:
        """Whether a size is far enough from none (`../decision.py`).

        That a term helps is sure by its evidence; that it is this cause, and not what others' shapes miss, is
        only as sure as its size. Friction counts by its loop where that is widest.
        """
        size = self.fit.widest_loop_arcsec() if cause == FRICTION else self.magnitude[cause]
        off, std = abs(size - known_causes()[cause].none), self.std[cause]
        return differs_from_none(cause, off / std if std > 0 else inf)


def _cancelled(fit: SweepFit, cause: str, magnitude: float) -> float:
    """How much larger a cause's elements are one by one than together; 0 where they do not add up."""
    rig, known = fit.measured_rig(), known_causes()[cause]
    each = [known.magnitude((e,), rig) for e in fit.elements().get(cause, ())]
    adds_up = abs(sum(each) - magnitude) <= 1e-6 * sum(map(abs, each))  # but for rounding
    return sum(map(abs, each)) - abs(magnitude) if len(each) > 1 and adds_up else 0.0
