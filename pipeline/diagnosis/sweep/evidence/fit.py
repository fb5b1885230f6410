"""From a set of terms to the causes' elements, their magnitudes, and the model they make."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from math import hypot, sqrt
from typing import Any

import numpy as np

from flexspline.pipeline.diagnosis.calibration import Calibration, Estimate
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION, FrictionHysteresis
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.causes.torque_offset import OFFSET
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.structure import FormKind
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    Posterior,
    posterior_of,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import NOISE_COLUMNS, Regressor

LINEAR = {SERIES: 0, CLEARANCE: 1}
"""Causes whose elements are part of the measured compliance or gap."""

LEAST_GAP_ARCSEC = 1e-3
"""[arcsec] Smallest gap of a row. No angle reading resolves less, and a gap is never negative."""
GAP_BESIDE_WIND_UP = 0.03
"""Of a soft wind-up from one side to the other, by which a gap beside it is doubted: its law near zero is not
seen. Of 17 records made up by another law, 1 − e^(−T/w), 68 % were off by less than 0.022, 90 % than 0.07."""
SLOPE_STEP = 0.3
"""Step for slopes of magnitudes, over a standard deviation: small enough to be of first order."""


@dataclass(frozen=True)
class SweepFit:
    """A fitted set of terms on one race."""

    evidence: GaussianEvidence
    posterior: Posterior
    memo: dict[tuple[Hashable, ...], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """Results computed from this fit and needed again (`../../measurement/once.py`)."""

    @property
    def rig(self) -> FitContext:
        return self.evidence.columns.rig

    @property
    def units(self) -> int:
        return len(self.rig.history.unit_slices)

    def elements(self, mean: np.ndarray | None = None) -> dict[str, tuple[Element, ...]]:
        """Elements of each cause, by id."""
        posterior = self.posterior if mean is None else replace(self.posterior, mean=mean)
        ahead = self.evidence.columns.ahead
        by_cause: dict[str, tuple[Element, ...]] = {FRICTION: (ahead.element,)} if ahead else {}
        for term, amplitudes in self._amplitudes(posterior):
            if term.cause is not None:
                element = Element(term.shape, tuple(float(a) for a in amplitudes))
                by_cause[term.cause.id] = (*by_cause.get(term.cause.id, ()), element)
        return by_cause

    def _amplitudes(self, posterior: Posterior) -> Iterable[tuple[Regressor, np.ndarray]]:
        """Each term of the set with its amplitudes by a posterior of it."""
        return zip(self.regressors, posterior.amplitudes(self.evidence), strict=True)

    @property
    def calibration(self) -> Calibration:
        """Gap and compliance without the effects found, by the posterior: what units have in common."""
        return self._calibrated((self.units,))

    def calibration_of(self, unit: int) -> Calibration:
        """That of one of several units."""
        return self._calibrated((self.units, self.units + 2 + 2 * unit))

    def _calibrated(self, places: tuple[int, ...]) -> Calibration:
        """By the sums of the changes that begin at some places of the posterior: of the compliance, then of
        the gap."""
        p, (slope, gap) = self.rig.prediction, np.array(places) + np.arange(2)[:, None]
        mean, covariance = self.posterior.mean, self.posterior.covariance
        of_gap = self._mean_of_own_gaps()
        of_gap[gap] = 1.0
        std = [
            sqrt(max(x, 0.0))
            for x in (covariance[np.ix_(slope, slope)].sum(), of_gap @ covariance @ of_gap)
        ]
        wind_up = 2 * float(np.abs(self.added(HARDENING)).max(initial=0.0))
        return Calibration(
            Estimate(
                p.gap_arcsec + float(of_gap @ mean), hypot(std[1], GAP_BESIDE_WIND_UP * wind_up)
            ),
            bool(self.posterior.terms),
            Estimate(p.compliance + float(mean[slope].sum()), std[0]),
        )

    def _mean_of_own_gaps(self) -> np.ndarray:
        """(p,) of the mean gap over cycles or positions with gaps of their own, per unit of each amplitude.

        Beside the gap of the first one, which the terms begin from.
        """
        history, at = self.rig.history, self.posterior.base_count
        weight = np.zeros(len(self.posterior.mean))
        for term in self.regressors:
            rows = first_of_levels(history, term.channel)
            if term.form is not None and term.form.kind == "own_gap" and rows is not None:
                gap = 2 * history.sign[:, None] * self.evidence.columns.all[:, term.at]
                weight[at : at + term.width] = gap[rows].mean(axis=0)
            at += term.width
        return weight

    def measured_rig(self, mean: np.ndarray | None = None) -> FitContext:
        """The rig with compliance and gap as measured."""
        mean = self.posterior.mean if mean is None else mean
        k = self.units
        change = mean[k : k + 2].copy()
        if k > 1:
            change += self.units_own(mean).mean(axis=0)
        for cause_id, elements in self.elements(mean).items():
            if cause_id in LINEAR:
                change[LINEAR[cause_id]] += sum(e.amplitudes[0] for e in elements)
        p = self.rig.prediction
        return replace(
            self.rig, measured=(p.compliance + float(change[0]), p.gap_arcsec + float(change[1]))
        )

    def units_own(self, mean: np.ndarray | None = None) -> np.ndarray:
        """(k, 2) compliance and gap of each of several units beside what they have in common."""
        mean, k = self.posterior.mean if mean is None else mean, self.units
        return mean[k + 2 : k + 2 + 2 * k].reshape(k, 2)

    def magnitudes(self, mean: np.ndarray | None = None) -> dict[str, float]:
        """The magnitude of each named cause, as docs/contract.md defines it."""
        rig, elements = self.measured_rig(mean), self.elements(mean)
        sizes = {c: known_causes()[c].magnitude(e, rig) for c, e in elements.items()}
        ahead = self.evidence.columns.ahead
        if ahead is not None and HARDENING in elements:  # at T = 0 the teeth feel ± its torque
            ends = ahead.torque_Nm * np.array([-1.0, 1.0])
            twist = known_causes()[HARDENING].angle_arcsec(
                elements[HARDENING], History.course(ends)
            )
            sizes[FRICTION] += float(twist[1] - twist[0])
        return sizes

    def widest_loop_arcsec(self) -> float:
        """Of friction's closed loop at the largest amplitude."""
        friction = known_causes()[FRICTION]
        assert isinstance(friction, FrictionHysteresis)
        widest = friction.widest_arcsec(self.elements()[FRICTION], self.measured_rig())
        return max(widest, self.magnitudes()[FRICTION])

    @property
    def regressors(self) -> list[Regressor]:
        """The terms fitted."""
        return [self.evidence.terms[i] for i in self.posterior.terms]

    def magnitude_slopes(self) -> dict[str, np.ndarray]:
        """(p,) of each magnitude per unit of each amplitude, in the posterior's order; zeros have none."""
        at_mean = self.magnitudes()
        slope = {c: np.zeros(len(self.posterior.mean)) for c in at_mean}
        std = np.sqrt(np.diag(self.posterior.covariance))
        for j in range(self.units, len(std)):
            step = np.zeros(len(std))
            step[j] = SLOPE_STEP * std[j]
            for c, value in self.magnitudes(self.posterior.mean + step).items():
                slope[c][j] = (value - at_mean[c]) / step[j]
        return slope

    def added(self, owner: str) -> np.ndarray:
        """(n,) angle [arcsec] that all terms of an owner add, and what friction ahead of the teeth does."""
        history, ahead = self.rig.history, self.evidence.columns.ahead
        total = np.zeros(len(history))
        if ahead is not None and owner == FRICTION:
            rig = self.measured_rig()
            side = np.sign(history.torque_Nm + ahead.carried_Nm)
            total += rig.gap_arcsec / 2 * (history.sign - side) - rig.compliance * ahead.carried_Nm
        for term, amplitudes in self._amplitudes(self.posterior):
            if term.owner == owner:
                total += self.evidence.columns.all[:, term.at] @ amplitudes
        return total

    def added_by_form(self, owner: str, kind: FormKind) -> np.ndarray:
        """(n,) angle [arcsec] that an owner's terms without a name add, of one form."""
        total = np.zeros(len(self.rig.history))
        for term, amplitudes in self._amplitudes(self.posterior):
            if term.owner == owner and term.form is not None and term.form.kind == kind:
                total += self.evidence.columns.all[:, term.at] @ amplitudes
        return total

    def gap_arcsec(self) -> np.ndarray:
        """(n,) of each row, as measured and as temperature or wear changes it; not below LEAST_GAP_ARCSEC."""
        gap = np.full(len(self.rig.history), self.measured_rig().gap_arcsec)
        for cause_id in self.elements():
            if known_causes()[cause_id].shows_as == "gap":
                gap += 2 * self.rig.history.sign * self.added(cause_id)
        return np.maximum(gap, LEAST_GAP_ARCSEC)

    def residual(self) -> np.ndarray:
        """(n,) measured less fitted angle, all rows."""
        left = (
            self.evidence.target
            - self.evidence.columns.base @ self.posterior.mean[: self.posterior.base_count]
        )
        for term, amplitudes in self._amplitudes(self.posterior):
            left = left - self.evidence.columns.all[:, term.at] @ amplitudes
        return left

    def left_but_for_gap(self) -> np.ndarray:
        """(n,) `residual` with the gap's step still in it."""
        return self.residual() + self.rig.history.sign * self.gap_arcsec() / 2

    def residual_as_read(self) -> np.ndarray:
        """(n,) measured less predicted from the torque as it was read, its noise included."""
        of_noise = slice(self.posterior.base_count - NOISE_COLUMNS, self.posterior.base_count)
        return (
            self.residual()
            + self.evidence.columns.base[:, of_noise] @ self.posterior.mean[of_noise]
        )

    def stated_std(self) -> np.ndarray:
        """(n,) standard deviation [arcsec] of the fitted angle by the posterior of base and amplitudes."""
        columns = self.evidence.columns
        chosen = [columns.all[:, self.evidence.terms[i].at] for i in self.posterior.terms]
        whole = np.hstack([columns.base, *chosen])
        variance = np.einsum("ij,jk,ik->i", whole, self.posterior.covariance, whole, optimize=True)
        return np.sqrt(np.maximum(variance, 0.0))


def first_of_levels(history: History, channel: str | None) -> np.ndarray | None:
    """The first row under load (k,) of each cycle or position; None of channels without gaps of their own."""
    level = {"cycle": history.cycle, "input_angle_deg": history.input_angle_deg}.get(channel or "")
    if level is None:
        return None
    loaded = np.flatnonzero(history.sign)
    return np.asarray(loaded[np.unique(level[loaded], return_index=True)[1]])


def fit_regressors(evidence: GaussianEvidence, terms: Sequence[int]) -> SweepFit:
    """Fit a set of terms."""
    return SweepFit(evidence, posterior_of(evidence, terms))


def model_of(fit: SweepFit, sweep: Sweep, named: Sequence[str], offset_Nm: float) -> ExtendedModel:
    """The fitted model, with the elements of the named causes."""
    mean, k, p = fit.posterior.mean, fit.units, fit.rig.prediction
    elements = {c: e for c, e in fit.elements().items() if c in named}
    if fit.evidence.columns.ahead and FRICTION not in elements:
        elements[FRICTION] = (fit.evidence.columns.ahead.element,)
    if offset_Nm:
        elements[OFFSET] = (Element({}, (offset_Nm,)),)
    own = {}
    if k > 1:
        pairs = zip(sweep.units, fit.units_own(), strict=True)
        own = {name: (float(a), float(b)) for name, (a, b) in pairs}
    return ExtendedModel(
        p.compliance + float(mean[k]),
        p.gap_arcsec + float(mean[k + 1]),
        {name: float(z) for name, z in zip(sweep.units, mean[:k], strict=True)},
        elements,
        own,
        p.for_race.bend,
    )
