"""The race with and without an offset of the torque reading."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.measurement.torque_program import torque_noise_Nm
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.sweep.decision import Decision
from flexspline.pipeline.diagnosis.sweep.evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep, TooFewRowsError, prepare
from flexspline.pipeline.diagnosis.sweep.race import explain
from flexspline.pipeline.diagnosis.sweep.row_selection import settling, turning
from flexspline.pipeline.diagnosis.sweep.search import NAMED_COST, Search
from flexspline.pipeline.diagnosis.sweep.torque_offset import Crossing, crossing, first_offset
from flexspline.pipeline.diagnosis.sweep.unit_amplitudes import UnitAmplitudes, unit_amplitudes

OFFSET_ROUNDS = 4
BESIDE_STEP = 0.01
"""Of the largest torque: nearer to a step of the gap no row judges where the step is."""
OFFSET_NATS, OFFSET_SURE = 9.0, 20.0
OFFSET_LEAST = (0.012, 0.005)
"""Of the largest torque: smaller offsets move nothing that counts; the second where it is sure."""


@dataclass(frozen=True)
class ExplainedSweep:
    """A prepared sweep and its decided race; `crossing` where the gap's crossing was seen."""

    prepared: PreparedSweep
    decision: Decision
    crossing: Crossing | None
    offset_Nm: float
    offset_nats: float

    @cached_property
    def shares(self) -> dict[str, UnitAmplitudes]:
        """How much of each named cause each unit shows, by cause id; none for a single unit."""
        if len(self.prepared.sweep.units) < 2:
            return {}
        return {c: unit_amplitudes(self.decision, c) for c in self.decision.named}


def diagnosed(sweep: Sweep, prediction: Prediction) -> ExplainedSweep:
    """The whole race, with and without an offset of the torque reading."""
    sweep = thinned(sweep)
    prepared, decision = explain(prepare(sweep, prediction))
    seen = seen_crossing(prepared, decision.fit)
    plain = ExplainedSweep(prepared, decision, seen, 0.0, 0.0 if seen is None else seen.nats)
    guess = first_offset(sweep.history, sweep.angle_arcsec, prediction.gap_arcsec, prepared.band_Nm)
    if seen is not None and _counts(seen, prepared):
        return _with_offset(sweep, prediction, seen.offset_Nm) or plain
    if abs(guess) < prepared.band_Nm / 2:
        return plain
    shifted = _with_offset(sweep, prediction, guess)
    return shifted if shifted is not None and _better(shifted, plain) else plain


def _counts(seen: Crossing, prepared: PreparedSweep) -> bool:
    """Whether an offset is sure and large enough to be said."""
    least = OFFSET_LEAST[seen.nats > OFFSET_SURE] * prepared.rig.torque_Nm
    return seen.nats > OFFSET_NATS and abs(seen.offset_Nm) > least


def _with_offset(sweep: Sweep, prediction: Prediction, offset_Nm: float) -> ExplainedSweep | None:
    """The race with an offset taken off, and the offset found anew from it; None where it vanishes."""
    for _ in range(OFFSET_ROUNDS):
        try:
            prepared, decision = explain(prepare(sweep, prediction, offset_Nm))
        except TooFewRowsError:
            return None
        seen = seen_crossing(prepared, decision.fit)
        if seen is None or not _counts(seen, prepared):
            return None
        if abs(seen.offset_Nm - offset_Nm) < max(0.5 * seen.std_Nm, 0.001 * prepared.rig.torque_Nm):
            break
        offset_Nm = seen.offset_Nm
    assert seen is not None
    return ExplainedSweep(prepared, decision, seen, offset_Nm, seen.nats)


def _better(shifted: ExplainedSweep, plain: ExplainedSweep) -> bool:
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

    def total(e: ExplainedSweep) -> float:
        p = e.prepared
        again = gaussian_evidence(p.columns, p.target, common, quieter)
        found = Search(again).candidate(e.decision.best.terms)
        gain = float(again.base_right @ np.linalg.solve(again.base_gram, again.base_right))
        return found.score + gain / 2 - again.total / 2 - np.linalg.slogdet(again.base_gram)[1] / 2

    return total(shifted) - NAMED_COST > total(plain)


def seen_crossing(prepared: PreparedSweep, fit: SweepFit) -> Crossing | None:
    """The crossing as read, with everything but the gap taken off the measured angle."""
    history = prepared.rig.history
    gap = fit.measured_rig().gap_arcsec
    good = ~prepared.outlier
    left = fit.residual() + history.sign * gap / 2
    return crossing(
        history.torque_Nm[good] + prepared.offset_Nm, left[good], gap,
        prepared.noise.std_arcsec, torque_noise_Nm(history),
    )  # fmt: skip
