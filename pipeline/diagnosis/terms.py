"""The race's terms on one record: whitened columns, their products, and the evidence of any set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log

import numpy as np

from pipeline.diagnosis.effects.cause import Cause, Rig, Shape
from pipeline.diagnosis.noise import Noise, stretches_of
from pipeline.diagnosis.unnamed import Unnamed, competitors

ZERO_STD_ARCSEC = 1e5
"""The zero of the angle is free."""
MOST_ROWS = 4000
"""Whitened rows beyond this are summed in blocks: linear, so nothing is bent."""
UNNAMED_SPREAD = 0.15
"""Prior size of an unnamed term, as a share of the predicted angle."""


@dataclass(frozen=True)
class Term:
    """One shape of a cause, or one competitor (`cause` None); `at` its columns among all."""

    cause: Cause | None
    shape: Shape
    channel: str
    what: str
    at: slice
    prior: np.ndarray
    """(k,) standard deviations of the amplitudes."""
    log_share: float
    """Log of the share of its cause's (or channel's) prior that this shape has."""

    @property
    def owner(self) -> str:
        """Cause id, or `?channel`."""
        return self.cause.id if self.cause else f"?{self.channel}"

    @property
    def positive(self) -> bool:
        return self.cause is not None and self.cause.positive


@dataclass(frozen=True)
class Columns:
    """All columns of a record before whitening; float32 keeps 100 000 rows in memory."""

    rig: Rig
    base: np.ndarray
    base_prior: np.ndarray
    """(b,) standard deviations; the columns are zeros, compliance and gap, common and per unit."""
    all: np.ndarray
    terms: tuple[Term, ...]


def base_columns(rig: Rig) -> tuple[np.ndarray, np.ndarray]:
    """(n, b) zero of each unit, deviation of compliance and gap (common, and per unit if several)."""
    h, p = rig.history, rig.prediction
    units = [np.isin(np.arange(len(h)), rows).astype(float) for rows in h.unit_slices]
    columns = [*units, h.torque_Nm, h.sign / 2]
    prior = [ZERO_STD_ARCSEC] * len(units) + [p.compliance_std, p.gap_std_arcsec]
    if len(units) > 1:
        for own in units:
            columns += [own * h.torque_Nm, own * h.sign / 2]
            prior += [p.compliance_std, p.gap_std_arcsec]
    return np.column_stack(columns), np.maximum(np.array(prior), 1e-9)


def columns_of(rig: Rig, known: dict[str, Cause]) -> Columns:
    """Evaluate every shape of every cause, and every competitor, on a rig's record."""
    base, prior = base_columns(rig)
    blocks: list[np.ndarray] = []
    terms: list[Term] = []
    width = 0
    for cause in known.values():
        shapes = cause.shapes(rig)
        for shape in shapes:
            block = cause.columns(shape, rig.history)
            k = block.shape[1]
            spread = np.full(k, cause.spread(shape, rig))
            terms.append(
                Term(cause, shape, "", cause.title, slice(width, width + k), spread, -log(len(shapes)))
            )
            blocks.append(block.astype(np.float32))
            width += k
    rivals = competitors(rig)
    for rival in rivals:
        terms.append(_competitor(rival, rivals, width, rig))
        blocks.append(rival.columns.astype(np.float32))
        width += rival.columns.shape[1]
    return Columns(rig, base, prior, np.hstack(blocks), tuple(terms))


FACTORS = (0.6, 0.8, 1.25, 1.6)
"""By which a tunable shape parameter is varied at first; each further round takes the root."""


def refined(columns: Columns, chosen: Sequence[int], round_: int) -> Columns:
    """The same columns with further shapes beside the chosen terms' own.

    A parameter of 0 or 1 switches something off and is left alone.
    """
    blocks, terms = [columns.all], list(columns.terms)
    width = columns.all.shape[1]
    known = {_shape_key(t) for t in columns.terms}
    for i in chosen:
        term = columns.terms[i]
        if term.cause is None:
            continue
        for key in term.cause.tunable:
            if term.shape[key] in (0.0, 1.0):
                continue
            for factor in FACTORS:
                shape = {**term.shape, key: term.shape[key] * factor ** (0.5**round_)}
                new = Term(
                    term.cause, shape, "", term.what, slice(width, width + 1),
                    np.full(1, term.cause.spread(shape, columns.rig)), term.log_share,
                )  # fmt: skip
                if _shape_key(new) in known or not term.cause.possible(shape):
                    continue
                known.add(_shape_key(new))
                blocks.append(term.cause.columns(shape, columns.rig.history).astype(np.float32))
                terms.append(new)
                width += 1
    return Columns(columns.rig, columns.base, columns.base_prior, np.hstack(blocks), tuple(terms))


def _shape_key(term: Term) -> tuple[str, tuple[tuple[str, float], ...]]:
    return term.owner, tuple(sorted((k, round(float(v), 9)) for k, v in term.shape.items()))


def _competitor(rival: Unnamed, rivals: Sequence[Unnamed], at: int, rig: Rig) -> Term:
    alike = sum(r.channel == rival.channel for r in rivals)
    k = rival.columns.shape[1]
    prior = np.full(k, UNNAMED_SPREAD * rig.scale_arcsec / np.sqrt(k))
    return Term(None, {}, rival.channel, rival.what, slice(at, at + k), prior, -log(alike))


@dataclass(frozen=True)
class Race:
    """Products of whitened columns, with the base (zero, compliance, gap) marginalised.

    Attributes
    ----------
    gram (P, P), right (P,) : of columns scaled to unit prior, less what the base explains.
    base_gain : evidence of the base alone. rows : number of whitened rows. total : yᵀy whitened.
    """

    columns: Columns
    noise: Noise
    kept: np.ndarray
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

    @property
    def terms(self) -> tuple[Term, ...]:
        return self.columns.terms


def race(columns: Columns, target: np.ndarray, kept: np.ndarray, noise: Noise) -> Race:
    """Whiten the kept rows and form all products."""
    stretches = stretches_of(columns.rig.history, kept)
    prior = np.concatenate([t.prior for t in columns.terms]) if columns.terms else np.empty(0)
    block = max(1, int(kept.sum()) // MOST_ROWS)

    def prepared(values: np.ndarray) -> np.ndarray:
        return _summed(noise.whitened(values[kept].astype(float), stretches), block)

    y = prepared(target[:, None])[:, 0]
    base = prepared(columns.base)
    step = 64
    wide = [prepared(columns.all[:, i : i + step]) for i in range(0, columns.all.shape[1], step)]
    x = np.hstack(wide) * prior if wide else np.empty((len(y), 0))
    base_gram = base.T @ base + np.diag(columns.base_prior**-2)
    base_right = base.T @ y
    cross = base.T @ x
    solved = np.linalg.solve(base_gram, np.column_stack([base_right, cross]))
    gram = x.T @ x - cross.T @ solved[:, 1:]
    right = x.T @ y - cross.T @ solved[:, 0]
    return Race(
        columns, noise, kept, target, gram, right, prior, base_gram, base_right, cross,
        float(y @ y), len(y) * block,
    )  # fmt: skip


def _summed(values: np.ndarray, block: int) -> np.ndarray:
    if block == 1:
        return values
    n = len(values) // block * block
    return values[:n].reshape(-1, block, values.shape[1]).sum(axis=1) / np.sqrt(block)


@dataclass(frozen=True)
class Fit:
    """Posterior of a set of terms: `amplitudes` of each term's columns, `covariance` over them and the base.

    Order of `mean` and `covariance`: base first, then the terms' columns in the order of `terms`.
    """

    terms: tuple[int, ...]
    mean: np.ndarray
    covariance: np.ndarray
    base_count: int
    chi2: float

    def amplitudes(self, race: Race) -> list[np.ndarray]:
        """Amplitudes (k,) of each term."""
        at, out = self.base_count, []
        for i in self.terms:
            k = race.terms[i].at.stop - race.terms[i].at.start
            out.append(self.mean[at : at + k])
            at += k
        return out


def column_indices(race: Race, chosen: Sequence[int]) -> np.ndarray:
    """Columns of several terms, in order."""
    return np.concatenate(
        [np.arange(race.terms[i].at.start, race.terms[i].at.stop) for i in chosen] or [np.empty(0, int)]
    ).astype(int)


def fitted(race: Race, chosen: Sequence[int]) -> Fit:
    """Posterior mean and covariance of base and the chosen terms together."""
    at = column_indices(race, chosen)
    b = len(race.base_right)
    own = race.gram[np.ix_(at, at)] + race.base_cross[:, at].T @ np.linalg.solve(
        race.base_gram, race.base_cross[:, at]
    )
    matrix = np.block([
        [race.base_gram, race.base_cross[:, at]],
        [race.base_cross[:, at].T, own + np.eye(len(at))],
    ])
    right = np.concatenate(
        [race.base_right, race.right[at] + race.base_cross[:, at].T @ np.linalg.solve(race.base_gram, race.base_right)]
    )
    inverse = np.linalg.inv(matrix)
    mean = inverse @ right
    scale = np.concatenate([np.ones(b), race.scale[at]])
    plain = matrix - np.diag(np.concatenate([race.columns.base_prior**-2, np.ones(len(at))]))
    chi2 = race.total - 2 * mean @ right + mean @ plain @ mean
    return Fit(tuple(chosen), mean * scale, inverse * np.outer(scale, scale), b, float(chi2))
