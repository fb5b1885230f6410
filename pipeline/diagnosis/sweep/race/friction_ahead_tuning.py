"""Friction ahead of the teeth, refined by Gauss-Newton steps of its torque and its stiffness ratio.

Both are nonlinear: they change what every other term sees. At each step the terms of a set, and the
calibration, are evaluated and fitted again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import AHEAD, FRICTION
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_jitter import behind
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.sweep.crossing.gap_crossing import Crossing
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    log_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep, true_history
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import NOISE_COLUMNS, base_columns
from flexspline.pipeline.diagnosis.sweep.evidence.shape_tuning import ENOUGH_NATS

AHEAD_STEPS = 8
"""Most steps. From a guess within 1 % of the largest torque, four are usual."""
LONGEST_LOG_STEPS = (0.25, 1.2)
"""Of a step, in the logarithms of friction torque and stiffness ratio: a quarter of the one, a factor of
three of the other, which changes the loop less. Half or twice as long, no verdict of the 8 records of
`friction_ahead_race.AHEAD_RACES` changes."""
LOG_DIFFERENCES = (0.01, 0.1)
"""Steps of the two logarithms, for slopes. Judgement: the loop changes less with the second."""
STIFFNESS_RATIO, RATIO_STD = 30.0, 1.5
"""Of a bearing before it slips against the gear: seals 3, rolling bearings 300, by judgement; the prior of
its log."""
AHEAD_STEP_SHARES = (1.0, 0.35, 0.1)
"""Shares of a step that are tried: all of it, and less if that loses evidence. Judgement."""


@dataclass(frozen=True)
class TunedAhead:
    """The element, the standard deviation of its torque, and the evidence beside the terms it was tuned with,
    but for a constant."""

    element: Element
    torque_std_Nm: float
    nats: float


def ahead_element(friction_Nm: float, history: History) -> Element:
    """Friction of a torque, of a usual bearing."""
    shape = {AHEAD: STIFFNESS_RATIO, "deadband_Nm": deadband_Nm(history)}
    return Element(shape, (friction_Nm,))


def tuned_ahead(
    prepared: PreparedSweep,
    evidence: GaussianEvidence,
    terms: Sequence[int],
    seen: Crossing | None = None,
) -> TunedAhead:
    """The friction with which a set of terms explains the record best.

    `seen` : where the gap is crossed, which alone tells it from friction behind the gap.
    """
    start = prepared.ahead
    assert start is not None
    point = np.log([start.amplitudes[0], start.shape[AHEAD]])
    trial = _Trial(prepared, evidence, tuple(terms), seen)
    now = trial.at(point)
    for _ in range(AHEAD_STEPS):
        slopes = np.column_stack([
            (trial.left(point + d * np.eye(2)[k], now.mean) - now.left) / d
            for k, d in enumerate(LOG_DIFFERENCES)
        ])  # fmt: skip
        step, covariance = trial.step(now, slopes, point)
        if not np.isfinite(step).all():
            break
        gained = 0.0
        for share in AHEAD_STEP_SHARES:
            moved = point + share * np.clip(step, np.negative(LONGEST_LOG_STEPS), LONGEST_LOG_STEPS)
            then = trial.at(moved)
            if then.value > now.value:
                gained = then.value - now.value
                point, now = moved, then
                break
        std = float(np.sqrt(covariance[0, 0]) * np.exp(point[0]))
        if gained < ENOUGH_NATS:
            break
    return TunedAhead(trial.element(point), std, now.value)


def amplitudes_per_Nm(
    prepared: PreparedSweep, evidence: GaussianEvidence, terms: Sequence[int]
) -> np.ndarray:
    """(p,) by how much each parameter of a fit changes with the friction's torque, each in its unit per N·m.

    In the order of the fit's posterior, which holds for the torque that was found.
    """
    start = prepared.ahead
    assert start is not None
    point = np.log([start.amplitudes[0], start.shape[AHEAD]])
    trial = _Trial(prepared, evidence, tuple(terms), None)
    step = np.array([LOG_DIFFERENCES[0], 0.0])
    change = trial.at(point + step).mean - trial.at(point - step).mean
    scale = [evidence.terms[i].prior for i in terms]
    change *= np.concatenate([np.ones(len(evidence.base_right)), *scale])
    return np.asarray(change / (2 * LOG_DIFFERENCES[0] * start.amplitudes[0]))


@dataclass(frozen=True)
class _State:
    x: np.ndarray
    precision: np.ndarray
    mean: np.ndarray
    left: np.ndarray
    value: float


@dataclass(frozen=True)
class _Trial:
    prepared: PreparedSweep
    evidence: GaussianEvidence
    terms: tuple[int, ...]
    seen: Crossing | None

    @cached_property
    def true(self) -> History:
        """At the output; what operators make of it is made once."""
        return true_history(self.prepared.sweep, self.prepared.offset_Nm)

    def element(self, point: np.ndarray) -> Element:
        start = self.prepared.ahead
        assert start is not None
        friction, ratio = (float(v) for v in np.exp(point))
        return Element({**start.shape, AHEAD: ratio}, (friction,))

    def columns(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Whitened columns (r, b + k), their prior's precision, and the whitened target (r,)."""
        p, sweep = self.prepared, self.prepared.sweep
        teeth = known_causes()[FRICTION].at_teeth((self.element(point),), self.true)
        # found again from each friction, the noise would take most of the time
        history = behind(self.true, self.true.torque_Nm - teeth.torque_Nm)
        rig = FitContext(p.prediction, history)
        base, prior = base_columns(rig, self.evidence.columns.base[:, -NOISE_COLUMNS:])
        blocks = [base]
        precision = [prior**-2]
        for i in self.terms:
            term = self.evidence.terms[i]
            own = self.evidence.columns.all[:, term.at].astype(float)
            if term.cause is not None:
                own = term.cause.columns(term.shape, history)
            blocks.append(own * term.prior)
            precision.append(np.ones(own.shape[1]))
        target = sweep.angle_arcsec - p.prediction.for_race.angle_arcsec(history)
        white = self.evidence.whitened(np.column_stack([*blocks, target]))
        return white[:, :-1], np.concatenate(precision), white[:, -1]

    def at(self, point: np.ndarray) -> _State:
        x, precision, y = self.columns(point)
        matrix = x.T @ x + np.diag(precision)
        right = x.T @ y
        mean = np.linalg.solve(matrix, right)
        fit = log_evidence(matrix, right) - float(y @ y) / 2
        off, known = self._beside(point)
        return _State(x, precision, mean, y - x @ mean, fit - float(known @ off**2) / 2)

    def left(self, point: np.ndarray, mean: np.ndarray) -> np.ndarray:
        x, _, y = self.columns(point)
        return y - x @ mean

    def step(
        self, now: _State, slopes: np.ndarray, point: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Step of the two logarithms, and their covariance, all amplitudes marginalised."""
        k = now.x.shape[1]
        whole = np.hstack([now.x, -slopes])
        precision = now.precision
        off, known = self._beside(point)
        matrix = whole.T @ whole + np.diag(np.r_[precision, known])
        right = whole.T @ now.left - np.r_[precision * now.mean, known * off]
        inverse = np.linalg.inv(matrix)
        return (inverse @ right)[k:], inverse[k:, k:]

    def _beside(self, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far the logarithms are off what else is known of them, and its precision."""
        off = np.array([0.0, point[1] - np.log(STIFFNESS_RATIO)])
        known = np.array([0.0, RATIO_STD**-2])
        if self.seen is not None:
            friction = np.exp(point[0])
            off[0] = (friction - self.seen.offset_Nm) / friction
            known[0] = (friction / self.seen.std_Nm) ** 2
        return off, known
