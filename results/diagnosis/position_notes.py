"""Wave generator angles at which structure over the cycles lies, where each cycle has its own angle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import calibrated_residual
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep

FEWEST_POSITIONS = 4
"""Wave generator angles; with fewer, no usual one is left beside one that stands out."""
STANDS_OUT_RATIO = 3.0
"""Times the median rms over the angles, from which one stands out. Judgement."""
MOST_NAMED_SHARE = 0.25
"""Of the angles: if more stand out, the effect is not one of places."""


def position_notes(explained: ExplainedSweep, unexplained: Sequence[Unexplained]) -> list[str]:
    """The angles whose residual stands out; none where cycles and angles do not go together."""
    prepared = explained.prepared
    history, kept = prepared.rig.history, prepared.kept
    position = history.input_angle_deg
    if position is None or not any(u.channel == "cycle" for u in unexplained):
        return []
    visits = 1 + np.count_nonzero(np.diff(position))
    if visits > len(np.unique(position)):  # an angle that comes again is told from a cycle
        return []
    left = calibrated_residual(explained.identified.fit.evidence)
    places = np.unique(position[kept])
    sizes = np.array([rms(left[kept & (position == p)]) for p in places])
    out = sizes > STANDS_OUT_RATIO * np.median(sizes)
    if len(places) < FEWEST_POSITIONS or not 0 < out.sum() <= MOST_NAMED_SHARE * len(places):
        return []
    angles = joined((f"{p:.4g}°" for p in places[out]), "and")
    largest = joined((f"{s:.2g}" for s in sizes[out]), "and")
    return [
        f"the residual is large at the wave generator's angle of {angles}: {largest} arcsec rms, elsewhere "
        f"{np.median(sizes):.2g}. Each cycle has its own angle, so the effect may come from the angle (a "
        "damaged tooth or ball) and not from the cycle: measure these angles again in another order"
    ]
