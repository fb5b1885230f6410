"""How far a reading may lie from the prediction of an extended model, row by row."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import AHEAD, FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.friction_memory import (
    half_loop_arcsec,
    memory_variance,
    smaller_loops,
)
from flexspline.pipeline.diagnosis.model.span import MeasuredSpan, beyond, clipped, times_slower

BEYOND_THE_EDGE = 0.5
"""Of what a cause adds beyond the most that it adds within what was measured: laws that agree inside go apart
outside. A cubic and a quadratic hardening, each fitted to the other, differ by 0.4 and 0.6 of that at one
and a half times the record's largest torque."""
CARRIED_UNSURE = 0.03
"""Of the torque that friction ahead of the gap carries; by judgement, after made-up records."""
CARRIED_STEP = 0.003
"""Step for slopes, as a share of that torque. Judgement: small against curvature, large against rounding."""
MOST_PARAMETERS = 120
"""Of a covariance in a file: sixty thousand letters. Many units: a zero, a stiffness and a gap each."""


@dataclass(frozen=True)
class PredictionUncertainty:
    """What a model's predictions may be off by.

    Attributes
    ----------
    reading_arcsec : the largest of the rms error on rows that were not used for fitting, the noise of all
        rows used, and the rounding to an encoder's steps. torque_noise_Nm : of the torque reading.
    covariance : (p, p) of the parameters in the order of `parameter_columns`; (0, 0): too many to be kept.
    span : what was measured; predictions beyond are extrapolated.
    crossing_Nm : over which the record's own rows lie in the gap or beyond its other side, beside the noise.
    """

    reading_arcsec: float
    torque_noise_Nm: float
    covariance: np.ndarray
    span: MeasuredSpan
    crossing_Nm: float = 0.0


@dataclass(frozen=True)
class Deviation:
    """`std_arcsec` (n,) of a reading from its prediction; `rows_beyond`: rows outside, by channel."""

    std_arcsec: np.ndarray
    rows_beyond: dict[str, int]


def parameter_columns(
    model: ExtendedModel, read: History, true: History, units: tuple[str, ...]
) -> np.ndarray:
    """(n, p) what one of each parameter adds to the angle, of a true history and that at the teeth.

    In this order: the zeros; compliance; gap; each unit's own compliance and gap; the amplitudes of each
    cause's elements. Of one ahead of the teeth, what it takes of the wind-up, and of all that acts behind it.
    """
    of_unit = [
        np.isin(true.unit, [u for u, given in enumerate(units) if given == name]).astype(float)
        for name in model.zeros_arcsec
    ]
    torque, side = true.torque_Nm, true.sign / 2
    own = [column for rows in of_unit for column in (rows * torque, rows * side)]
    columns = [*of_unit, torque, side, *(own if model.own else [])]
    blocks = [np.column_stack(columns)]
    for cause_id, elements in model.elements.items():
        for e in elements:
            cause = known_causes()[cause_id]
            at_teeth = cause.at_teeth((e,), read)
            if at_teeth is read:
                blocks.append(cause.columns(e.shape, true))
            else:
                blocks.append(_per_Nm(model, cause_id, e, read, units)[:, None])
    return np.hstack(blocks)


def _per_Nm(
    model: ExtendedModel, cause_id: str, ahead: Element, read: History, units: tuple[str, ...]
) -> np.ndarray:
    """(n,) what 1 N·m more of friction ahead of the teeth adds to the angle, but for the gap's crossing.

    Where the crossing moves past a row, what the wind-up adds alone.
    """
    step = CARRIED_STEP * ahead.amplitudes[0]
    moved = [
        replace(ahead, amplitudes=(ahead.amplitudes[0] + d,)) for d in (-step, step)
    ]  # fmt: skip
    ends = [_with_element(model, cause_id, ahead, e) for e in moved]
    low, high = (m.at_teeth(read) for m in ends)
    less, more = (
        replace(m, gap_arcsec=0.0, own={u: (c, 0.0) for u, (c, _) in model.own.items()}).angle_of(read, units)
        for m in ends
    )  # fmt: skip
    wind_up = model.compliance * (high.torque_Nm - low.torque_Nm)
    return np.asarray(np.where(low.sign == high.sign, more - less, wind_up) / (2 * step))


def _with_element(model: ExtendedModel, cause_id: str, old: Element, new: Element) -> ExtendedModel:
    changed = tuple(new if e is old else e for e in model.elements[cause_id])
    return replace(model, elements={**model.elements, cause_id: changed})


def parameter_count(model: ExtendedModel) -> int:
    """The p of `parameter_columns`."""
    amplitudes = sum(len(e.amplitudes) for of in model.elements.values() for e in of)
    units = len(model.zeros_arcsec)
    return units + 2 + (2 * units if model.own else 0) + amplitudes


def deviation_of(
    model: ExtendedModel, doubt: PredictionUncertainty, history: History, units: tuple[str, ...]
) -> Deviation:
    """How far readings of a history may be from the model's angles: one standard deviation.

    Independent parts: the error on rows that were held out; the parameters' posterior covariance; what
    friction may remember from before the first row, until torque has wiped it out; in loops smaller than any
    of the record half the width of the friction's loop, whose state there is not known; near T = 0 the
    torque's noise, which puts a row on the wrong side of the gap g with the probability Φ(−|T|/σ_T), a
    square of g²Φ on average; beyond what was measured a share of what the causes add there, and where torque
    moves slower than measured the same share of what a rate dependence loses: friction loses nothing.
    Outside, all but these two grow in proportion to the distance.
    """
    variance = np.full(len(history), doubt.reading_arcsec**2)
    read = model.true_history(history)
    true = model.at_teeth(read)
    if len(doubt.covariance):
        columns = parameter_columns(model, read, true, units)
        variance += ((columns @ doubt.covariance) * columns).sum(axis=1)
    variance += crossing_variance(model, read, true, unsure_of(model, doubt))
    smaller = np.zeros(len(history), bool)
    if FRICTION in model.elements:
        variance += memory_variance(model, read, doubt.span.torque_Nm)
        smaller = smaller_loops(doubt.span, history)
        variance += smaller * half_loop_arcsec(model, max(map(abs, doubt.span.torque_Nm))) ** 2
    outside = beyond(doubt.span, history)
    counts = {channel: int((far > 0).sum()) for channel, far in outside.items()}
    counts["torque_amplitude"] = int(smaller.sum())
    growth = 1 + sum(outside.values())
    off = _over(model, doubt.span, true)
    if RATE in model.elements:
        slower = times_slower(doubt.span, true)
        off = np.hypot(off, _lost(model, slower, true))
        counts["slow_torque_rate"] = int((slower > 1).sum())
    std = np.sqrt(variance * growth**2 + (BEYOND_THE_EDGE * off) ** 2)
    return Deviation(std, {channel: n for channel, n in counts.items() if n})


def unsure_of(model: ExtendedModel, doubt: PredictionUncertainty) -> float:
    """Deviation [N·m] of where the gap is crossed, but for what the friction's law leaves open."""
    friction = _friction_std_Nm(model, doubt.covariance) if len(doubt.covariance) else 0.0
    return float(np.hypot(np.hypot(doubt.torque_noise_Nm, doubt.crossing_Nm), friction))


def crossing_variance(
    model: ExtendedModel, read: History, true: History, unsure_Nm: float
) -> np.ndarray:
    """(n,) mean square [arcsec²] by which rows are off whose side of the gap is not sure."""
    from scipy.special import ndtr

    carried = true.torque_Nm - read.torque_Nm
    unsure = np.hypot(unsure_Nm, CARRIED_UNSURE * np.abs(carried))
    wrong = ndtr(-np.abs(true.torque_Nm) / np.maximum(unsure, LEAST_TORQUE_Nm))
    # in the middle of the gap a reading is half of it off, beyond it all of it on the wrong side
    return np.asarray(model.gap_arcsec**2 * np.where(true.torque_Nm == 0, 1 / 4, wrong))


def _friction_std_Nm(model: ExtendedModel, covariance: np.ndarray) -> float:
    """Deviation of the torque that friction carries ahead of the teeth; 0 where there is none."""
    shapes = [e.shape for of in model.elements.values() for e in of for _ in e.amplitudes]
    variances = np.diag(covariance)[len(covariance) - len(shapes) :]
    own = [v for shape, v in zip(shapes, variances, strict=True) if AHEAD in shape]
    return float(np.sqrt(sum(own)))


def _lost(model: ExtendedModel, slower: np.ndarray, true: History) -> np.ndarray:
    """(n,) angle [arcsec] that the rate dependence adds at the slowest measured rate, and no more where
    torque is slower by these times (n,)."""
    if true.time_s is None or not (slower > 1).any():
        return np.zeros(len(true))
    rate, elements = known_causes()[RATE], model.elements[RATE]
    as_measured = replace(true, time_s=true.time_s / float(np.median(slower[slower > 1])))
    lost = rate.angle_arcsec(elements, as_measured) - rate.angle_arcsec(elements, true)
    return np.where(slower > 1, np.abs(lost), 0.0)


def _over(model: ExtendedModel, span: MeasuredSpan, true: History) -> np.ndarray:
    """(n,) angle [arcsec] that the causes add beyond the most that each has added so far within the span."""
    inside, total = clipped(span, true), np.zeros(len(true))
    for cause_id, elements in model.elements.items():
        cause = known_causes()[cause_id]
        most = np.maximum.accumulate(np.abs(cause.angle_arcsec(elements, inside)))
        total += np.maximum(np.abs(cause.angle_arcsec(elements, true)) - most, 0.0)
    return total
