"""A sweep with its rows sorted out: which rows identify causes, its noise, its regressors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.geometry.errors import FlexsplineError
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext
from flexspline.pipeline.diagnosis.causes.creep import CREEP
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.measurement.crossing_band import crossing_band_Nm
from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_ARCSEC
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.noise import Noise, estimated, stretches_of
from flexspline.pipeline.diagnosis.measurement.outliers import isolated_outliers
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.measurement.rough_residual import rough_residual
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.robust import robust_std
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import (
    DesignMatrix,
    FrictionAhead,
    design_matrix,
)
from flexspline.pipeline.diagnosis.sweep.local_bend import curve_bends
from flexspline.pipeline.diagnosis.sweep.local_bump import local_bumps
from flexspline.pipeline.diagnosis.sweep.local_step import curve_steps
from flexspline.pipeline.diagnosis.sweep.row_selection import RowCounts, naming_rows, row_counts
from flexspline.pipeline.diagnosis.sweep.zero_jump import sudden_step

ROWS_PER_PARAMETER = 6
"""Of the local parabolas, three parameters each, in a cycle of 216 rows: windows are a twelfth of it."""
FEWEST_KEPT, PER_UNIT = 12, 4
"""Fewest rows, and more for each further unit, which has its own zero, stiffness and gap. Judgement."""


class TooFewRowsError(FlexsplineError, ValueError):
    """Too few rows lie outside the gap's crossing and the torque's turns: `count` of `wanted`."""

    def __init__(self, count: int, wanted: int) -> None:
        self.count, self.wanted = count, wanted
        super().__init__(f"{count} rows of {wanted}")


@dataclass(frozen=True)
class PreparedSweep:
    """A sweep with its rows sorted out.

    Attributes
    ----------
    kept : (n,) rows that name causes: outside the gap crossing, no outliers.
    outlier : (n,). band_Nm : half width of the crossing. offset_Nm : taken off the torque reading.
    """

    sweep: Sweep
    prediction: Prediction
    rig: FitContext
    columns: DesignMatrix
    target: np.ndarray
    kept: np.ndarray
    outlier: np.ndarray
    band_Nm: float
    rows_per_cycle: float
    noise: Noise
    offset_Nm: float = 0.0

    @property
    def ahead(self) -> Element | None:
        """Friction ahead of the teeth, taken off the torque."""
        return self.columns.ahead.element if self.columns.ahead else None

    def variance_of_readings(self, compliance: float) -> float:
        """[arcsec²] of the angles that an encoder rounded, about the mean of a row; arcsec per N·m."""
        averaging = self.sweep.averaging
        return self.noise.white if averaging is None else averaging.variance_within(compliance)

    @property
    def row_counts(self) -> RowCounts:
        """How many rows identify causes, and why the others do not."""
        return row_counts(self.rig.history, self.band_Nm, self.outlier)


def true_history(sweep: Sweep, offset_Nm: float = 0.0) -> History:
    """What the rig did, a shifted torque reading put right; rows are seconds where time was not recorded."""
    history = sweep.history.shifted(offset_Nm) if offset_Nm else sweep.history
    return history.timed()


def prepare(
    sweep: Sweep, prediction: Prediction, offset_Nm: float = 0.0, ahead: Element | None = None
) -> PreparedSweep:
    """Sort the rows out and evaluate every term, on the torque that friction `ahead` leaves for the teeth.

    Raises
    ------
    TooFewRowsError
    """
    true = history = true_history(sweep, offset_Nm)
    carried = None
    if ahead is not None:
        history = known_causes()[FRICTION].at_teeth((ahead,), true)
        carried = FrictionAhead(ahead, true.torque_Nm - history.torque_Nm)
    rig = FitContext(prediction, history)
    target = sweep.angle_arcsec - prediction.for_race.angle_arcsec(history)
    band = crossing_band_Nm(history)
    kept = naming_rows(history, band)
    per_cycle = len(history) / history.cycle_count
    wanted = FEWEST_KEPT + PER_UNIT * (len(history.unit_slices) - 1)
    if int(kept.sum()) < wanted:
        raise TooFewRowsError(int(kept.sum()), wanted)
    rough = rough_residual(target, history, kept, per_cycle)
    spread = robust_std(rough) + ROUNDING_ARCSEC
    outlier = np.zeros(len(kept), bool)
    outlier[kept] = isolated_outliers(rough, history.rows(kept), spread)
    good = ~outlier[kept]
    kept &= ~outlier
    noise = estimated(
        rough[good], stretches_of(history, kept), per_cycle, int(kept.sum()) // ROWS_PER_PARAMETER
    )
    return PreparedSweep(
        sweep,
        prediction,
        rig,
        design_matrix(
            rig,
            _knowable(sweep, true),
            carried,
            sudden_step(history, target, kept),
            (*local_bumps(history, target, kept), *curve_steps(history, target, kept)),
            curve_bends(history, target, kept),
        ),
        target,
        kept,
        outlier,
        band,
        per_cycle,
        noise,
        offset_Nm,
    )


def _knowable(sweep: Sweep, true: History) -> dict[str, Cause]:
    """Causes that the record's channels let one speak of.

    Behind friction torque rests a while after each turn: creep shows only where the rig holds it.
    """
    timed, held = sweep.history.time_s is not None, bool(holds(true))
    return {
        name: c
        for name, c in known_causes().items()
        if (timed or not c.needs_time) and (held or name != CREEP)
    }
