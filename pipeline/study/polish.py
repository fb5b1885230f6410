"""The last part of an optimisation: steps around the best design, shorter while none is better.

TPE finds the right region and then closes in slowly: a tenth of its candidates are drawn from wide kernels
for good. A (1+1) evolution strategy with Rechenberg's rule (a success lengthens the step, failures shorten
it) closes in fast. It acts on numbers; listed values are mostly kept.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.pipeline.study.claims import ROW

if TYPE_CHECKING:
    from optuna.trial import FrozenTrial

BEGINS = 0.5
"""Share of the evaluations after which every second design is a step about the best, …"""
POLISH_FROM = 0.75
"""… and after which all are."""
FIRST_STEP = 0.12
"""Of a key's span, one standard deviation. Judgement: an eighth of it."""
SHORTER = 0.85
"""Per failure; with STEP_GROWTH it rests at one success in five or so (Rechenberg's 1/5 rule)."""
STEP_GROWTH = 1.6
"""Per success: 2.9 failures, ln 1.6 over −ln 0.85, take it back."""
SHORTEST = 1e-4
"""Of a key's span: no drawing states a dimension finer."""
CHANGES = 0.2
"""How often a listed value is drawn again instead of kept. Judgement: most trials change numbers alone."""


@dataclass(frozen=True)
class Polish:
    """Where the steps start, and how long they are as a share of each key's span."""

    best: FrozenTrial
    step: float


def polish_of(
    past: Sequence[FrozenTrial],
    evaluations: int,
    sense: str,
    excesses: Callable[[FrozenTrial], Sequence[float]],
) -> Polish | None:
    """Return the next design's step; None where the sampler is to suggest it.

    While none keeps to all constraints, the best is the one that oversteps them least.
    """
    rows = [t for t in past if ROW in t.user_attrs]
    share = len(rows) / evaluations
    if share < BEGINS or (share < POLISH_FROM and len(past) % 2):
        return None
    sign = 1.0 if sense == "minimize" else -1.0
    best: FrozenTrial | None = None
    least = (inf, inf)
    step = FIRST_STEP
    for i, trial in enumerate(rows):
        overstep = sum(max(0.0, e) for e in excesses(trial))
        rank = (overstep, sign * trial.values[0]) if trial.values else (inf, inf)
        better = rank < least
        best, least = (trial, rank) if better else (best, least)
        if i >= BEGINS * evaluations:
            step = min(FIRST_STEP, step * STEP_GROWTH) if better else max(SHORTEST, step * SHORTER)
    return None if best is None else Polish(best, step)


def near(polish: Polish, random: np.random.Generator) -> dict[str, Any]:
    """Return values a step away from the best, kept within the spans by reflection."""
    from optuna.distributions import CategoricalDistribution, IntDistribution

    best, step = polish.best, polish.step
    values: dict[str, Any] = {}
    for key, over in best.distributions.items():
        value = best.params[key]
        if isinstance(over, CategoricalDistribution):
            redrawn = random.random() < CHANGES
            values[key] = over.choices[random.integers(len(over.choices))] if redrawn else value
            continue
        low, high = float(over.low), float(over.high)  # type: ignore[attr-defined]
        moved = value + step * (high - low) * random.standard_normal()
        moved = high - abs(high - (low + abs(moved - low)))
        moved = float(np.clip(moved, low, high))
        values[key] = round(moved) if isinstance(over, IntDistribution) else moved
    return values
