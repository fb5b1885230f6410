"""Every term of the race evaluated on one record: shapes of the causes, nuisance terms, calibration."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import log

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.torque_jitter import USUAL_ROWS, jitter, widest
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.local_bend import CurveBend
from flexspline.pipeline.diagnosis.sweep.local_bump import Bump
from flexspline.pipeline.diagnosis.sweep.local_step import CurveStep
from flexspline.pipeline.diagnosis.sweep.nuisance.nuisance_terms import NuisanceTerm, nuisance_terms

ZERO_STD_ARCSEC = 1e5
"""[arcsec] Prior standard deviation of the angle's zero: so wide that the zero is free."""


ShapeKey = tuple[str, tuple[tuple[str, float], ...]]


def shape_key(owner: str, shape: Shape) -> ShapeKey:
    """By which two shapes are one, but for rounding."""
    return owner, tuple(sorted((k, float(f"{v:.6g}")) for k, v in shape.items()))


@dataclass(frozen=True)
class Regressor:
    """One shape of a cause, or one nuisance term (`cause` None); `at` its columns among all."""

    cause: Cause | None
    shape: Shape
    channel: str
    form: UnnamedForm | None
    at: slice
    prior: np.ndarray
    """(k,) standard deviations of the amplitudes."""
    positive: bool
    """Whether its amplitudes may not be negative."""
    log_share: float
    """Log of the share of its cause's (or channel's) prior that this shape has."""
    against: frozenset[str] = frozenset()
    """Owners beside which it does not stand."""

    @cached_property
    def owner(self) -> str:
        """Cause id, or `?channel`."""
        return self.cause.id if self.cause else f"?{self.channel}"

    @cached_property
    def shape_key(self) -> ShapeKey:
        """By which two shapes are one."""
        return shape_key(self.owner, self.shape)

    @property
    def law(self) -> tuple[object, ...]:
        """What refining its shape leaves as it is."""
        return (self.owner, *(self.cause.law(self.shape) if self.cause else ()))

    @property
    def width(self) -> int:
        """How many columns it has."""
        return int(self.at.stop - self.at.start)


@dataclass(frozen=True)
class FrictionAhead:
    """Friction ahead of the teeth: it is in the history that all terms see, and no term itself.

    `element` : of `friction_hysteresis`. `carried_Nm` (n,) : what it takes of the torque.
    """

    element: Element
    carried_Nm: np.ndarray

    @property
    def torque_Nm(self) -> float:
        """The largest that it can carry."""
        return self.element.amplitudes[0]


@dataclass(frozen=True)
class DesignMatrix:
    """All columns of a record before whitening; float32 keeps 100 000 rows in memory.

    `rig` has the torque at the teeth, where friction lies `ahead` of them.
    """

    rig: FitContext
    base: np.ndarray
    base_prior: np.ndarray
    """(b,) standard deviations; the columns are zeros, compliance and gap, common and per unit."""
    all: np.ndarray
    terms: tuple[Regressor, ...]
    ahead: FrictionAhead | None = None
    tuned_from: int | None = None
    """The first of `terms` that was tuned to a record's rows; None: none was."""

    @property
    def untuned(self) -> DesignMatrix:
        """Without the shapes that were tuned, for a fit on other rows."""
        if self.tuned_from is None:
            return self
        terms = self.terms[: self.tuned_from]
        return replace(self, all=self.all[:, : terms[-1].at.stop], terms=terms, tuned_from=None)

    def of(self, causes: Collection[str]) -> DesignMatrix:
        """With the terms of these causes alone, for a fit that no other may enter."""
        return self.only(lambda t: t.cause is not None and t.cause.id in causes)

    def less(self, causes: Collection[str]) -> DesignMatrix:
        """Without the terms of these causes."""
        return self.only(lambda t: t.owner not in causes)

    def only(self, wanted: Callable[[Regressor], bool]) -> DesignMatrix:
        """With the terms that are wanted alone."""
        kept = [t for t in self.terms if wanted(t)]
        return self.with_terms(kept, [self.all[:, t.at] for t in kept])

    def with_terms(self, terms: Sequence[Regressor], columns: Sequence[np.ndarray]) -> DesignMatrix:
        """With these terms in place of its own, each with its columns (n, k)."""
        ends = np.cumsum([0, *(t.width for t in terms)]).tolist()
        return replace(
            self,
            all=np.hstack([self.all[:, :0], *columns]),
            terms=tuple(
                replace(t, at=slice(a, b)) for t, (a, b) in zip(terms, pairwise(ends), strict=True)
            ),
            tuned_from=None,
        )


def design_matrix(
    rig: FitContext,
    known: dict[str, Cause],
    ahead: FrictionAhead | None = None,
    step: int | None = None,
    bumps: Sequence[Bump | CurveStep] = (),
    bends: Sequence[Sequence[CurveBend]] = (),
) -> DesignMatrix:
    """Evaluate every shape of every cause, and every nuisance term, on a rig's record.

    `step` : the row from which a jump of the zero is likeliest (`../zero_jump.py`). `bumps` : the
    likeliest of the curve over the torque, and its steps (`../local_bump.py`, `../local_step.py`); `bends` :
    its bends (`../local_bend.py`).
    """
    base, prior = base_columns(rig)
    blocks: list[np.ndarray] = []
    terms: list[Regressor] = []
    width = 0
    for cause in known.values():
        shapes = cause.shapes(rig)
        for shape, block in zip(shapes, cause.columns_of_all(shapes, rig.history), strict=True):
            k = block.shape[1]
            spread = np.full(k, cause.spread(shape, rig))
            at = slice(width, width + k)
            share = cause.log_share(shape, len(shapes))
            against = frozenset({cause.id} if cause.stands_alone(shape) else ())
            terms.append(
                Regressor(cause, shape, "", None, at, spread, cause.positive, share, against)
            )
            blocks.append(block.astype(np.float32))
            width += k
    rivals = nuisance_terms(rig, step, bumps, bends)
    alike = Counter((rival.channel, rival.apart) for rival in rivals)
    for rival in rivals:
        terms.append(_nuisance_regressor(rival, alike[rival.channel, rival.apart], width, rig))
        blocks.append(rival.columns.astype(np.float32))
        width += rival.columns.shape[1]
    return DesignMatrix(rig, base, prior, np.hstack(blocks), tuple(terms), ahead)


def _nuisance_regressor(rival: NuisanceTerm, alike: int, at: int, rig: FitContext) -> Regressor:
    """One of `alike` terms that share the prior of its channel."""
    k = rival.columns.shape[1]
    prior = np.full(k, rival.spread * rig.scale_arcsec)
    return Regressor(
        None, {}, rival.channel, rival.form, slice(at, at + k), prior, rival.positive, -log(alike),
        rival.against,
    )  # fmt: skip


NARROW = 2
"""Rows on each side over which the torque is taken as a parabola; `USUAL_ROWS` and `widest` beside it."""
NOISE_COLUMNS = 3
"""Columns of the torque's noise: the parts that parabolas over `NARROW`, `USUAL_ROWS` and `widest` rows
remove."""
LEAST_PRIOR = 1e-9
"""Arcsec, or arcsec per N·m: what the design states without doubt is held, by a deviation above 0."""


def base_columns(rig: FitContext, noise: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """(n, b) columns of the calibration and their prior standard deviations (b,).

    With noise in the torque reading, whatever knows the true torque better explains the angle better.
    The noise's columns take that away from every term, so that no cause is found in it.

    Zero of each unit; deviation of compliance and gap, common, and per unit if several; torque noise, which
    may be known already: (n, NOISE_COLUMNS).
    """
    h, p = rig.history, rig.prediction
    units = [np.isin(np.arange(len(h)), rows).astype(float) for rows in h.unit_slices]
    columns = [*units, h.torque_Nm, h.sign / 2]
    prior = [ZERO_STD_ARCSEC] * len(units) + [p.compliance_std, p.gap_std_arcsec]
    if len(units) > 1:
        for own in units:
            columns += [own * h.torque_Nm, own * h.sign / 2]
            prior += [p.compliance_std, p.gap_std_arcsec]
    columns += (
        [jitter(h, w) for w in (NARROW, USUAL_ROWS, widest(h))] if noise is None else list(noise.T)
    )
    prior += [p.compliance] * NOISE_COLUMNS
    return np.column_stack(columns), np.maximum(np.array(prior), LEAST_PRIOR)
