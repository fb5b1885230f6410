"""The predicted total of one unit as a distribution, and the most likely inputs for a measured total."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

from flexspline.geometry.design import Design
from flexspline.geometry.fields import MM_PER_UM
from flexspline.pipeline.backlash import (
    ARCSEC_PER_RAD,
    clearance_angle,
    play_clearance,
)
from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_ARCSEC
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.play_spread import play_distribution

ENVELOPE_SIGMAS = 6.0
"""Standard deviations of the play that are integrated: beyond lie 2e-9 of good units, far below any
p-value that a verdict turns on."""
ENVELOPE_NODES = 200
"""`explanation` chooses among the nodes: over ± 6 σ they lie at most 6π/200 = 0.09 σ apart."""
COVERED_SHARE = 0.95
"""Share of good units within the interval that is called the envelope."""
COVERED_WORDS = f"{100 * COVERED_SHARE:g} of 100"
"""The same, as figures say it."""


@dataclass(frozen=True)
class Explanation:
    """The least unlikely play and flank clearance that give a total; distances in standard deviations.

    `distance` is from the design, all sources together; inf where the design states no uncertainty
    and the total is another.
    """

    flank_clearance_um: float
    radial_clearance_um: float
    distance: float


@dataclass(frozen=True)
class Envelope:
    """The four-term sum at one torque, with the play's curve and its end.

    Attributes
    ----------
    total_arcsec : as predicted of the design itself.
    play_um, play_weight : (k,) nodes of the play's distribution, none beyond c_max.
    play_arcsec : (k,) what each adds beyond the design's play.
    straight_std_arcsec : of flank clearance, Young's modulus and reading, which enter as a sum.
    """

    design: Design
    torque_Nm: float
    total_arcsec: float
    play_um: np.ndarray
    play_weight: np.ndarray
    play_arcsec: np.ndarray
    straight_std_arcsec: float

    @property
    def std_arcsec(self) -> float:
        """Of the total, the play's curvature included."""
        return hypot(
            self.straight_std_arcsec, float(np.sqrt(self.play_weight @ self.play_arcsec**2))
        )

    def above(self, total_arcsec: float) -> float:
        """Probability that a good unit's total is larger."""
        off = total_arcsec - self.total_arcsec - self.play_arcsec
        if self.straight_std_arcsec == 0:
            return float(self.play_weight @ (off < 0))
        return float(self.play_weight @ ndtr(-off / self.straight_std_arcsec))

    def p_value(self, total_arcsec: float) -> float:
        """Two-sided: twice the smaller tail."""
        if self.std_arcsec == 0:
            return 1.0 if np.isclose(total_arcsec, self.total_arcsec) else 0.0
        above = self.above(total_arcsec)
        return min(1.0, 2 * min(above, 1 - above))

    @property
    def interval_arcsec(self) -> tuple[float, float]:
        """Holds COVERED_SHARE of good units."""
        if self.std_arcsec == 0:
            return self.total_arcsec, self.total_arcsec
        tail, reach = (1 - COVERED_SHARE) / 2, 12 * self.std_arcsec
        ends = self.total_arcsec - reach, self.total_arcsec + reach
        low, high = (
            float(brentq(lambda x, q=q: self.above(x) - q, *ends)) for q in (1 - tail, tail)
        )
        return low, high

    @property
    def play_end_arcsec(self) -> float:
        """The most that play adds beyond the design's, where the involute model ends; inf: no end."""
        design = self.design
        if design.bearing.bearing_play_model != "involute":
            return inf
        return _play_arcsec(design, design.gear.bearing_play_limit_um) - _play_arcsec(
            design, design.bearing.radial_clearance_um
        )

    def limit_arcsec(self) -> float:
        """The total with the play where the model ends and flank clearance a deviation up."""
        flank = _flank_arcsec(self.design, self.design.uncertainty.flank_clearance_um)
        return self.total_arcsec + self.play_end_arcsec + flank

    def explanation(self, total_arcsec: float) -> Explanation:
        """How far the clearances must be from the design to give a total, and where they are then."""
        design, doubt = self.design, self.design.uncertainty
        j, c = design.gear.flank_clearance_um, design.bearing.radial_clearance_um
        off = total_arcsec - self.total_arcsec
        if self.straight_std_arcsec == 0:
            return Explanation(j, c, 0.0 if abs(off) < ROUNDING_ARCSEC else inf)
        rest = off - self.play_arcsec
        steps = np.zeros_like(rest)
        if doubt.radial_clearance_um > 0:
            steps = (self.play_um - c) / doubt.radial_clearance_um
        distance = np.hypot(steps, rest / self.straight_std_arcsec)
        best = int(np.argmin(distance))
        flank = _flank_arcsec(design, doubt.flank_clearance_um)
        share = (flank / self.straight_std_arcsec) ** 2
        taken = rest[best] * share / _flank_arcsec(design, 1.0)
        return Explanation(j + float(taken), float(self.play_um[best]), float(distance[best]))


def envelope(
    design: Design, prediction: Prediction, torque_Nm: float, reading_std_arcsec: float
) -> Envelope:
    """Of a design and its prediction at ±T [N·m].

    Young's modulus and flank clearance enter the sum linearly and are normal. Play enters by the
    design's model: normal about c, and only as far as c_max, where the involute model ends.
    """
    doubt = design.uncertainty
    c, s = design.bearing.radial_clearance_um, doubt.radial_clearance_um
    if s > 0:
        steps, weight = play_distribution(
            design.gear, design.bearing, s, ENVELOPE_SIGMAS, ENVELOPE_NODES
        )
        play = c + s * steps
    else:
        play, weight = np.array([c]), np.ones(1)
    here = _play_arcsec(design, c)
    added = np.array([_play_arcsec(design, float(p)) for p in play]) - here
    total = prediction.twist_arcsec(-torque_Nm, torque_Nm)
    straight = hypot(
        (total - prediction.gap_arcsec) * doubt.youngs_modulus_pct / 100,
        _flank_arcsec(design, doubt.flank_clearance_um),
        reading_std_arcsec,
    )
    return Envelope(design, torque_Nm, total, play, weight, added, straight)


def _flank_arcsec(design: Design, clearance_um: float) -> float:
    """What a normal flank clearance adds to the total."""
    return ARCSEC_PER_RAD * clearance_angle(design, clearance_um * MM_PER_UM)


def _play_arcsec(design: Design, play_um: float) -> float:
    """What a bearing play adds to the total, by the design's model."""
    return ARCSEC_PER_RAD * clearance_angle(design, play_clearance(design, play_um=play_um))
