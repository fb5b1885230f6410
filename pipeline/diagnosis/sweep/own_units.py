"""The size of a cause that some of the units alone show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.magnitudes import magnitudes
from flexspline.pipeline.diagnosis.sweep.prepare import TooFewRowsError, prepare
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep, run_race


def size_in_units(
    explained: ExplainedSweep, cause: str, units: Sequence[int]
) -> tuple[float, float] | None:
    """Magnitude and standard deviation of a cause in these units, by a race on their rows alone.

    A race on all units finds the mean of them and of those without it, and takes what it misses of either for
    noise. None where these units alone do not show the cause.
    """
    prepared = explained.prepared
    own = of_units(prepared.sweep, units)
    try:
        again = prepare(own, prepared.prediction, prepared.offset_Nm, prepared.ahead)
    except TooFewRowsError:
        return None
    identified = run_race(again).identified
    if cause not in identified.named:
        return None
    size, std = magnitudes(identified)
    return size[cause], std[cause]


def of_units(sweep: Sweep, units: Sequence[int]) -> Sweep:
    """The rows of some units, as a record of its own; which rows of the file they are is not kept."""
    chosen = np.isin(sweep.history.unit, units)
    history = sweep.history.rows(chosen)
    return replace(
        sweep,
        history=replace(history, unit=np.searchsorted(np.sort(units), history.unit)),
        angle_arcsec=sweep.angle_arcsec[chosen],
        units=tuple(sweep.units[u] for u in sorted(units)),
        cycles=tuple(sweep.cycles[u] for u in sorted(units)),
        line=sweep.line[chosen],
        went_to=None,
    )
