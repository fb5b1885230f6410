"""A gap that grows from cycle to cycle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.causes.operators import within_cycle
from flexspline.pipeline.diagnosis.measurement.history import History

WEAR = "wear"
"""This cause's id."""
RUN_IN_CYCLES = (0.7, 1.5, 3.0, 6.0)
"""Run-in times in cycles, a factor of two apart; they are refined."""
LEAST_EXPONENT, MOST_EXPONENT = 0.3, 1.3
"""Of the cycle, when refined: below, half of the growth is over in the first tenth of the cycles; above, wear
would quicken."""
LEAST_RUN_IN_CYCLES = 0.5
"""Shortest run-in in cycles. Below it 86 % of the growth is over after one cycle: the gap merely has another
size from the second cycle on."""


class Wear(Cause):
    """Gap w·g(cycle) with w ≥ 0 [arcsec]; g runs from 0 in the first to 1 in the last cycle.

    It grows between cycles, or all along them (`steady` = 1). `exponent` 1: evenly; ½: slowing down.
    `run_in_cycles` > 0: saturating, 1 − exp(−cycle/run-in).
    """

    id = WEAR
    title = "wear (gap that grows from cycle to cycle)"
    unit = "arcsec/cycle"
    spread_share = 0.5
    """Wear typically increases the gap by about half before it is measured."""
    positive = True
    tunable = ("exponent", "run_in_cycles")
    shape_doubt = 0.007
    """One and two deviations cover 67 and 96 % of 27 sizes."""
    vary = "cycle"
    shows_over = "cycle"
    shows_as = "gap"
    reveals = "many more cycles at constant temperature"

    def shapes(self, rig: FitContext) -> list[Shape]:
        if rig.cycles < 2:
            return []
        last = rig.cycles - 1
        laws = [(1.0, 0.0), (0.5, 0.0)]
        if rig.cycles > 2:
            laws += [(1.0, c) for c in RUN_IN_CYCLES]
        return [
            {"exponent": n, "run_in_cycles": c, "last": last, "steady": steady}
            for n, c in laws
            for steady in (0, 1)
        ]

    def possible(self, shape: Shape) -> bool:
        """A gap that has grown before the first cycle is half over is another cause."""
        run_in = shape["run_in_cycles"]
        return LEAST_EXPONENT <= shape["exponent"] <= MOST_EXPONENT and (
            run_in == 0.0 or run_in >= LEAST_RUN_IN_CYCLES
        )

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        cycle = history.cycle.astype(float)
        if shape["steady"]:
            cycle = cycle + within_cycle(history)
        return (self._growth(shape, cycle) * history.sign / 2)[:, None]

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        """Growth over the record, on the law's own clock, per cycle elapsed."""
        total = 0.0
        for e in elements:
            elapsed = rig.cycles if e.shape["steady"] else max(1, rig.cycles - 1)
            total += (
                e.amplitudes[0] * float(self._growth(e.shape, np.array([elapsed]))[0]) / elapsed
            )
        return total

    @staticmethod
    def _growth(shape: Shape, cycle: np.ndarray) -> np.ndarray:
        run_in, last = shape["run_in_cycles"], shape["last"]
        if run_in > 0:
            return np.expm1(-cycle / run_in) / np.expm1(-last / run_in)
        return (cycle / last) ** shape["exponent"]
