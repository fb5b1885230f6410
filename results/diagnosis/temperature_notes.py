"""Notes on the role of temperature in the causes found."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.causes.thermal_clearance import THERMAL
from flexspline.pipeline.diagnosis.outcome import NamedCause, Unexplained
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification
from flexspline.pipeline.diagnosis.sweep.magnitudes.thermal_lag import thermal_lag
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.results.diagnosis.words import title_of
from flexspline.results.numbers import signed


def lag_notes(identified: Identification) -> list[str]:
    """That the gap follows the temperature late, where the model has it so."""
    lag = thermal_lag(identified)
    if lag is None:
        return []
    times = joined((f"{s:.3g}" for s in lag.lags_s), "and")
    note = (
        f"{title_of(THERMAL)}: in the model the gap follows the temperature with a lag of {times} s"
    )
    if lag.stages > 1:
        note += " (two lags in series)"
    if lag.warmer_K:
        side = "warmer" if lag.warmer_K > 0 else "colder"
        note += f", starting {abs(lag.warmer_K):.2g} K {side} than the reading"
    if not lag.shown:
        note += "; a model without a lag explains this record nearly as well"
    return [note]


def zero_notes(explained: ExplainedSweep, unexplained: Iterable[Unexplained]) -> list[str]:
    """How much a zero without a name changes with temperature, if nothing else of that channel is found."""
    temperature = explained.prepared.rig.history.temperature_C
    kinds = [
        [form.kind for form in u.structure]
        for u in unexplained
        if u.channel == "temperature_C" and isinstance(u.structure, tuple)
    ]
    if temperature is None or ["changing_zero"] not in kinds:
        return []
    kept = explained.prepared.kept
    zero = explained.identified.fit.added("?temperature_C")
    per_K = float(np.polyfit(temperature[kept], zero[kept], 1)[0])
    return [
        f"the zero offset changes by {signed(per_K, 2)} arcsec/K (straight line over all temperatures): "
        "compare with the data sheet of the angle sensor"
    ]


def drift_notes(causes: Iterable[NamedCause]) -> list[str]:
    """That a drift may follow the temperature."""
    return [
        f"{title_of(c.id)}: time and temperature changed together in this record; a zero offset that follows "
        "the temperature fits it as well"
        for c in causes
        if c.or_temperature
    ]
