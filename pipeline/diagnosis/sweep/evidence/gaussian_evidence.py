"""The race on one record: whitened columns, their products, and the evidence of any set of terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Shape
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import (
    DesignMatrix,
    Regressor,
    shape_key,
)
from flexspline.pipeline.diagnosis.sweep.evidence.whitening import Whitening

COLUMNS_AT_ONCE = 64
"""Columns whitened together: 3 MB of 6000 rows."""


@dataclass(frozen=True)
class GaussianEvidence:
    """Products of whitened columns, with the base (zero, compliance, gap) marginalised.

    Attributes
    ----------
    gram (P, P), right (P,) : of columns scaled to unit prior, less what the base explains.
    rows : number of whitened rows. total : yᵀy whitened.
    """

    columns: DesignMatrix
    whitened: Whitening
    target: np.ndarray
    """(n,) measured less nominal angle."""
    gram: np.ndarray
    right: np.ndarray
    scale: np.ndarray
    base_gram: np.ndarray
    base_right: np.ndarray
    base_cross: np.ndarray
    total: float
    rows: int
    y: np.ndarray
    base: np.ndarray
    x: np.ndarray
    """(r,), (r, b), (r, P) whitened; x scaled to unit prior."""

    @property
    def kept(self) -> np.ndarray:
        """(n,) rows that are explained."""
        return self.whitened.kept

    @property
    def noise(self) -> Noise:
        return self.whitened.noise

    def base_with(self, blocks: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Columns (r, p) of the base and of blocks of unit prior; inverse variances (p,) of their priors."""
        x = np.hstack([self.base, *blocks])
        own = np.ones(x.shape[1] - self.base.shape[1])
        return x, np.concatenate([self.columns.base_prior**-2, own])

    @property
    def terms(self) -> tuple[Regressor, ...]:
        return self.columns.terms

    @cached_property
    def positive_columns(self) -> np.ndarray:
        """(P,) whether a column's amplitude may not be negative."""
        positive = np.array([t.positive for t in self.terms], bool)
        return np.repeat(positive, [t.width for t in self.terms])


def log_evidence(matrix: np.ndarray, right: np.ndarray) -> float:
    """½ rᵀM⁻¹r − ½ ln|M| [nats]: log evidence of amplitudes, marginalised by their Gaussian posterior.

    Up to a constant of the data and of the prior. `matrix` (p, p) is XᵀX with the inverse variances of the
    prior, `right` (p,) is Xᵀy, whitened both.
    """
    explained = right @ np.linalg.solve(matrix, right)
    return float(explained / 2 - np.linalg.slogdet(matrix)[1] / 2)


def gaussian_evidence(
    columns: DesignMatrix, target: np.ndarray, kept: np.ndarray, noise: Noise
) -> GaussianEvidence:
    """Whiten the kept rows and form all products."""
    whitened = Whitening(columns.rig, kept, noise)
    y = whitened(target[:, None])[:, 0]
    base = whitened(columns.base)
    prior = np.concatenate([t.prior for t in columns.terms]) if columns.terms else np.empty(0)
    wide = [
        whitened(columns.all[:, i : i + COLUMNS_AT_ONCE]) * prior[i : i + COLUMNS_AT_ONCE]
        for i in range(0, columns.all.shape[1], COLUMNS_AT_ONCE)
    ]
    x = np.hstack(wide) if wide else np.empty((len(y), 0))
    base_gram = base.T @ base + np.diag(columns.base_prior**-2)
    base_right = base.T @ y
    cross = base.T @ x
    solved = np.linalg.solve(base_gram, np.column_stack([base_right, cross]))
    return GaussianEvidence(
        columns, whitened, target, gram=x.T @ x - cross.T @ solved[:, 1:],
        right=x.T @ y - cross.T @ solved[:, 0], scale=prior, base_gram=base_gram, base_right=base_right,
        base_cross=cross, total=float(y @ y), rows=len(y) * whitened.block, y=y, base=base, x=x,
    )  # fmt: skip


def with_shapes(
    old: GaussianEvidence, shapes: Sequence[tuple[Regressor, Shape]]
) -> GaussianEvidence:
    """The race with further shapes, each beside a term of the same cause; known ones are skipped."""
    known = {t.shape_key for t in old.terms}
    more, blocks = [], []
    for like, shape in shapes:
        key = shape_key(like.owner, shape)
        if like.cause is None or key in known:
            continue
        known.add(key)
        block = like.cause.columns(shape, old.columns.rig.history)
        spread = np.full(block.shape[1], like.cause.spread(shape, old.columns.rig))
        more.append(replace(like, shape=shape, prior=spread))
        blocks.append(block)
    if not more:
        return old
    wider = with_terms(old, more, blocks)
    tuned_from = len(old.terms) if old.columns.tuned_from is None else old.columns.tuned_from
    return replace(wider, columns=replace(wider.columns, tuned_from=tuned_from))


def with_terms(
    old: GaussianEvidence, more: Sequence[Regressor], blocks: Sequence[np.ndarray]
) -> GaussianEvidence:
    """The race with further terms, of these columns (n, k) each; where the terms stand is found here."""
    columns, width, terms = old.columns, old.columns.all.shape[1], list(old.terms)
    for term, block in zip(more, blocks, strict=True):
        terms.append(replace(term, at=slice(width, width + block.shape[1])))
        width += block.shape[1]
    new = np.hstack(blocks).astype(np.float32)
    prior = np.concatenate([t.prior for t in more])
    x = old.whitened(new) * prior
    cross = old.base.T @ x
    solved = np.linalg.solve(old.base_gram, np.column_stack([old.base_right, cross]))
    mixed = old.x.T @ x - old.base_cross.T @ solved[:, 1:]
    own = x.T @ x - cross.T @ solved[:, 1:]
    return replace(
        old,
        columns=replace(columns, all=np.hstack([columns.all, new]), terms=tuple(terms)),
        gram=np.block([[old.gram, mixed], [mixed.T, own]]),
        right=np.concatenate([old.right, x.T @ old.y - cross.T @ solved[:, 0]]),
        scale=np.concatenate([old.scale, prior]),
        base_cross=np.hstack([old.base_cross, cross]),
        x=np.hstack([old.x, x]),
    )


@dataclass(frozen=True)
class Posterior:
    """Posterior of a set of terms: `amplitudes` of each term's columns, `covariance` over them and the base.

    Order of `mean` and `covariance`: base first, then the terms' columns in the order of `terms`.
    """

    terms: tuple[int, ...]
    mean: np.ndarray
    covariance: np.ndarray
    base_count: int
    chi2: float

    def misfit(self, evidence: GaussianEvidence) -> float:
        """χ², with what the calibration is off by in its stated deviations."""
        off = self.mean[: self.base_count] / evidence.columns.base_prior
        return self.chi2 + float(off @ off)

    def amplitudes(self, evidence: GaussianEvidence) -> list[np.ndarray]:
        """Amplitudes (k,) of each term."""
        at, out = self.base_count, []
        for i in self.terms:
            k = evidence.terms[i].width
            out.append(self.mean[at : at + k])
            at += k
        return out


def column_indices(evidence: GaussianEvidence, chosen: Sequence[int]) -> np.ndarray:
    """Columns of several terms, in order."""
    places = (evidence.terms[i].at for i in chosen)
    return np.array([j for at in places for j in range(at.start, at.stop)], int)


def posterior_of(evidence: GaussianEvidence, chosen: Sequence[int]) -> Posterior:
    """Posterior mean and covariance of base and the chosen terms together."""
    at = column_indices(evidence, chosen)
    b = len(evidence.base_right)
    own = evidence.gram[np.ix_(at, at)] + evidence.base_cross[:, at].T @ np.linalg.solve(
        evidence.base_gram, evidence.base_cross[:, at]
    )
    matrix = np.block(
        [
            [evidence.base_gram, evidence.base_cross[:, at]],
            [evidence.base_cross[:, at].T, own + np.eye(len(at))],
        ]
    )
    whole = evidence.right[at] + evidence.base_cross[:, at].T @ np.linalg.solve(
        evidence.base_gram, evidence.base_right
    )
    right = np.concatenate([evidence.base_right, whole])
    inverse = np.linalg.inv(matrix)
    mean = inverse @ right
    scale = np.concatenate([np.ones(b), evidence.scale[at]])
    plain = matrix - np.diag(np.concatenate([evidence.columns.base_prior**-2, np.ones(len(at))]))
    chi2 = evidence.total - 2 * mean @ right + mean @ plain @ mean
    return Posterior(tuple(chosen), mean * scale, inverse * np.outer(scale, scale), b, float(chi2))
