"""The size of a cause that some of the units alone show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.sweep.magnitudes import magnitudes
from flexspline.pipeline.diagnosis.sweep.prepare import TooFewRowsError, prepare
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep, run_race


@dataclass(frozen=True)
class CauseSize:
    """Magnitude of a cause with its standard deviation, in its unit; rms [arcsec] of what it adds.

    `widest_arcsec` : of friction, its loop where it is widest; None of other causes.
    """

    magnitude: float
    std: float
    rms_arcsec: float
    widest_arcsec: float | None


def sizes_in_units(explained: ExplainedSweep, units: Sequence[int]) -> dict[str, CauseSize]:
    """Sizes of the causes that a race on the rows of these units alone names, by their ids.

    A race on all units finds the mean of them and of those without a cause, and takes what it misses of
    either for noise.
    """
    prepared = explained.prepared
    own = of_units(prepared.sweep, units)
    try:
        again = prepare(own, prepared.prediction, prepared.offset_Nm, prepared.ahead)
    except TooFewRowsError:
        return {}
    alone = run_race(again)
    size, std = magnitudes(alone.identified)
    return {c: size_of(alone, c, size[c], std[c]) for c in alone.identified.named}


def size_of(explained: ExplainedSweep, cause: str, magnitude: float, std: float) -> CauseSize:
    """The size of a cause of a race, with what else is said of it."""
    identified = explained.identified
    widest = identified.fit.widest_loop_arcsec() if cause == FRICTION else None
    return CauseSize(magnitude, std, identified.rms[cause], widest)


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
