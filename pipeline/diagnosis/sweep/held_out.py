"""What the extension is worth on data not used for fitting it."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.sweep.calibrated import calibrated_residual, less_zero
from flexspline.pipeline.diagnosis.sweep.evidence import GaussianEvidence, gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.row_selection import turning
from flexspline.pipeline.diagnosis.sweep.search import Search

FEWEST_ROWS = 12
"""An rms of so many rows of noise is good to 1/√(2·12) = 20 %."""


def held_out(
    history: History, names: tuple[tuple[float, ...], ...]
) -> tuple[str, np.ndarray] | None:
    """What to hold out, in words, and its rows (n,): whole cycles, or positions, or units.

    Every third cycle, never the first: the last is kept for fitting where there are more than two, so
    that what changes from cycle to cycle is not extrapolated. None where nothing can be spared.
    """
    present = np.unique(history.cycle)
    count = len(present)
    if count >= 2:
        places = [1] if count == 2 else [c for c in range(1, count - 1) if c % 3 == 1]
        chosen = present[places]
        own = names[0] if len(names[0]) == count else tuple(present + 1.0)
        label = ", ".join(f"{own[c]:g}" for c in places)
        return f"cycle{'s' if len(chosen) > 1 else ''} {label}", np.isin(history.cycle, chosen)
    position = history.input_angle_deg
    if position is not None and len(spots := np.unique(position)) >= 4:
        chosen_places = spots[1::3]
        label = ", ".join(f"{p:g}" for p in chosen_places[:6])
        return f"input_angle_deg {label}", np.isin(position, chosen_places)
    units = history.unit_slices
    if len(units) >= 3:
        rows = np.zeros(len(history), bool)
        rows[units[1]] = True
        return "unit 2", rows
    return None


def gain_of(explained: ExplainedSweep, causes: Collection[str]) -> Gain | None:
    """Fit the named causes anew on the rest of the record, and predict what was held out.

    The shapes are searched anew as well, on the training rows alone. Rows in the gap's crossing are judged no
    more than they are fitted: their side of the gap is not known.
    """
    prepared = explained.prepared
    sweep, history = prepared.sweep, prepared.rig.history
    split = held_out(history, sweep.cycles)
    if split is None:
        return None
    label, out = split
    train = prepared.kept & ~out
    test = out & ~prepared.outlier & (np.abs(history.torque_Nm) > prepared.band_Nm)
    test &= ~turning(history)  # what a row there shows is a matter of sampling
    if train.sum() < FEWEST_ROWS or test.sum() < FEWEST_ROWS:
        return None
    after = _predicted(prepared, train, causes)
    calibrated = calibrated_residual(_fitting(prepared, train))
    reading = sweep.angle_arcsec - prepared.prediction.angle_arcsec(sweep.history)
    before = less_zero(reading, train, history)
    left = {"before": before[test], "calibrated": calibrated[test], "after": after[test]}
    floor = explained.identified.fit.residual_as_read()[prepared.kept]
    return Gain(
        label,
        rmse_before=_rms(left["before"]),
        rmse_calibrated=_rms(left["calibrated"]),
        rmse_after=_rms(left["after"]),
        noise_floor=_rms(floor),
        held_out_rows=tuple(int(i) for i in np.flatnonzero(test)),
        left=left,
    )


def _fitting(prepared: PreparedSweep, train: np.ndarray) -> GaussianEvidence:
    return gaussian_evidence(prepared.columns, prepared.target, train, prepared.noise)


def _predicted(prepared: PreparedSweep, train: np.ndarray, causes: Collection[str]) -> np.ndarray:
    """(n,) residual of the model fitted on the training rows."""
    now = _fitting(prepared, train)
    best = Search(now, lambda t: t.cause is not None and t.cause.id in causes).run()
    return fit_regressors(now, best.terms).residual_as_read()


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
