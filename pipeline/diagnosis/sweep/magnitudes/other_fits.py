"""Other explanations of a record beside the best set: what they add to deviations of sizes."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, sqrt

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit

SHAPE_NATS = 3.0
"""Sets of shapes count in a magnitude's doubt by exp(−nats/3), of large effects by less: no shape is exactly
the gear's."""
MOST_ODDS = 50.0
"""Of another explanation over the best set's: its share is then 0.98. Judgement."""


@dataclass(frozen=True)
class OtherFits:
    """Fits of other explanations, and the share of each beside the best set's; together below 1."""

    fits: tuple[SweepFit, ...] = ()
    shares: tuple[float, ...] = ()

    def deviation(self, size: float, cause: str) -> float:
        """Of a cause's size by the other explanations, in which it may be missing."""
        none = known_causes()[cause].none
        sizes = [fit.magnitudes().get(cause, none) for fit in self.fits]
        return sqrt(sum(w * (x - size) ** 2 for w, x in zip(self.shares, sizes, strict=True)))


def odds(gained_nats: float, shape_nats: float = SHAPE_NATS) -> float:
    """How likely another explanation is beside the best set's, MOST_ODDS at most.

    It gains `gained_nats` of log evidence, of which `shape_nats` are a shape's that is not the gear's.
    """
    return exp(min(gained_nats / shape_nats, log(MOST_ODDS)))
