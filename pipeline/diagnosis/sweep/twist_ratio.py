"""How large a record's twist is against the simulated one, by a straight line on both sides of the gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.measurement.crossing_band import BAND_SHARE
from flexspline.pipeline.diagnosis.measurement.floors import ROUNDING_ARCSEC, ROUNDING_OF_SUMS
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.outliers import isolated_outliers
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.robust import rms, robust_std

MOST_SIZE_ROWS = 20_000
"""Most rows for the size. Of longer records every n-th row is used."""
FEWEST_SIZE_ROWS = 8
"""Fewest rows beyond the crossing: twice the unknowns zero, drift, slope and gap."""
RATIO_DEVIATIONS = 4.0
"""Standard deviations that a ratio must lie beyond a limit: one in 30 000."""
STEP_DEVIATIONS = 2.0
"""The same of the sign of a step beside a slope far off: one in 44. Friction makes its deviation wide."""
LARGEST_CORRELATION = 0.99
"""Of neighbouring residuals: a slow effect counts as no more than 200 rows of one reading each."""
SPIKE_PERCENT = 1.0
"""Percent of the rows at either end that may be spikes: ten times as many as a good rig's file has
(`torque_offset_race.SPIKE_NATS`), by judgement. Of readings in even steps it hides 2 % of the span, held to
a factor of 30."""


@dataclass(frozen=True)
class SweepSize:
    """Measured over simulated, each with its standard deviation.

    Attributes
    ----------
    chord, chord_std : twist from the lowest to the highest torque, the gap in it, over the simulated.
    compliance, compliance_std : slope on one side of the gap over the simulated.
    slope : that slope itself [arcsec per N·m]. gap_arcsec, gap_std_arcsec : the step beside it; 0 where
        torque stays on one side.
    elastic_arcsec : the slope's twist over all torques. residual_arcsec : rms off the line.
    simulated_arcsec : the chord's; simulated_gap_arcsec : the gap in it.
    span_arcsec : range of all readings of a unit.
    """

    chord: float
    chord_std: float
    compliance: float
    compliance_std: float
    slope: float
    gap_arcsec: float
    gap_std_arcsec: float
    elastic_arcsec: float
    residual_arcsec: float
    simulated_arcsec: float
    simulated_gap_arcsec: float
    span_arcsec: float

    @property
    def chord_range(self) -> tuple[float, float]:
        """Least and largest ratio of chords that the record allows."""
        return (
            self.chord - RATIO_DEVIATIONS * self.chord_std,
            self.chord + RATIO_DEVIATIONS * self.chord_std,
        )

    @property
    def compliance_range(self) -> tuple[float, float]:
        """The same of slopes."""
        std = self.compliance_std
        return self.compliance - RATIO_DEVIATIONS * std, self.compliance + RATIO_DEVIATIONS * std

    @property
    def interchanged(self) -> float:
        """`compliance`, were each reading the other; 0 where the angle falls while torque rises.

        A slope c [arcsec per N·m] is then one of 1/c.
        """
        return self.compliance / self.slope**2 if self.slope > 0 else 0.0

    @property
    def steps_back(self) -> bool:
        """Whether the angle steps back where torque changes sign.

        Readings interchanged do it, as the gap is crossed along the other axis: θ = c·T + ½ g·sign T is
        T = θ/c − ½ (g/c)·sign θ.
        """
        return self.gap_arcsec + STEP_DEVIATIONS * self.gap_std_arcsec < 0

    @property
    def steps_on(self) -> bool:
        """Whether it steps on, as the gap of readings that are in their columns makes it do."""
        return self.gap_arcsec > STEP_DEVIATIONS * self.gap_std_arcsec > 0


def sweep_size(
    history: History, angle_arcsec: np.ndarray, prediction: Prediction
) -> SweepSize | None:
    """The size of a sweep; None where torque moves too little to fit a line.

    θ = zero + drift·row + c·T + ½ g·sign T, zero and drift of each unit its own, by least squares, once
    more without single spikes. Whole ramps off the line stay: where most rows lie in holds, ramps alone tell
    slope from gap, and within a hold torque varies by its reading's noise, over which angle has no slope. A
    drift in step with the torque leaves c a large deviation, and no size. Of a whole gear's curve the bend,
    as the record has it, is taken off first.
    """
    step = -(-len(history) // MOST_SIZE_ROWS)
    h, angle = history.rows(np.arange(0, len(history), step)), angle_arcsec[::step]
    largest = h.largest_Nm
    far = (
        np.abs(h.torque_Nm) > BAND_SHARE * largest
    )  # beyond the crossing, whose rows may be on either side
    span = max(
        float(np.subtract(*np.percentile(angle[rows], [100 - SPIKE_PERCENT, SPIKE_PERCENT])))
        for rows in h.unit_slices
    )
    h, angle = h.rows(far), angle[far]
    if (bend := prediction.for_race.bend) is not None:
        angle = angle - bend.at(h.torque_Nm)
    good = np.ones(len(angle), bool)
    for _ in range(2):
        line = _line(h.rows(good), angle[good])
        if line is None:
            return None
        (c, g), cov, residual = line
        scale = robust_std(residual)
        good[good] = ~isolated_outliers(residual, h.rows(good), scale + ROUNDING_ARCSEC)
    extent = float(np.ptp(h.torque_Nm))
    both = float(h.torque_Nm.min()) < 0 < float(h.torque_Nm.max())
    along = np.array([extent, 1.0 if both else 0.0])
    simulated = simulated_twist_arcsec(h.torque_Nm, prediction)
    return SweepSize(
        chord=float(along @ [c, g]) / simulated,
        chord_std=float(np.sqrt(along @ cov @ along)) / simulated,
        compliance=c / prediction.compliance,
        compliance_std=float(np.sqrt(cov[0, 0])) / prediction.compliance,
        slope=c,
        gap_arcsec=g,
        gap_std_arcsec=float(np.sqrt(cov[1, 1])),
        elastic_arcsec=abs(c) * extent,
        residual_arcsec=rms(residual),
        simulated_arcsec=simulated,
        simulated_gap_arcsec=float(along[1]) * prediction.gap_arcsec,
        span_arcsec=span,
    )


def simulated_twist_arcsec(torque_Nm: np.ndarray, prediction: Prediction) -> float:
    """From the lowest to the highest torque."""
    return prediction.twist_arcsec(float(torque_Nm.min()), float(torque_Nm.max()))


def _line(
    h: History, angle: np.ndarray
) -> tuple[tuple[float, float], np.ndarray, np.ndarray] | None:
    """Slope and gap, their covariance, and what they leave."""
    columns = np.column_stack([h.torque_Nm, h.sign / 2, angle])
    for rows in h.unit_slices:
        own = np.column_stack([np.ones(len(rows)), np.linspace(-1, 1, len(rows))])
        columns[rows] -= own @ np.linalg.lstsq(own, columns[rows], rcond=None)[0]
    x, y = columns[:, :2], columns[:, 2]
    size = np.sqrt((x**2).sum(axis=0))
    if len(y) < FEWEST_SIZE_ROWS or size[0] <= ROUNDING_OF_SUMS * h.largest_Nm:
        return None
    used = [0, 1] if size[1] > ROUNDING_OF_SUMS * np.sqrt(len(y)) else [0]
    inverse = np.linalg.pinv(x[:, used].T @ x[:, used])
    values = inverse @ (x[:, used].T @ y)
    residual = y - x[:, used] @ values
    variance = float(residual @ residual) / max(len(y) - 2 * len(h.unit_slices) - 2, 1)
    power = float(residual @ residual)
    rho = float(residual[1:] @ residual[:-1]) / power if power > 0 else 0.0
    rho = min(max(rho, 0.0), LARGEST_CORRELATION)
    cov = np.zeros((2, 2))
    cov[np.ix_(used, used)] = inverse * variance * (1 + rho) / (1 - rho)
    slope, gap = float(values[0]), float(values[1]) if len(used) > 1 else 0.0
    return (slope, gap), cov, residual
