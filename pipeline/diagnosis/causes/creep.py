"""Twist that continues to grow while torque is held."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.causes.operators import lags
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import hold_s, loaded_holds
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s
from flexspline.pipeline.diagnosis.measurement.torque_jitter import by_known_ways

CREEP = "creep"
"""This cause's id."""
EXPONENTS = (0.0, 0.15, 0.3, 0.5)
"""Exponents n of twist t^n; 0 stands for log t, and 0.3 is near Andrade's t^⅓. All but 0 are refined."""
HOLD_DIVISORS = (300.0, 30.0, 5.0)
"""Shortest retardation times that are tried, over the hold: about a decade apart, since each decade adds an
equal twist."""
ENDS_WITHIN = 1.0
"""Longest retardation time that is tried for twist that comes to rest, over the hold; refined from 0.4 on."""
ENDING_DIVISORS, ENDING_EXPONENT = (300.0, 30.0), 0.15
"""Shortest times and exponent that are tried for it. Both ends are refined, so a small exponent is enough."""
SINGLE_TIMES = (0.15, 0.4, 1.0, 3.0)
"""Time constants of a single Kelvin element over the hold. They are about a factor e apart, which refinement
bridges."""
LONGER_THAN_LAG = 0.3
"""Time constant over a ramp's time. A shorter single element is a lag, which is `rate_dependence`.
Judgement."""
STEEPEST = 0.8
"""Exponent: 1 is a steady flow, which grows like drift under constant torque."""
LEAST_TIME_RATIO = 1.001
"""Ratio of the two retardation times below which they are equal except for rounding."""
LEAST_LONGEST = 0.4
"""Limit of the longest retardation time over the hold in refinement. A quicker element has done 92 % of its
twist when the hold ends, and counts as a lag. With 0.15 for spread elements, one of 30 hidden lags was named
creep."""
SHORTEST_HOLD = 0.06
"""Shortest hold, over the time of a ramp from zero. A shorter rest is a turn of the torque. Judgement."""
AT_REST_RATIO = 10.0
"""Longest retardation time over the shortest, at least, where torque is held at zero alone. There a single
Kelvin element is a lag beside a spring, whatever its time, and so is one of a narrower spread. Judgement."""
PER_DECADE = 3
"""Kelvin elements for each decade of retardation times: the sum then follows log t to 1 %."""
DECADE_ROWS = np.array([0.1, 1.0])
"""The last decade of a hold, as shares of its length."""


class Creep(Cause):
    """Kelvin elements in series: twist c·Σ w_k·lag_k(T), c [arcsec per N·m and decade], c ≥ 0.

    Retardation times run from `shortest_s` to `longest_s` with weights ∝ τ^exponent: equal weights
    give the logarithm of time, an exponent a power law; equal ends are a single Kelvin element.
    """

    id = CREEP
    title = "creep (twist that grows while torque is held)"
    unit = "%"
    per_torque = True
    spread_share = 0.06
    """Metal creeps little; a few per cent of the twist a decade are grease, adhesive and bolts."""
    ratio = (
        "in % of the elastic twist: what the last decade of time adds in a hold of the record's median "
        "length, after a sudden load; after a ramp it is less"
    )
    positive = True
    tunable = ("shortest_s", "longest_s", "exponent")
    elastic = True
    shape_doubt = 0.05
    """One and two deviations cover 72 and 93 % of 93 sizes: 63 and 91 % of 65 by logarithms and powers of
    time, 92 and 96 % of 28 by Kelvin elements."""
    made_of = frozenset({SERIES, RATE})
    """A Kelvin element of a short retardation time τ: c·lag(T) = c·T − cτ·q, q = (T − lag(T))/τ the torque's
    rate through that lag, is a spring less what lags."""
    vary = "hold"
    needs_time = True
    shows_over = "time_s"
    reveals = "a hold of ten minutes or more at the largest torque, and one at zero after it"

    def shapes(self, rig: FitContext) -> list[Shape]:
        hold = hold_s(rig.history)
        ramp = ramp_s(rig.history)
        if rig.duration_s <= 0 or hold < SHORTEST_HOLD * ramp or hold == 0:
            return []
        long = max(10 * hold, rig.duration_s)
        loaded = bool(loaded_holds(rig.history))
        common = {"hold_s": hold} if loaded else {"hold_s": hold, "least_ratio": AT_REST_RATIO}
        shapes: list[Shape] = [
            {"shortest_s": low, "longest_s": long, "exponent": n, **common}
            for n in EXPONENTS
            for low in sorted({hold / part for part in HOLD_DIVISORS})
        ]
        shapes += [
            {
                "shortest_s": hold / part,
                "longest_s": ENDS_WITHIN * hold,
                "exponent": ENDING_EXPONENT,
                **common,
            }
            for part in ENDING_DIVISORS
        ]
        for share in SINGLE_TIMES if loaded else ():
            tau = share * hold
            if tau > LONGER_THAN_LAG * ramp:
                shapes.append(
                    {"shortest_s": tau, "longest_s": tau, "exponent": 0.0, "hold_s": hold}
                )
        return shapes

    def kind(self, shape: Shape) -> tuple[float | str, ...]:
        if self._is_alone(shape):
            return (*super().kind(shape), "alone")
        # refined in four steps, none of these becomes another
        ends = shape["longest_s"] <= ENDS_WITHIN * shape["hold_s"]
        growth = "power" if shape["exponent"] > 0 else "logarithm"
        return (*super().kind(shape), "ends" if ends else "goes on", growth)

    @staticmethod
    def _is_alone(shape: Shape) -> bool:
        """Whether it is one Kelvin element; much shorter than a hold that is a lag."""
        return shape["longest_s"] < LEAST_TIME_RATIO * shape["shortest_s"]

    def possible(self, shape: Shape) -> bool:
        low, high = shape["shortest_s"], shape["longest_s"]
        long_enough = high > LEAST_LONGEST * shape["hold_s"]
        wide_enough = high >= shape.get("least_ratio", 1.0) * low
        return wide_enough and long_enough and shape["exponent"] <= STEEPEST

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        tau, weight = self._kelvin(shape)
        return (lags(by_known_ways(history), history, tau) @ weight)[:, None]

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        """Growth over the last decade of a hold of the record's typical length, % of elastic twist.

        The torque is a step: no ramp takes part of the growth before the hold begins.
        """
        grown = 0.0
        for e in elements:
            tau, weight = self._kelvin(e.shape)
            t = DECADE_ROWS * e.shape["hold_s"]
            response = -np.expm1(-t[:, None] / tau) @ weight
            grown += e.amplitudes[0] * float(response[1] - response[0])
        return 100 * grown / rig.compliance

    @staticmethod
    def _kelvin(shape: Shape) -> tuple[np.ndarray, np.ndarray]:
        low, high, n = shape["shortest_s"], shape["longest_s"], shape["exponent"]
        count = 1 + round(PER_DECADE * np.log10(high / low))
        tau = np.geomspace(low, high, count)
        if count == 1:
            return tau, np.ones(1)
        weight = (tau / shape["hold_s"]) ** n / PER_DECADE
        return tau, weight
