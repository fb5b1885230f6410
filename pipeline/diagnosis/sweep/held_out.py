"""Prediction error of the extended model on data that were not used for fitting it."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import partial

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.noise import FINEST_ARCSEC
from flexspline.pipeline.diagnosis.outcome import Gain, Unexplained
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.structure import MissedLevel
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import calibrated_residual, less_zero
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import true_history
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import Regressor
from flexspline.pipeline.diagnosis.sweep.held_out_splits import (
    Split,
    affordable,
    between_others,
    whole_levels,
)
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, with_tuned_shapes
from flexspline.pipeline.diagnosis.sweep.row_selection import settling, turning
from flexspline.pipeline.second_process import results_of

MOST_HELD_OUT_ROWS = 24_000
"""Most rows of all levels together. Each level has its own search, at 1.5 ms of a processor per row."""
FEWEST_RMS_ROWS = 12
"""An rms of so many rows of noise is good to 1/√(2·12) = 20 %."""

SAME_PLACE_DEG = 5.0
"""A position of the wave generator that lies nearer to one fitted is no other: the fourth harmonic turns by
0.35 rad there."""
FEWEST_LEVELS = 2
"""Of a channel, that refute: others may be none of their own, or not be held out for their rows' number."""
REFUTED_RATIO = 2.0
"""Times the error without the causes, at a whole level that was held out, from which they explain nothing:
half of a true effect would still make it smaller."""
REFUTING_DEVIATIONS = 3.0
"""Deviations that the prediction states, within which an error refutes nothing: what was held out may be what
tells the sizes."""
LEARNT_SHARE, LEFT_RATIO = 0.9, 1.4
"""Of the error without the causes on what was held out between others: from this share on they predict
nothing of it, if it is also so many times what the same terms leave where they are fitted. Of 241 made-up
records with causes one is so, a random walk that was named drift: 0.97 and 1.8."""


def gains_of(
    explained: ExplainedSweep, causes: Collection[str]
) -> tuple[Gain | None, tuple[Gain, ...]]:
    """The error on cycles, positions or units between others, None where nothing can be spared; and, where
    causes are named, on each whole amplitude, rate and temperature, learnt on the others."""
    prepared = explained.prepared
    history = prepared.rig.history
    sweep = prepared.sweep
    between = between_others(history, sweep.own_cycle, sweep.units, ~settling(history))
    levels: list[Split] = []
    if causes:
        timed = sweep.history.time_s is not None
        every = whole_levels(true_history(sweep, prepared.offset_Nm), timed)
        levels = affordable(every, MOST_HELD_OUT_ROWS // len(sweep))
    splits = [*levels, *([between] if between else [])]
    gains = results_of([partial(_gain, explained, causes, split) for split in splits])
    first = gains.pop() if between else None
    return first, tuple(g for g in gains if g is not None)


def refuted(levels: Iterable[Gain]) -> Unexplained | None:
    """The worst of a channel's levels, where at most of them the causes learnt on the others do harm.

    At a single level that alone shows a shape (the only warm cycles, the longest holds) a true cause learnt
    on the rest fails too, and where one level of a channel is left nothing tells whether it is that one.
    None where no channel is so.
    """
    of_channel: dict[str, list[Gain]] = {}
    for g in levels:
        of_channel.setdefault(g.channel, []).append(g)
    failed = {c: [g for g in all_ if _does_harm(g)] for c, all_ in of_channel.items()}
    worst = max(
        (
            g
            for c, bad in failed.items()
            if 2 * len(bad) > len(of_channel[c]) >= FEWEST_LEVELS
            for g in bad
        ),
        key=_times_worse,
        default=None,
    )
    if worst is None:
        return None
    without = min(worst.rmse_before, worst.rmse_calibrated)
    missed = MissedLevel(worst.held_out, worst.rmse_after, without)
    return Unexplained(worst.channel, worst.rmse_after, 0.0, missed)


def unpredicted(gain: Gain | None) -> Unexplained | None:
    """What was held out between others, where the causes learnt on those predict nothing of it.

    Only where much is left to predict: near the noise a true small cause gains little.
    """
    if gain is None or gain.elsewhere:
        return None
    without = min(gain.rmse_before, gain.rmse_calibrated)
    least = max(
        LEARNT_SHARE * without,
        LEFT_RATIO * gain.noise_floor,
        REFUTING_DEVIATIONS * gain.stated_std,
    )
    if gain.rmse_after <= least:
        return None
    missed = MissedLevel(gain.held_out, gain.rmse_after, without)
    return Unexplained(gain.held_out.channel, gain.rmse_after, 0.0, missed)


def _does_harm(gain: Gain) -> bool:
    """A fifth position cannot refute harmonics that four positions leave open."""
    return (
        not gain.elsewhere
        and _times_worse(gain) >= REFUTED_RATIO
        and gain.rmse_after > REFUTING_DEVIATIONS * gain.stated_std
    )


def _times_worse(gain: Gain) -> float:
    return gain.rmse_after / max(min(gain.rmse_before, gain.rmse_calibrated), FINEST_ARCSEC)


def _gain(explained: ExplainedSweep, causes: Collection[str], split: Split) -> Gain | None:
    """Fit the named causes again on the rest of the record, and predict what was held out.

    The shapes are searched and tuned again too, on the training rows alone. Rows in the gap's crossing are
    judged no more than they are fitted: their side of the gap is not known. With friction ahead of the teeth
    the simulation has its crossing elsewhere, and is not judged there either.
    """
    prepared = explained.prepared
    sweep, history, out = prepared.sweep, prepared.rig.history, split.rows
    train = prepared.kept & ~out
    test = out & ~prepared.outlier
    for crossed in (history, true_history(sweep, prepared.offset_Nm)):
        test &= np.abs(crossed.torque_Nm) > prepared.band_Nm
    test &= ~turning(history)  # what a row there shows is a matter of sampling
    test &= ~settling(history)  # nor is known what friction remembers from before the record
    if train.sum() < FEWEST_RMS_ROWS or test.sum() < FEWEST_RMS_ROWS:
        return None
    columns = prepared.columns.untuned.of(causes)
    learnt = gaussian_evidence(columns, prepared.target, train, prepared.noise)
    fit = _learnt(learnt, causes)
    after = fit.residual_as_read()
    calibrated = calibrated_residual(learnt)
    reading = sweep.angle_arcsec - prepared.prediction.angle_arcsec(sweep.history)
    before = less_zero(reading, train, history)
    left = {"before": before[test], "calibrated": calibrated[test], "after": after[test]}
    floor = explained.identified.fit.residual_as_read()[test]  # of these rows, not of all
    return Gain(
        split.what,
        rmse_before=rms(left["before"]),
        rmse_calibrated=rms(left["calibrated"]),
        rmse_after=rms(left["after"]),
        noise_floor=rms(floor),
        held_out_rows=tuple(map(int, sweep.file_rows(test))),
        left=left,
        stated_std=rms(fit.stated_std()[test]),
        elsewhere=_elsewhere(history, train, test)
        and any(known_causes()[c].shows_over == "input_angle_deg" for c in causes),
    )


def _elsewhere(history: History, train: np.ndarray, test: np.ndarray) -> bool:
    """Whether most rows of a test are at positions that no training row is near."""
    if history.input_angle_deg is None:
        return False
    place = history.input_angle_deg % 360.0
    known = np.unique(place[train])
    around = np.concatenate([known[-1:] - 360.0, known, known[:1] + 360.0])
    after = np.searchsorted(around, place[test])
    off = np.minimum(around[after] - place[test], place[test] - around[after - 1])
    return bool((off >= SAME_PLACE_DEG).mean() > 1 / 2)


def _learnt(learnt: GaussianEvidence, causes: Collection[str]) -> SweepFit:
    """The model learnt on the training rows."""

    def named(term: Regressor) -> bool:
        return term.cause is not None and term.cause.id in causes

    search = with_tuned_shapes(learnt, named)
    return fit_regressors(search.evidence, search.top.terms)
