"""Torque sweeps: calibrate, race, decide, hold out, and say what to measure next."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from flexspline.geometry.errors import FlexsplineError
from flexspline.pipeline.diagnosis.columns import Columns, columns_of
from flexspline.pipeline.diagnosis.crossing import Crossing, crossing, first_offset
from flexspline.pipeline.diagnosis.effects import causes
from flexspline.pipeline.diagnosis.effects.cause import Cause, Rig
from flexspline.pipeline.diagnosis.effects.torque_program import torque_noise_Nm
from flexspline.pipeline.diagnosis.fleet import UnitShare, unit_shares
from flexspline.pipeline.diagnosis.noise import (
    Noise,
    crossing_band_Nm,
    estimated,
    isolated_outliers,
    rough_residual,
    stretches_of,
)
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.record import Sweep
from flexspline.pipeline.diagnosis.rows import naming_rows, settling, turning
from flexspline.pipeline.diagnosis.search import NAMED_COST, Candidate, Search
from flexspline.pipeline.diagnosis.solution import Solution, solved
from flexspline.pipeline.diagnosis.terms import Race, race, with_terms
from flexspline.pipeline.diagnosis.thinning import thinned
from flexspline.pipeline.diagnosis.tune import tuned
from flexspline.pipeline.diagnosis.weighing import Weighed, weigh

ROUNDS = 1
"""Of noise estimated from what the best set leaves."""
TUNINGS, KINDS = 3, 3
OFFSET_ROUNDS = 4
BESIDE_STEP = 0.01
"""Of the largest torque: nearer to a step of the gap no row judges where the step is."""
OFFSET_NATS, OFFSET_SURE = 9.0, 20.0
OFFSET_LEAST = (0.012, 0.005)
"""Of the largest torque: smaller offsets move nothing that counts; the second where it is sure."""
FEWEST_KEPT, PER_UNIT = 12, 4
"""Rows that are needed, and for each further unit: it has a zero, a stiffness and a gap."""


class TooFewRowsError(FlexsplineError, ValueError):
    """Too few rows lie outside the gap's crossing and the torque's turns: `count` of `wanted`."""

    def __init__(self, count: int, wanted: int) -> None:
        self.count, self.wanted = count, wanted
        super().__init__(
            f"only {count} rows lie outside the gap's crossing and the torque's turns;"
            f" {wanted} are needed"
        )


@dataclass(frozen=True)
class Prepared:
    """A sweep with its rows sorted out.

    Attributes
    ----------
    kept : (n,) rows that name causes: outside the gap crossing, no outliers.
    outlier : (n,). band_Nm : half width of the crossing. offset_Nm : taken off the torque reading.
    """

    sweep: Sweep
    prediction: Prediction
    rig: Rig
    columns: Columns
    target: np.ndarray
    kept: np.ndarray
    outlier: np.ndarray
    band_Nm: float
    rows_per_cycle: float
    noise: Noise
    offset_Nm: float = 0.0


@dataclass(frozen=True)
class Explained:
    """A prepared sweep and its decided race; `crossing` where the gap's crossing was seen."""

    prepared: Prepared
    weighed: Weighed
    crossing: Crossing | None
    offset_Nm: float
    offset_nats: float

    @cached_property
    def shares(self) -> dict[str, UnitShare]:
        """How much of each named cause each unit shows, by cause id; none for a single unit."""
        if len(self.prepared.sweep.units) < 2:
            return {}
        return {c: unit_shares(self.weighed, c) for c in self.weighed.named}


def prepare(sweep: Sweep, prediction: Prediction, offset_Nm: float = 0.0) -> Prepared:
    """Sort the rows out and evaluate every term.

    Raises
    ------
    TooFewRowsError
    """
    history = sweep.history.shifted(offset_Nm) if offset_Nm else sweep.history
    if history.time_s is None:
        history = replace(history, time_s=np.arange(len(history), dtype=float))
    rig = Rig(prediction, history)
    target = sweep.angle_arcsec - prediction.angle_arcsec(history)
    band = crossing_band_Nm(history)
    kept = naming_rows(history, band)
    count = sum(len(np.unique(history.cycle[rows])) for rows in history.unit_slices)
    per_cycle = len(history) / count
    wanted = FEWEST_KEPT + PER_UNIT * (len(history.unit_slices) - 1)
    if int(kept.sum()) < wanted:
        raise TooFewRowsError(int(kept.sum()), wanted)
    rough = rough_residual(target, history, kept, per_cycle)
    spread = 1.4826 * float(np.median(np.abs(rough))) + 1e-9
    outlier = np.zeros(len(kept), bool)
    outlier[kept] = isolated_outliers(rough, history.rows(kept), spread)
    good = ~outlier[kept]
    kept &= ~outlier
    noise = estimated(rough[good], stretches_of(history, kept), per_cycle, int(kept.sum()) // 6)
    return Prepared(
        sweep,
        prediction,
        rig,
        columns_of(rig, _knowable(sweep)),
        target,
        kept,
        outlier,
        band,
        per_cycle,
        noise,
        offset_Nm,
    )


def _knowable(sweep: Sweep) -> dict[str, Cause]:
    """Causes that the record's channels let one speak of."""
    timed = sweep.history.time_s is not None
    return {name: c for name, c in causes().items() if timed or not c.needs_time}


def explain(prepared: Prepared) -> tuple[Prepared, Weighed]:
    """Race, with the noise estimated anew from what the best set leaves, and shapes tuned."""
    for _ in range(ROUNDS):
        now = _tuned_race(_race(prepared))
        best = Search(now).run()
        left = solved(now, best.terms).residual()
        prepared = replace(_with_noise(prepared, left, len(best.terms)), columns=now.columns)
    now = _tuned_race(_race(prepared))
    return replace(prepared, columns=now.columns), weigh(now, prepared.offset_Nm != 0.0)


def _tuned_race(now: Race) -> Race:
    """The race with tuned shapes: of the best named set, of each cause alone, of the best of all.

    Named causes are tuned before any competitor is let in: a shape from a coarse grid leaves a
    misfit, which a competitor would fill.
    """
    named = Search(now, lambda t: t.cause is not None)
    best = named.run()
    for _ in range(TUNINGS):
        sets = [best.terms, *_alone(named, best)]
        shapes = [pair for terms in sets if terms for pair in tuned(now, terms).shapes]
        wider = with_terms(now, shapes)
        if wider is now:
            break
        now = wider
        named = Search(now, lambda t: t.cause is not None)
        before, best = best.score, named.run([best.terms, ()])
        if best.score < before + 1.0:
            break
    return now


def _alone(search: Search, best: Candidate) -> list[tuple[int, ...]]:
    """Sets of one cause alone that explain a good part of what the best set does.

    The best set of each cause, and its best few single shapes of different kinds: which kind is best
    may change once each is tuned.
    """
    race_ = search.race
    enough = 0.5 * best.evidence
    found = {
        c.terms for owners, c in search.best.items() if len(owners) == 1 and c.evidence > enough
    }
    kinds: dict[str, dict[tuple[float, ...], Candidate]] = {}
    for c in sorted(search.weighed, key=lambda c: -c.evidence):
        if len(c.terms) != 1 or c.evidence < enough:
            continue
        term = race_.terms[c.terms[0]]
        assert term.cause is not None
        kind = tuple(v for k, v in sorted(term.shape.items()) if k not in term.cause.tunable)
        mine = kinds.setdefault(term.owner, {})
        if len(mine) < KINDS:
            mine.setdefault(kind, c)
    found |= {c.terms for mine in kinds.values() for c in mine.values()}
    return sorted(found - {best.terms})


def _race(prepared: Prepared) -> Race:
    return race(prepared.columns, prepared.target, prepared.kept, prepared.noise)


def _with_noise(prepared: Prepared, left: np.ndarray, used: int) -> Prepared:
    history = prepared.rig.history
    inside = naming_rows(history, prepared.band_Nm)
    spread = 1.4826 * float(np.median(np.abs(left[inside & ~prepared.outlier])))
    outlier = np.zeros(len(left), bool)
    outlier[inside] = isolated_outliers(left[inside], history.rows(inside), spread + 1e-9)
    kept = inside & ~outlier
    noise = estimated(left[kept], stretches_of(history, kept), prepared.rows_per_cycle, used + 3)
    return replace(prepared, noise=noise, kept=kept, outlier=outlier)


def diagnosed(sweep: Sweep, prediction: Prediction) -> Explained:
    """The whole race, with and without an offset of the torque reading."""
    sweep = thinned(sweep)
    prepared, weighed = explain(prepare(sweep, prediction))
    seen = seen_crossing(prepared, weighed.solution)
    plain = Explained(prepared, weighed, seen, 0.0, 0.0 if seen is None else seen.nats)
    guess = first_offset(sweep.history, sweep.angle_arcsec, prediction.gap_arcsec, prepared.band_Nm)
    if seen is not None and _counts(seen, prepared):
        return _with_offset(sweep, prediction, seen.offset_Nm) or plain
    if abs(guess) < prepared.band_Nm / 2:
        return plain
    shifted = _with_offset(sweep, prediction, guess)
    return shifted if shifted is not None and _better(shifted, plain) else plain


def _counts(seen: Crossing, prepared: Prepared) -> bool:
    """Whether an offset is sure and large enough to be said."""
    least = OFFSET_LEAST[seen.nats > OFFSET_SURE] * prepared.rig.torque_Nm
    return seen.nats > OFFSET_NATS and abs(seen.offset_Nm) > least


def _with_offset(sweep: Sweep, prediction: Prediction, offset_Nm: float) -> Explained | None:
    """The race with an offset taken off, and the offset found anew from it; None where it vanishes."""
    for _ in range(OFFSET_ROUNDS):
        try:
            prepared, weighed = explain(prepare(sweep, prediction, offset_Nm))
        except TooFewRowsError:
            return None
        seen = seen_crossing(prepared, weighed.solution)
        if seen is None or not _counts(seen, prepared):
            return None
        if abs(seen.offset_Nm - offset_Nm) < max(0.5 * seen.std_Nm, 0.001 * prepared.rig.torque_Nm):
            break
        offset_Nm = seen.offset_Nm
    assert seen is not None
    return Explained(prepared, weighed, seen, offset_Nm, seen.nats)


def _better(shifted: Explained, plain: Explained) -> bool:
    """Whether the record is better explained with the offset, the cause's cost paid.

    Judged on all rows but those whose side of the gap is unsure with it or without.
    """
    torque = plain.prepared.rig.history.torque_Nm
    side = max(
        BESIDE_STEP * plain.prepared.rig.torque_Nm, 4 * torque_noise_Nm(plain.prepared.rig.history)
    )
    common = (np.abs(torque) > side) & (np.abs(torque - shifted.offset_Nm) > side)
    common &= ~(shifted.prepared.outlier & plain.prepared.outlier)
    common &= ~(turning(plain.prepared.rig.history) | settling(plain.prepared.rig.history))
    quieter = min((shifted, plain), key=lambda e: e.prepared.noise.std_arcsec).prepared.noise

    def total(e: Explained) -> float:
        p = e.prepared
        again = race(p.columns, p.target, common, quieter)
        found = Search(again).candidate(e.weighed.best.terms)
        gain = float(again.base_right @ np.linalg.solve(again.base_gram, again.base_right))
        return found.score + gain / 2 - again.total / 2 - np.linalg.slogdet(again.base_gram)[1] / 2

    return total(shifted) - NAMED_COST > total(plain)


def seen_crossing(prepared: Prepared, solution: Solution) -> Crossing | None:
    """The crossing as read, with everything but the gap taken off the measured angle."""
    history = prepared.rig.history
    gap = solution.measured_rig().gap_arcsec
    good = ~prepared.outlier
    left = solution.residual() + history.sign * gap / 2
    return crossing(
        history.torque_Nm[good] + prepared.offset_Nm, left[good], gap,
        prepared.noise.std_arcsec, torque_noise_Nm(history),
    )  # fmt: skip
