"""The measurement that would distinguish rivals best, computed from their predictions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Cause
from flexspline.pipeline.diagnosis.causes.rate_dependence import FASTER
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.torque_offset import OFFSET
from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_s
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import Aim, Doing, NextMeasurement
from flexspline.pipeline.diagnosis.plans import MeasurementPlan, most_telling
from flexspline.pipeline.diagnosis.prediction import REFERENCE_C
from flexspline.pipeline.diagnosis.rated_limit import WORTH_SHARE, within_rated
from flexspline.pipeline.diagnosis.structure import BackwardLoop, DraggedCrossing, LateAngle
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors, model_of
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.held_out_splits import rate_range, whole_levels
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep

PLANNED_CYCLE_ROWS = 64
"""Rows of one triangular cycle. Sixteen between zero and the largest torque show its shape."""
DEFAULT_RAMP_S = 30.0
"""[s] Time of a ramp if the record has no times: a usual pace of a rig. Judgement."""
WARMER_K = 20.0
"""From 20 to 40 °C; the separation of rivals by this plan grows in proportion to it."""
POSITIONS_DEG = (0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0)
"""Steps of 50° tell the harmonics 1, 2 and 4 per turn apart; at steps of 60° 4 is an alias of 2."""
LONG_HOLD = 20.0
"""Length of a long hold in ramps: two decades of time from a fifth of a ramp on, over which creep and lag
differ."""
AMPLITUDES = (0.25, 0.5, 1.0, 1.5)
"""Times the largest torque: two octaves within the record, and half as much again beyond it, but not beyond
rated torque."""
MORE_CYCLES = 40
"""Wear that saturates is over by then (`wear.RUN_IN_CYCLES` reaches 6), even wear adds in proportion."""


@dataclass(frozen=True)
class _PlannedCycles:
    """Triangular cycles like those of a record, but for what is said of each."""

    largest_Nm: float
    ramp_s: float
    temperature_C: float

    @classmethod
    def like(cls, prepared: PreparedSweep) -> _PlannedCycles:
        history, warm = prepared.sweep.history, prepared.rig.history.temperature_C
        return cls(
            history.largest_Nm,
            ramp_s(history) or DEFAULT_RAMP_S,
            REFERENCE_C if warm is None else float(np.mean(warm)),
        )

    def of(
        self, amplitudes: Sequence[float] = (1.0, 1.0), ramps: Sequence[float] = (1.0, 1.0),
        warmer: Sequence[float] = (0.0, 0.0), places: Sequence[float] = (0.0, 0.0),
        numbers: Sequence[int] = (0, 0), hold: float = 0.0,
    ) -> History:  # fmt: skip
        """Amplitudes, ramps and holds in multiples of the record's, K warmer, places [°], cycle numbers."""
        torque, time, temperature, place, cycle = [], [], [], [], []
        now = 0.0
        for a, r, w, p, c in zip(amplitudes, ramps, warmer, places, numbers, strict=True):
            t, at = _triangle(self.largest_Nm * a, self.ramp_s * r * a, hold * self.ramp_s)
            torque.append(t)
            time.append(now + at)
            now += at[-1]
            temperature.append(np.full(len(t), self.temperature_C + w))
            place.append(np.full(len(t), p))
            cycle.append(np.full(len(t), c))
        n = sum(map(len, torque))
        return History(
            np.concatenate(torque), np.zeros(n, int), np.concatenate(cycle), np.concatenate(time),
            np.concatenate(temperature), np.concatenate(place), exact=True,
        )  # fmt: skip


def plans(prepared: PreparedSweep) -> list[MeasurementPlan]:
    """Each plan holds a part like the record so far and a part where one thing is changed."""
    h, cycles = prepared.rig.history, _PlannedCycles.like(prepared)
    last = int(h.cycle.max())
    place0 = float(h.input_angle_deg[0]) if h.input_angle_deg is not None else 0.0
    many = [place0 + p for p in POSITIONS_DEG]
    larger = _larger(prepared)
    amplitudes = [t / cycles.largest_Nm for t in larger.torques_Nm]
    k, n = len(many), len(amplitudes)
    slower, faster, beyond = _rates_beyond(prepared.sweep.history, cycles.ramp_s)
    same = (place0, place0)
    return [
        MeasurementPlan(
            "temperature_C",
            Doing("warmer"),
            cycles.of(warmer=(0.0, WARMER_K), places=same, numbers=(last, last)),
        ),
        MeasurementPlan(
            "torque_rate",
            Doing("beyond_own_rates" if beyond else "other_rates"),
            cycles.of((1.0,) * 3, (1.0, slower, faster), (0.0,) * 3, (place0,) * 3, (last,) * 3),
        ),
        MeasurementPlan(
            "hold",
            Doing("hold"),
            cycles.of(places=same, numbers=(last, last), hold=LONG_HOLD),
        ),
        MeasurementPlan(
            "torque_amplitude",
            larger,
            cycles.of(amplitudes, (1.0,) * n, (0.0,) * n, (place0,) * n, (last,) * n),
        ),
        MeasurementPlan(
            "input_angle_deg",
            Doing("other_positions"),
            cycles.of((1.0,) * k, (1.0,) * k, (0.0,) * k, many, (last,) * k),
        ),
        MeasurementPlan(
            "cycle",
            Doing("more_cycles"),
            cycles.of(places=same, numbers=(last, last + MORE_CYCLES)),
        ),
    ]


def _larger(prepared: PreparedSweep) -> Doing:
    """Amplitudes within the record, and one that shows what it has not: how an effect goes on beyond."""
    largest, rated = prepared.sweep.history.largest_Nm, prepared.prediction.rated_Nm
    torques = within_rated((share * largest for share in AMPLITUDES), largest, rated)
    return Doing("larger_torque", torques, rated)


def _goes_beyond(doing: Doing, prepared: PreparedSweep) -> bool:
    """Whether the larger torques are larger than the record's."""
    return max(doing.torques_Nm) > WORTH_SHARE * prepared.sweep.history.largest_Nm


def _rates_beyond(history: History, ramp_s: float) -> tuple[float, float, bool]:
    """Ramps of a slower and a faster sweep as multiples of the typical one, and whether cycles differ.

    Where they differ by `FASTER` already, so many times beyond the slowest and the quickest.
    """
    quickest, slowest = rate_range(history)
    if quickest < FASTER * slowest or slowest == 0:
        return FASTER, 1 / FASTER, False
    typical = history.largest_Nm / ramp_s
    return FASTER * typical / slowest, typical / (FASTER * quickest), True


def _triangle(amplitude: float, ramp: float, hold: float) -> tuple[np.ndarray, np.ndarray]:
    """Torque [N·m] and time [s] of 0 → +A → (hold) → −A → (hold) → 0."""
    quarter = np.arange(1, PLANNED_CYCLE_ROWS // 4 + 1) / (PLANNED_CYCLE_ROWS // 4)
    half = np.arange(1, PLANNED_CYCLE_ROWS // 2 + 1) / (PLANNED_CYCLE_ROWS // 2)
    up, down = amplitude * quarter, amplitude * (1 - 2 * half)
    parts = [(up, ramp), (down, 2 * ramp), (-amplitude * (1 - quarter), ramp)]
    torque, time, now = [], [], 0.0
    for i, (values, length) in enumerate(parts):
        at = now + length * np.arange(1, len(values) + 1) / len(values)
        torque.append(values)
        time.append(at)
        now = at[-1]
        if hold > 0 and i < 2:
            n = PLANNED_CYCLE_ROWS // 4
            torque.append(np.full(n, values[-1]))
            time.append(now + hold * np.arange(1, n + 1) / n)
            now += hold
    return np.concatenate(torque), np.concatenate(time)


def next_measurement(explained: ExplainedSweep, decision: Decision) -> NextMeasurement | None:
    """What to measure next: to find the unknown effect, to distinguish rivals, or to confirm the smallest
    cause."""
    if decision.verdict == "unknown" and decision.unexplained:
        worst = decision.unexplained[0]
        return NextMeasurement(worst.channel, "find_structure", structure=worst.structure)
    unsure = [c for c in decision.causes if c.alternatives] or list(decision.causes[-1:])
    if not unsure:
        return None
    two_words = [c for c in decision.causes if c.or_temperature]
    if two_words and not unsure[0].alternatives:
        order = Doing("temperatures_in_other_order")
        return NextMeasurement("temperature_C", "confirm", (two_words[0].id,), order)
    cause, rivals = unsure[0].id, unsure[0].alternatives
    aim: Aim = "separate" if rivals else "confirm"
    models = _rival_models(explained, decision, cause) if rivals else []
    if len(models) < 2:
        vary = known_causes()[cause].vary
        doing: Doing | None = None
        larger = _larger(explained.prepared)
        if aim == "confirm" and _has_shown(known_causes()[cause], explained):
            if known_causes()[cause].shows_over == "input_angle_deg":  # whatever the torque
                doing = Doing("between_positions")
            elif _goes_beyond(larger, explained.prepared):
                vary, doing = "torque_amplitude", larger
            else:
                return None
        if rivals == (SERIES,):  # a loop shrinks with its amplitude, a spring does not
            vary, doing = "torque_amplitude", larger
        if rivals == (OFFSET,):  # the torque cell's zero, which it shows by itself
            vary, doing = "torque_Nm", Doing("read_torque_zero")
        return NextMeasurement(vary, aim, (cause, *rivals), doing)
    noise = explained.prepared.noise.std_arcsec
    best = most_telling(plans(explained.prepared), models, noise)
    return NextMeasurement(best.vary, aim, (cause, *rivals), best.doing, separation=best.separation)


def after_late(late: BackwardLoop | LateAngle | DraggedCrossing) -> NextMeasurement:
    """What tells more of a reading that comes late, of drag, or of a torque cell with a hysteresis."""
    if isinstance(late, DraggedCrossing):
        return NextMeasurement("torque_rate", "find_structure", doing=Doing("slower"))
    if isinstance(late, LateAngle):
        return NextMeasurement("torque_rate", "find_structure", doing=Doing("compare_channels"))
    if late.grows is False:
        return NextMeasurement("torque_Nm", "find_structure", doing=Doing("weigh_torque_cell"))
    return NextMeasurement(
        "torque_rate", "find_structure", doing=Doing("compare_channels_and_cell")
    )


def _has_shown(cause: Cause, explained: ExplainedSweep) -> bool:
    """Whether the record itself varies what would be asked for to confirm a cause, as far as that."""
    history = explained.prepared.sweep.history
    if cause.vary == "torque_rate":
        quickest, slowest = rate_range(history)
        return quickest >= FASTER * slowest > 0
    if cause.vary != cause.shows_over:  # it is confirmed by something else
        return False
    if cause.vary == "input_angle_deg":
        positions = history.input_angle_deg
        return positions is not None and len(np.unique(positions)) >= len(POSITIONS_DEG)
    if cause.vary == "cycle":
        return int(history.cycle.max()) >= MORE_CYCLES
    return any(split.what.channel == cause.vary for split in whole_levels(history, timed=False))


def _rival_models(explained: ExplainedSweep, decision: Decision, cause: str) -> list[ExtendedModel]:
    """The best set's model, and the one of the rival that comes nearest in a cause's place."""
    identified, sweep = explained.identified, explained.prepared.sweep
    offset = explained.offset_Nm
    models = [model_of(identified.fit, sweep, [c.id for c in decision.causes], offset)]
    rival = identified.rival_sets.get(cause)
    if rival is not None:
        fit = fit_regressors(identified.search.evidence, rival.terms)
        models.append(model_of(fit, sweep, sorted(fit.elements()), offset))
    return models
