"""Whether the angle reading is late: the gap's own step then comes late, through a filter or by a delay.

Twist that lags the torque, friction and creep leave the gap's step where the teeth change sides. A filter of
the angle channel spreads it over the rows after each crossing, where the race would find hardening.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.decision import is_rival
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import FINEST_ARCSEC
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.outcome import NextMeasurement, Unexplained
from flexspline.pipeline.diagnosis.robust import SIGMA_PER_MAD
from flexspline.pipeline.diagnosis.sweep.crossing_forms import (
    BOTH,
    DELAY,
    FILTER,
    Tried,
    at_a_place,
    behind_friction,
    late,
    of_time,
)
from flexspline.pipeline.diagnosis.sweep.first_offset import FIRST_NATS
from flexspline.pipeline.diagnosis.sweep.offset_race import SPIKE_NATS
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.row_selection import settling, turning
from flexspline.pipeline.diagnosis.sweep.step_place import (
    DEPENDENT,
    LEAST_STEP,
    MOST_FIRST_ROWS,
    ROBUST,
    SINGULAR,
    looped_functions,
)
from flexspline.pipeline.diagnosis.sweep.torque_offset import LEAST_WIDTH, both_ways

QUADRATURE = ((-3.0, 0.06), (-1.5, 0.24), (0.0, 0.4), (1.5, 0.24), (3.0, 0.06))
"""Standard deviations of the torque's noise, and weights: about a normal of 1.5 deviations, as a width of the
crossing is better taken too large than too small."""
WEIGHINGS = 3
"""Fits, each with the weights (Huber's) of the last one's residual."""
COARSE = 3
"""Of the forms, every third is tried at first: where no late angle is the best of these, none is. Else those
beside the best of each kind are tried too."""
COARSE_ROWS = 1000
"""Rows looked at meanwhile: enough to tell forms that lie three steps apart."""
FINE = 9
"""Times tried between two neighbours of the first search."""
KINDS = (FILTER, DELAY, BOTH)
IMITATED = (
    "stiffness_hardening", "friction_hysteresis", "rate_dependence", "creep", "series_compliance",
    "?direction", "?torque_rate", "?torque_Nm", "?angle_arcsec", "?time_s",
)  # fmt: skip
"""Owners of terms that bend the curve near the gap or open a loop, as a late angle does."""
OTHERS = ("torque", "twist")
"""Forms of time that are no late angle: a late torque, and a twist that lags while the gap does not."""
LATE = (
    "and so does the step of the gap, which no lag of the twist delays. A drag ahead of the teeth that grows "
    "with the speed, as of stiff grease, would look like it"
)
SAID = {
    FILTER: "the angle reading follows the torque through a filter of {0:.2g} ± {1:.1g} s, " + LATE,
    DELAY: "the angle reading follows the torque {0:.2g} ± {1:.1g} s late, " + LATE,
    BOTH: "both readings come through a filter of {0:.2g} ± {1:.1g} s: the step of the gap begins before the "
    "torque reading is zero, and is spread over that time",
}
LATE_ANGLE = NextMeasurement(
    "torque_rate",
    "find_structure",
    doing="compare the filters of the torque and the angle channel, and whether both are read at one "
    "instant; then repeat the sweep ten times slower: what a late reading does is then a tenth as large",
)


@dataclass(frozen=True)
class LateAngle:
    """How the angle is late, with the time and its standard deviation.

    Attributes
    ----------
    kind : one of KINDS. rms_arcsec : of what the record's step of the gap is off a sharp one at zero torque.
    """

    kind: str
    time_s: float
    std_s: float
    rms_arcsec: float

    @property
    def next(self) -> NextMeasurement:
        """What tells more."""
        return LATE_ANGLE

    @property
    def said(self) -> Unexplained:
        """As structure without a name, in place of what the race made of it."""
        what = SAID[self.kind].format(self.time_s, self.std_s)
        return Unexplained("torque_rate", self.rms_arcsec, 0.0, what, limit=True)


def late_angle_of(
    prepared: PreparedSweep, explained: ExplainedSweep | None = None
) -> LateAngle | None:
    """What the gap's crossing of a record says; None where it is crossed as well in another way.

    That is: with a shifted torque reading, friction ahead of the teeth, both, a late torque reading, or a
    twist that lags. What a race `explained` by causes may be there in any size.
    """
    history = prepared.sweep.history
    if history.time_s is None or not both_ways(history.torque_Nm):
        return None
    gap = prepared.prediction.gap_arcsec
    angle, noise = prepared.sweep.angle_arcsec, prepared.noise.std_arcsec
    found = _found(explained)
    whole = _searched(_Crossed(history, angle, gap, noise, tuple(found.values())))
    if whole.nats >= FIRST_NATS:
        return _sized(whole)
    apart = tuple(own for owner, own in found.items() if owner not in IMITATED)
    if len(apart) == len(found):
        return None
    alone = _searched(_Crossed(history, angle, gap, noise, apart))
    if alone.nats >= FIRST_NATS and is_rival(_behind(alone, whole), np.inf):
        return _sized(alone)
    return None


def _found(explained: ExplainedSweep | None) -> dict[str, np.ndarray]:
    """What each cause and nuisance term of a race adds (n,), by owner."""
    if explained is None:
        return {}
    identified = explained.identified
    return {owner: identified.fit.added(owner) for owner in sorted(identified.rms)}


def _searched(crossed: _Crossed) -> _Searched:
    """The likeliest late angle and the likeliest other form."""
    history = crossed.history
    known = [at_a_place(history), behind_friction(history)]
    known += [list(of_time(history, kind)) for kind in OTHERS]
    by_time = [list(of_time(history, kind)) for kind in KINDS]
    coarse = replace(crossed, most_rows=COARSE_ROWS)
    others = [coarse.best(tried[::COARSE]) for tried in known]
    owns = [coarse.best(tried[::COARSE]) for tried in by_time]
    own = max(owns, key=_likeliest)
    best = max((own, *others), key=_likeliest)
    # local polynomials take the gap's step for noise: what the best form leaves is less
    crossed = replace(crossed, noise_arcsec=_left_by(best))
    if best is own:
        others = [crossed.best(_beside(*pair)) for pair in zip(known, others, strict=True)]
        owns = [crossed.best(_beside(*pair)) for pair in zip(by_time, owns, strict=True)]
        own = max(owns, key=_likeliest)
        crossed = replace(crossed, noise_arcsec=_left_by(max((own, *others), key=_likeliest)))
        if max(others, key=_likeliest).log_likelihood < own.log_likelihood:
            others += _rubbed(crossed, others[1])
    own, *others = (crossed.of(fit.tried) for fit in (own, *others))
    return _Searched(crossed, own, max(others, key=_likeliest))


def _beside(tried: list[Tried], best: _Fit) -> list[Tried]:
    """The best of the forms that were tried at first, and those up to its neighbours."""
    at = next(i for i, one in enumerate(tried) if one is best.tried)
    return tried[max(0, at - COARSE + 1) : at + COARSE]


def _left_by(fit: _Fit) -> float:
    return max(fit.left_arcsec, FINEST_ARCSEC)


def _behind(alone: _Searched, whole: _Searched) -> float:
    """Nats by which a late angle explains a record less than the causes that it imitates."""
    noise = min(alone.crossed.noise_arcsec, whole.crossed.noise_arcsec)
    own = replace(alone.crossed, noise_arcsec=noise).of(alone.own.tried)
    other = replace(whole.crossed, noise_arcsec=noise).of(whole.other.tried)
    return (other.log_likelihood - own.log_likelihood) / DEPENDENT


def _rubbed(crossed: _Crossed, friction: _Fit) -> list[_Fit]:
    """The best friction near one of the first search, alone and beside a shifted reading."""
    history, coarse = crossed.history, friction.tried.value
    apart = float(np.abs(history.torque_Nm).max()) / 100

    def near(offset_Nm: float) -> _Fit:
        fine = np.maximum(coarse + apart * np.linspace(-1, 1, 4 * FINE + 1), apart / 100)
        return crossed.best(behind_friction(history, fine, offset_Nm))

    alone = near(0.0)
    places = apart * np.linspace(-10, 10, 4 * FINE + 1)
    own = np.array([alone.tried.value])
    beside = [behind_friction(history, own, p)[0] for p in places.tolist()]
    shifted = int(np.argmax([crossed.of(one).log_likelihood for one in beside]))
    return [alone, near(float(places[shifted]))]


def _sized(searched: _Searched) -> LateAngle:
    """Time and deviation by how likely each of some neighbouring times is."""
    crossed, tried = searched.crossed, searched.own.tried
    times = np.geomspace(tried.value / 1.2, tried.value * 1.2, FINE)
    forms = [late(crossed.history, tried.kind, time) for time in times.tolist()]
    nats = np.array([crossed.of(one).log_likelihood for one in forms]) / DEPENDENT
    weight = np.exp(nats - nats.max())
    time = float(weight @ times / weight.sum())
    spread = weight @ (times - time) ** 2 / weight.sum() + np.diff(times).max() ** 2 / 12
    missed = forms[int(nats.argmax())].form(0.0) - crossed.history.sign
    rms = crossed.gap_arcsec / 2 * float(np.sqrt(np.mean(missed**2)))
    return LateAngle(tried.kind, time, float(np.sqrt(spread)), rms)


@dataclass(frozen=True)
class _Fit:
    """How likely a record is with one form, and the scatter that it leaves [arcsec]."""

    tried: Tried
    log_likelihood: float
    left_arcsec: float


@dataclass(frozen=True)
class _Searched:
    """The likeliest late angle of a record, and the likeliest of the other forms."""

    crossed: _Crossed
    own: _Fit
    other: _Fit

    @property
    def nats(self) -> float:
        """Of the late angle over the other."""
        return (self.own.log_likelihood - self.other.log_likelihood) / DEPENDENT


def _likeliest(fit: _Fit) -> float:
    return fit.log_likelihood


@dataclass(frozen=True)
class _Crossed:
    """A record, whose angle is smooth functions of torque with any loop, and the gap's step in one form.

    `found` : what else the angle may hold (n,), in any size. `most_rows` : looked at, evenly chosen.
    """

    history: History
    angle_arcsec: np.ndarray
    gap_arcsec: float
    noise_arcsec: float
    found: tuple[np.ndarray, ...] = ()
    most_rows: int = MOST_FIRST_ROWS

    @cached_property
    def rows(self) -> np.ndarray:
        """Rows that count: friction's memory from before the record, and turns, say nothing of the gap."""
        good = np.flatnonzero(~settling(self.history) & ~turning(self.history))
        return good[:: max(1, len(good) // self.most_rows)]

    @cached_property
    def smooth(self) -> np.ndarray:
        return np.column_stack([looped_functions(self.history), *self.found])[self.rows]

    @cached_property
    def width_Nm(self) -> float:
        """Noise of the torque, by which a row may lie on the other side."""
        least = LEAST_WIDTH * float(np.abs(self.history.torque_Nm).max())
        return max(torque_noise_Nm(self.history), least)

    def best(self, tried: Iterable[Tried]) -> _Fit:
        """The likeliest of some forms."""
        return max((self.of(one) for one in tried), key=_likeliest)

    def of(self, tried: Tried) -> _Fit:
        """The fit with one form; its step's height is free, but much less than the gap is none."""
        sides = [tried.form(noise * self.width_Nm)[self.rows] for noise, _ in QUADRATURE]
        share = np.array([weight for _, weight in QUADRATURE])
        side = share @ np.array(sides)
        unsure = share @ (np.array(sides) - side) ** 2
        deviation = np.sqrt(self.noise_arcsec**2 + (self.gap_arcsec / 2) ** 2 * unsure)
        columns = [side, self.smooth]
        if tried.followed_Nm is not None:
            columns.append((tried.followed_Nm - self.history.torque_Nm)[self.rows])
        basis, angle = np.column_stack(columns), self.angle_arcsec[self.rows]
        weight = 1 / deviation
        for _ in range(WEIGHINGS):
            weighted = basis * weight[:, None]
            found = np.linalg.lstsq(
                weighted.T @ weighted, weighted.T @ (angle * weight), rcond=SINGULAR
            )[0]
            off = np.abs(angle - basis @ found) / deviation
            weight = 1 / deviation / np.sqrt(np.maximum(1, off / ROBUST))
        if found[0] < LEAST_STEP * self.gap_arcsec:
            return _Fit(tried, -np.inf, np.inf)
        # a row that lies anywhere costs what a spike does
        huber = np.where(off < ROBUST, off**2, 2 * ROBUST * off - ROBUST**2)
        cost = np.minimum(huber, 2 * SPIKE_NATS) / 2 + np.log(deviation)
        left = SIGMA_PER_MAD * float(np.median(off)) * self.noise_arcsec
        return _Fit(tried, -float(cost.sum()), left)
