"""Friction: loading and unloading branches differ, whatever the rate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.causes.closed_loop import MIDDLE_ROW, loop_widths
from flexspline.pipeline.diagnosis.causes.micro_slip import (
    LEAST_POWER,
    MOST_POWER,
    POWER,
    POWERS,
    micro_slips,
)
from flexspline.pipeline.diagnosis.causes.operators import dahl, steadied, stops
from flexspline.pipeline.diagnosis.causes.rate_dependence import FASTER
from flexspline.pipeline.diagnosis.causes.sliding import carried_share
from flexspline.pipeline.diagnosis.causes.square_loop import SQUARE, square_loops
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.lost_turns import turning_like
from flexspline.pipeline.diagnosis.measurement.torque_jitter import NOISE_LEFT, less_jitter
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm

FRICTION = "friction_hysteresis"
"""This cause's id: the only one that may lie ahead of the teeth."""
THRESHOLDS = (0.015, 0.04, 0.08, 0.15, 0.25, 0.4)
"""Of the elements, as shares of the largest torque."""
LARGEST_SHARP = 0.5
"""Of the largest torque: a single element of a larger threshold yields, after a turn there, only under torque
of the other sign. A gear's friction does not; a lock that gives way does
(`sweep/nuisance/rig_nuisance.py`)."""
SINGLE, EVEN, EXPONENTIAL, DAHL = 0, 1, 2, 3
"""How thresholds are spread: all at r; evenly, with mean r; exponentially; or one element of Dahl's."""
EVERYWHERE, GROWING, CLOSING = 0, 1, 2
"""How the loop's width goes with |T|: the same, in proportion, or only near zero within a `reach`."""
SPREAD_ELEMENTS = 14
"""Against 4000, the first loading of the even spread is within 0.13 % of its end, of the exponential one,
whose tail is cut, within 3.6 %."""
CLOSING_REACH, MOST_CLOSING_REACH = 0.35, 0.8
"""Of the largest torque, start and limit of what `loaded` = CLOSING has: at 0.8 the loop is still
exp(−1/(2·0.8²)) = 46 % as wide at the largest torque, and closes no more."""
LEAST_GROWTH, MOST_GROWTH = 0.5, 3.0
"""Of the power of |T| by which what is `loaded` = GROWING grows: 1 is a friction coefficient."""
MOST_BENT = 2.0
"""Dahl's exponent: steel is near 1, brittle friction below, ductile above."""
DEADBAND = 0.001
"""Reversals of torque below this share of the largest torque, or below twice its noise, count as noise.
Judgement."""
VARIANTS = (
    (SINGLE, 0, 1, 0), (SINGLE, 0, 0, 0), (EVEN, 0, 1, 0), (EVEN, 0, 0, 0), (SINGLE, 1, 1, 0),
    (EXPONENTIAL, 0, 1, 0), (EXPONENTIAL, 0, 0, 0), (SINGLE, 0, 1, -1), (EVEN, 0, 1, -1),
    (EXPONENTIAL, 0, 1, -1), (DAHL, 0, 1, 0), (DAHL, 0, 0, 0), (SINGLE, CLOSING, 1, 0),
    (EVEN, CLOSING, 1, 0),
)  # fmt: skip
"""Spread, loaded, held, start of the shapes tried."""
AHEAD = "stiffness_ratio"
"""The parameter of an element ahead of the teeth, and of no other: its stiffness before it slips, over the
gear's."""


class FrictionHysteresis(Cause):
    """Friction elements (Prandtl-Ishlinskii): twist −a·s/r, s the state of a stop of threshold r.

    While torque rises the friction holds the output back by a, while it falls it holds it forward: a
    loop 2a [arcsec] wide. Shapes: a single threshold, or thresholds spread evenly from 0 to r (a
    rounded loop), or Dahl's exponential approach; width the same everywhere, growing with |T| or
    closing (`loaded`); and whether the friction also takes torque at the loop's ends (`held` = 1) or
    leaves the chord as it is (`held` = 0).

    Two elements are of other kinds, without a threshold: micro-slip, with a `power` of torque
    (`micro_slip.py`), and a loop with `square` ends (`square_loop.py`).

    Friction ahead of the teeth (output bearing, seals) is an element of another kind: its amplitude is a
    torque F [N·m], and gap and elasticity act on T − F·z (`sliding.py`). It adds nothing to the angle by
    itself; with no gap it looks like a single threshold at F, of amplitude F times the compliance.
    """

    id = FRICTION
    title = "friction hysteresis"
    unit = "arcsec"
    spread_share = 0.2
    """Half a loop: catalogues' hysteresis is up to some tenths of the twist."""
    positive = True
    tunable = ("threshold_Nm", "exponent", "reach", "growth", POWER)
    shape_doubt = 0.008
    """One and two deviations cover 65 and 88 % of 26 sizes."""
    vary = "torque_rate"
    reveals = (
        f"repeat the loop at 1/{FASTER:g} of the rate of torque; hysteresis from friction does not change, "
        "lag does"
    )
    searched_apart = ({AHEAD: 30.0, "deadband_Nm": 0.0},)

    def shapes(self, rig: FitContext) -> list[Shape]:
        largest = rig.largest_Nm
        deadband = max(DEADBAND * largest, NOISE_LEFT * deadband_Nm(rig.history))
        shapes: list[Shape] = []
        # an element narrower than the torque's noise cannot be seen
        least = deadband / largest
        shares = [s for s in THRESHOLDS if s >= least] or [THRESHOLDS[-1]]
        for share in shares:
            for spread, loaded, held, start in VARIANTS:
                shapes.append({
                    "threshold_Nm": share * largest, "spread": spread, "loaded": loaded,
                    "held": held, "start": start, "largest_torque_Nm": largest,
                    "deadband_Nm": deadband, "exponent": float(spread == DAHL),
                    "reach": CLOSING_REACH * (loaded == CLOSING), "growth": float(loaded == GROWING),
                })  # fmt: skip
        return shapes + [
            {**kind, "held": held, "largest_torque_Nm": largest, "deadband_Nm": deadband}
            for kind in ({SQUARE: 1.0}, *({POWER: p} for p in POWERS)) for held in (1, 0)
        ]  # fmt: skip

    def possible(self, shape: Shape) -> bool:
        if POWER in shape:
            return LEAST_POWER <= shape[POWER] <= MOST_POWER
        if SQUARE in shape:
            return True
        return (
            shape["threshold_Nm"] >= shape["deadband_Nm"]
            and (
                shape["spread"] != SINGLE
                or shape["threshold_Nm"] <= LARGEST_SHARP * shape["largest_torque_Nm"]
            )
            and shape["exponent"] <= MOST_BENT
            and shape["reach"] < MOST_CLOSING_REACH
            and (shape["loaded"] != GROWING or LEAST_GROWTH <= shape["growth"] <= MOST_GROWTH)
        )

    def but_for_a_spring(self, shape: Shape, rig: FitContext) -> list[Shape]:
        if AHEAD in shape or shape.get("loaded", EVERYWHERE) != EVERYWHERE:
            return []
        return [{**shape, "held": 1 - shape["held"]}]

    def columns(self, shape: Shape, history: History) -> np.ndarray:
        return self.columns_of_all([shape], history)[0]

    def columns_of_all(self, shapes: Sequence[Shape], history: History) -> list[np.ndarray]:
        """Nothing for elements ahead of the teeth: they are in the history's torque."""
        history = less_jitter(history)
        kinds: tuple[tuple[str, Callable[..., list[np.ndarray]]], ...] = (
            ("threshold_Nm", self._behind), (POWER, micro_slips), (SQUARE, square_loops),
        )  # fmt: skip
        columns_by_id: dict[int, np.ndarray] = {}
        for key, columns in kinds:
            own = [s for s in shapes if key in s]
            columns_by_id |= zip(map(id, own), columns(own, history), strict=True)
        none = np.zeros((len(history), 1))
        return [columns_by_id.get(id(s), none) for s in shapes]

    def _behind(self, shapes: Sequence[Shape], history: History) -> list[np.ndarray]:
        """Columns of elements with a threshold."""
        stopped = [s for s in shapes if s["spread"] != DAHL]
        sloped = [s for s in shapes if s["spread"] == DAHL]
        states = dict(zip(map(id, sloped), self._dahls(sloped, history), strict=True))
        if stopped:
            parts = [self._thresholds(int(s["spread"]), s["threshold_Nm"]) for s in stopped]
            each = np.concatenate([r for r, _ in parts])
            lengths = [len(r) for r, _ in parts]
            start = np.repeat([s["start"] for s in stopped], lengths)
            # the even and exponential spreads repeat thresholds; each pair is run once
            pairs, where = np.unique(each + 1j * start, return_inverse=True)
            torque = steadied(history, shapes[0]["deadband_Nm"])
            run = stops(history, torque, pairs.real, pairs.imag)
            at = 0
            for s, (r, weight) in zip(stopped, parts, strict=True):
                mine = where[at : at + len(r)]
                states[id(s)] = run[:, mine] @ (weight / r)
                at += len(r)
        return [self._column(s, states[id(s)], history) for s in shapes]

    @staticmethod
    def _dahls(shapes: Sequence[Shape], history: History) -> list[np.ndarray]:
        if not shapes:
            return []
        widths = np.array([s["threshold_Nm"] for s in shapes])
        exponents = np.array([s["exponent"] for s in shapes])
        return list(dahl(history, widths, exponents, shapes[0]["deadband_Nm"]).T)

    def _column(self, shape: Shape, state: np.ndarray, history: History) -> np.ndarray:
        r, largest = shape["threshold_Nm"], shape["largest_torque_Nm"]
        if not shape["held"]:
            if shape["spread"] == DAHL:
                at_end = float(np.tanh(largest / r))
            else:
                each, weight = self._thresholds(int(shape["spread"]), r)
                at_end = float(weight @ np.minimum(1, largest / each))
            state = state - at_end * history.torque_Nm / largest
        if shape["loaded"] == GROWING:
            state = state * np.abs(history.torque_Nm / largest) ** shape.get("growth", 1.0)
        elif shape["loaded"] == CLOSING:
            state = state * np.exp(-((history.torque_Nm / (shape["reach"] * largest)) ** 2) / 2)
        return -state[:, None]

    @staticmethod
    def _thresholds(spread: int, r: float) -> tuple[np.ndarray, np.ndarray]:
        """Thresholds (m,) [N·m] and the share (m,) of the friction that each holds."""
        if spread == SINGLE:
            return np.array([r]), np.ones(1)
        level = (np.arange(SPREAD_ELEMENTS) + 0.5) / SPREAD_ELEMENTS
        if spread == EVEN:
            return 2 * r * level, 2 * level / SPREAD_ELEMENTS
        each = -r * np.log1p(-level)
        return each, each / each.sum()

    def at_teeth(self, elements: Sequence[Element], history: History) -> History:
        carried = np.zeros(len(history))
        for e in elements:
            if AHEAD in e.shape:
                share = carried_share(
                    history, e.amplitudes[0], e.shape[AHEAD], e.shape["deadband_Nm"]
                )
                carried += e.amplitudes[0] * share
        if not carried.any():
            return history
        return turning_like(history, replace(history, torque_Nm=history.torque_Nm - carried))

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        """Full width at T = 0 of the closed loop at the largest amplitude.

        For friction ahead of the teeth it is the width that elasticity makes of the torque.
        """
        return float(self._widths(elements, rig)[MIDDLE_ROW])

    def widest_arcsec(self, elements: Sequence[Element], rig: FitContext) -> float:
        """Full width of that loop where it is widest. Friction that grows with torque has no width at T =
        0."""
        return float(self._widths(elements, rig).max())

    def _widths(self, elements: Sequence[Element], rig: FitContext) -> np.ndarray:
        """(LOOP_ROWS,) width of the closed loop from −T to T."""
        largest = rig.largest_Nm + sum(e.amplitudes[0] for e in elements if AHEAD in e.shape)

        def angle(course: History) -> np.ndarray:
            teeth = self.at_teeth(elements, course)
            twist = rig.compliance * (teeth.torque_Nm - course.torque_Nm)
            return twist + self.angle_arcsec(elements, teeth)

        return loop_widths(angle, largest)
