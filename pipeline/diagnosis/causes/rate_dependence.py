"""Twist that lags torque, growing with its rate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.causes.operators import lags, steadied
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import loaded_holds
from flexspline.pipeline.diagnosis.measurement.ramps import (
    ramp_s,
    shortest_lag_s,
    slowest_ramp_s,
)
from flexspline.pipeline.diagnosis.measurement.torque_jitter import NOISE_LEFT, less_jitter
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm

RATE = "rate_dependence"
"""This cause's id."""
FASTER = 10.0
"""Factors on the rate that show a lag. Between the two a lag changes by a factor of 100, friction does
not."""
LAG_SHARES = (0.02, 0.05, 0.1, 0.2, 0.4)
"""Time constants as shares of a ramp, where torque is held: a longer lag is creep, which shows in holds."""
LONGER_SHARES = (0.7, 1.0, 1.6, 2.5, 4.0)
"""The same where torque is never held. Four of the quickest cycle's ramps are 98 % of its twist lost."""
LONGEST_SHARE = 4.0
"""Of the slowest cycle's ramp, there. With half of it, a lag of a quarter of a triangle's cycle was named
friction, and one of a sine's had two thirds of its size. With 16, a lag of four cycles was the rival of a
stiffer gear; longer ones are in the deviations alone (`../sweep/magnitudes/long_lags.py`)."""
EXPONENTS = (0.6, 0.8, 1.25, 1.6)
"""Of the rate: twist that levels off with it or steepens; refined, so that steps of a third do."""
LEAST_EXPONENT, MOST_EXPONENT = 0.4, 1.8
"""Of the rate, when refined: at 0 it is friction, which knows no rate, and at 2 the drag of a turbulent
fluid, which a gear has not."""


class RateDependence(Cause):
    """Twist −a·q, q the torque's rate seen through a lag, a ≥ 0 [arcsec per N·m/s].

    q = (T − lag_τ(T))/τ of the torque without its noise; `exponent` other than 1: |q/rate|^exponent at the
    record's typical rate.
    """

    id = RATE
    title = "rate dependence (twist that lags torque)"
    unit = "arcsec per N·m/s"
    spread_share = 0.15
    """At the record's typical rate the lag is a part of the twist; otherwise the loop comes from friction."""
    positive = True
    tunable = ("lag_s", "exponent")
    shape_doubt = 0.008
    """One and two deviations cover 69 and 93 % of 61 sizes; with 0.022 they covered 87 and 100 % of 45."""
    vary = "torque_rate"
    reveals = f"the same sweep at 1/{FASTER:g} and at {FASTER:g} times the rate of torque"

    def shapes(self, rig: FitContext) -> list[Shape]:
        ramp = ramp_s(rig.history)
        if ramp <= 0:
            return []
        rate = rig.largest_Nm / ramp
        shortest = NOISE_LEFT * shortest_lag_s(rig.history)
        common = {
            "rate_Nm_per_s": rate, "ramp_s": ramp, "shortest_s": shortest,
            "deadband_Nm": NOISE_LEFT * deadband_Nm(rig.history),
        }  # fmt: skip
        shares = list(LAG_SHARES)
        if not loaded_holds(rig.history):
            longest = LONGEST_SHARE * slowest_ramp_s(rig.history) / ramp
            shares += [s for s in LONGER_SHARES if s <= longest]
            common["longest_s"] = max(longest, shares[-1]) * ramp
        lags_s = sorted({max(s * ramp, shortest) for s in shares})
        shapes: list[Shape] = [{"lag_s": lag, "exponent": 1.0, **common} for lag in lags_s]
        shapes += [
            {"lag_s": max(LAG_SHARES[1] * ramp, shortest), "exponent": n, **common}
            for n in EXPONENTS
        ]
        return shapes

    def possible(self, shape: Shape) -> bool:
        longest = shape.get("longest_s", LAG_SHARES[-1] * shape["ramp_s"])
        return (
            LEAST_EXPONENT <= shape["exponent"] <= MOST_EXPONENT
            and shape["shortest_s"] <= shape["lag_s"] <= longest
        )

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        n, rate = shape["exponent"], self._rate(shape, history)
        if n != 1.0:
            unit = shape["rate_Nm_per_s"]
            rate = unit * np.sign(rate) * np.abs(rate / unit) ** n
        return -rate[:, None]

    @staticmethod
    def _rate(shape: Shape, history: History) -> np.ndarray:
        """(n,) of the torque [N·m/s], seen through the lag."""
        tau = shape["lag_s"]
        torque = steadied(less_jitter(history), shape["deadband_Nm"])
        return (torque - lags(torque, history, np.array([tau]))[:, 0]) / tau

    def spread(self, shape: Shape, rig: FitContext) -> float:
        """Seen through a lag longer than a ramp, torque changes by less than its rate."""
        longer = max(1.0, shape["lag_s"] / shape["ramp_s"])
        return self.spread_share * rig.scale_arcsec / shape["rate_Nm_per_s"] * longer

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        """By least squares over the rates that the record ran at."""
        return sum(e.amplitudes[0] * self._per_rate(e.shape, rig.history) for e in elements)

    def _per_rate(self, shape: Shape, history: History) -> float:
        """Twist per rate of one unit of amplitude."""
        rate = self._rate(shape, history)
        if shape["exponent"] == 1.0 or not rate.any():
            return 1.0
        return float(-self.columns(shape, history)[:, 0] @ rate / (rate @ rate))
