"""Whether the angle reading is late: the gap's own step then comes late, through a filter or by a delay.

Twist that lags the torque, friction and creep leave the gap's step where the teeth change sides. A filter of
the angle channel spreads it over the rows after each crossing, where the race would find hardening.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.creep import CREEP
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.decision import is_rival
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import FINEST_ARCSEC
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.structure import LateAngle
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import on_both_sides
from flexspline.pipeline.diagnosis.sweep.crossing.step_fit import DEPENDENT
from flexspline.pipeline.diagnosis.sweep.crossing.torque_offset_guess import FIRST_NATS
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import NAMED_COST
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_fit import (
    CrossedRecord,
    CrossingFit,
    likeliest,
)
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_forms import (
    BOTH,
    DELAY,
    FILTER,
    RUBBED,
    Tried,
    at_a_place,
    behind_friction,
    late,
    of_time,
    softly,
)

COARSE_EVERY = 3
"""Of the forms, every third is tried at first: where no late angle is the best of these, none is. Else those
beside the best of each kind are tried too."""
COARSE_ROWS = 1000
"""Rows used in this first search: enough to distinguish forms that are three steps apart."""
FINE_TIMES = 9
"""Times tried between two neighbours of the first search."""
TO_NEIGHBOUR = 1.2
"""From one time of the first search to the next they grow 1.19 times (`of_time`)."""
LATE_KINDS = (FILTER, DELAY, BOTH)
IMITATED = (
    HARDENING, FRICTION, RATE, CREEP, SERIES,
    "?direction", "?torque_rate", "?torque_Nm", "?angle_arcsec", "?time_s",
)  # fmt: skip
"""Owners of terms that bend the curve near the gap or open a loop, as a late angle does."""
ALL_EXPLAINED = 1.05
"""Of the noise that functions with any loop leave: the scatter of thousand rows is known to 3 %."""
OTHERS = ("torque", "twist", "delayed twist")
"""Forms of time that are no late angle: a late torque, and a twist that lags while the gap does not."""


def late_angle_of(
    prepared: PreparedSweep, explained: ExplainedSweep | None = None
) -> LateAngle | None:
    """What the gap's crossing of a record says; None where it is crossed as well in another way.

    That is: with a shifted torque reading, friction ahead of the teeth, both, soft ends of the gap, a late
    torque reading, or a twist that lags. What a race `explained` by causes may be there in any size.
    """
    history = less_jitter(prepared.sweep.history)
    if ramp_s(history) == 0 or not on_both_sides(history.torque_Nm):
        return None
    gap = prepared.prediction.gap_arcsec
    angle, noise = prepared.sweep.angle_arcsec, prepared.noise.std_arcsec
    terms_found = _found(explained)
    whole = _searched(CrossedRecord(history, angle, gap, noise, tuple(terms_found.values())))
    if whole.nats >= FIRST_NATS:
        return _sized(whole)
    apart = tuple(own for owner, own in terms_found.items() if owner not in IMITATED)
    if len(apart) == len(terms_found):
        return None
    alone = _searched(CrossedRecord(history, angle, gap, noise, apart))
    fewer = NAMED_COST * (len(terms_found) - len(apart))
    if alone.nats >= FIRST_NATS and is_rival(_behind(alone, whole) - fewer, np.inf):
        return _sized(alone)
    return None


def _found(explained: ExplainedSweep | None) -> dict[str, np.ndarray]:
    """What each cause and nuisance term of a race adds (n,), by owner; but for the gap's step itself."""
    if explained is None:
        return {}
    identified = explained.identified
    owners = sorted(set(identified.rms) - {CLEARANCE})
    return {owner: identified.fit.added(owner) for owner in owners}


def _searched(crossed: CrossedRecord) -> _Searched:
    """The likeliest late angle and the likeliest other form."""
    history = crossed.history
    by_time = [list(of_time(history, kind)) for kind in (*LATE_KINDS, *OTHERS)]
    forms = [*by_time, at_a_place(history), softly(history), behind_friction(history)]
    coarse = replace(crossed, most_rows=COARSE_ROWS)
    fits = [coarse.best(tried[::COARSE_EVERY]) for tried in forms]
    best, own = _best_of(fits)
    # local polynomials take the gap's step for noise: what the best form leaves is less
    crossed = replace(crossed, noise_arcsec=_left_by(best))
    if best is not own:
        # as fine as each other, before one is left: of three tried, one may lie far off
        finer = [crossed.best(_beside(forms[fits.index(fit)], fit)) for fit in (own, best)]
        own = crossed.best(_times_about(history, finer[0].tried))
        if own.log_likelihood < finer[1].log_likelihood:
            return _Searched(crossed, own, finer[1]).without_other_loops()
    fits = [crossed.best(_beside(*pair)) for pair in zip(forms, fits, strict=True)]
    best, own = _best_of(fits)
    crossed = replace(crossed, noise_arcsec=_left_by(best))
    others = [crossed.of(fit.tried) for fit in fits[len(LATE_KINDS) :]]
    others += _rubbed(crossed, friction=fits[-1])
    own = crossed.best(_times_about(history, own.tried))
    return _Searched(crossed, own, max(others, key=likeliest)).without_other_loops()


def _best_of(fits: list[CrossingFit]) -> tuple[CrossingFit, CrossingFit]:
    """The likeliest of all, and of the late angles, which stand first."""
    return max(fits, key=likeliest), max(fits[: len(LATE_KINDS)], key=likeliest)


def _times_about(history: History, tried: Tried) -> list[Tried]:
    """Late angles between the neighbours of one that was tried."""
    times = np.geomspace(tried.value / TO_NEIGHBOUR, tried.value * TO_NEIGHBOUR, FINE_TIMES)
    return [late(history, tried.kind, time) for time in times.tolist()]


def _beside(tried: list[Tried], best: CrossingFit) -> list[Tried]:
    """The best of the forms that were tried at first, and those up to its neighbours."""
    at = next(i for i, one in enumerate(tried) if one is best.tried)
    return tried[max(0, at - COARSE_EVERY + 1) : at + COARSE_EVERY]


def _left_by(fit: CrossingFit) -> float:
    return max(fit.left_arcsec, FINEST_ARCSEC)


def _behind(alone: _Searched, whole: _Searched) -> float:
    """Nats by which a late angle explains a record less than the causes that it imitates."""
    noise = min(alone.crossed.noise_arcsec, whole.crossed.noise_arcsec)
    own = replace(alone.crossed, noise_arcsec=noise).of(alone.own.tried)
    other = replace(whole.crossed, noise_arcsec=noise).of(whole.other.tried)
    return (other.log_likelihood - own.log_likelihood) / DEPENDENT


def _rubbed(crossed: CrossedRecord, friction: CrossingFit) -> list[CrossingFit]:
    """The best friction near one of the first search, alone and beside a shifted reading."""
    history, coarse = crossed.history, friction.tried.value
    apart = history.largest_Nm / 100

    def near(offset_Nm: float) -> CrossingFit:
        fine = np.maximum(coarse + apart * np.linspace(-1, 1, 4 * FINE_TIMES + 1), apart / 100)
        return crossed.best(behind_friction(history, fine, offset_Nm))

    alone = near(0.0)
    places = apart * np.linspace(-10, 10, 4 * FINE_TIMES + 1)
    own = np.array([alone.tried.value])
    beside = [behind_friction(history, own, p)[0] for p in places.tolist()]
    shifted = int(np.argmax([crossed.of(one).log_likelihood for one in beside]))
    return [alone, near(float(places[shifted]))]


def _sized(searched: _Searched) -> LateAngle:
    """Time and deviation by how likely each of some neighbouring times is."""
    crossed, tried = searched.crossed, searched.own.tried
    forms = _times_about(crossed.history, tried)
    times = np.array([form.value for form in forms])
    nats = np.array([crossed.of(one).log_likelihood for one in forms]) / DEPENDENT
    weight = np.exp(nats - nats.max())
    time = float(weight @ times / weight.sum())
    spread = weight @ (times - time) ** 2 / weight.sum() + np.diff(times).max() ** 2 / 12
    missed = forms[int(nats.argmax())].form(0.0) - crossed.history.sign
    size_arcsec = crossed.gap_arcsec / 2 * rms(missed)
    return LateAngle(tried.kind, time, float(np.sqrt(spread)), size_arcsec)


@dataclass(frozen=True)
class _Searched:
    """The likeliest late angle of a record, and the likeliest of the other forms."""

    crossed: CrossedRecord
    own: CrossingFit
    other: CrossingFit

    def without_other_loops(self) -> _Searched:
        """Of a delay and friction ahead of the teeth, each with its own loop alone, where that explains all.

        At one rate both cross the gap at one place; at a turn friction holds the twist and a delay lets it go
        on, which functions with any loop make alike. A step that is less than a row late says nothing.
        """
        assert self.crossed.history.time_s is not None
        row_s = float(np.median(np.diff(self.crossed.history.time_s)))
        kinds = self.own.tried.kind, self.other.tried.kind
        if kinds != (DELAY, RUBBED) or self.own.tried.value < row_s:
            return self
        bare = replace(self.crossed, loops=False)
        own, other = bare.of(self.own.tried), bare.of(self.other.tried)
        if min(own.left_arcsec, other.left_arcsec) > ALL_EXPLAINED * self.crossed.noise_arcsec:
            return self
        return _Searched(bare, own, other)

    @property
    def nats(self) -> float:
        """Of the late angle over the other."""
        return (self.own.log_likelihood - self.other.log_likelihood) / DEPENDENT
