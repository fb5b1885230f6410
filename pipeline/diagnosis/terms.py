"""The race's terms on one record: whitened columns, their products, and the evidence of any set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import log

import numpy as np

from pipeline.diagnosis.effects.cause import Cause, Rig, Shape
from pipeline.diagnosis.effects.torque_program import torque_noise_Nm
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
    positive: bool
    """Whether its amplitudes may not be negative."""
    log_share: float
    """Log of the share of its cause's (or channel's) prior that this shape has."""

    @property
    def owner(self) -> str:
        """Cause id, or `?channel`."""
        return self.cause.id if self.cause else f"?{self.channel}"


@dataclass(frozen=True)
class Columns:
    """All columns of a record before whitening; float32 keeps 100 000 rows in memory."""

    rig: Rig
    base: np.ndarray
    base_prior: np.ndarray
    """(b,) standard deviations; the columns are zeros, compliance and gap, common and per unit."""
    all: np.ndarray
    terms: tuple[Term, ...]


CORNER = 4.0
NOISE_WINDOWS = (2, 7)
"""Rows on each side over which the torque is taken as a parabola."""


def jitter(history: History, width: int) -> np.ndarray:
    """(n,) torque less a parabola through its neighbours: its noise, and little else.

    With noise in the torque reading, whatever knows the true torque better explains the angle better.
    These columns take that away from every term, so that no cause is found in the torque's noise.
    """
    out = np.zeros(len(history))
    for rows in history.unit_slices:
        n = len(rows)
        torque = history.torque_Nm[rows]
        t = np.arange(n, dtype=float) if history.time_s is None else history.time_s[rows]
        near = np.clip(np.arange(n)[:, None] + np.arange(-width, width + 1), 0, n - 1)
        x = t[near] - t[:, None]
        x /= np.maximum(np.abs(x).max(axis=1, keepdims=True), 1e-12)
        basis = np.stack([np.ones_like(x), x, x * x], axis=2)
        gram = np.einsum("nwi,nwj->nij", basis, basis) + 1e-9 * np.eye(3)
        right = np.einsum("nwi,nw->ni", basis, torque[near])
        out[rows] = torque - np.linalg.solve(gram, right[:, :, None])[:, 0, 0]
    # beyond its noise it is a corner of the programme, not noise
    return np.where(np.abs(out) < CORNER * torque_noise_Nm(history), out, 0.0)


def base_columns(rig: Rig) -> tuple[np.ndarray, np.ndarray]:
    """(n, b) zero of each unit, deviation of compliance and gap (common, and per unit if several), torque noise."""
    h, p = rig.history, rig.prediction
    units = [np.isin(np.arange(len(h)), rows).astype(float) for rows in h.unit_slices]
    columns = [*units, h.torque_Nm, h.sign / 2]
    prior = [ZERO_STD_ARCSEC] * len(units) + [p.compliance_std, p.gap_std_arcsec]
    if len(units) > 1:
        for own in units:
            columns += [own * h.torque_Nm, own * h.sign / 2]
            prior += [p.compliance_std, p.gap_std_arcsec]
    for width in NOISE_WINDOWS:
        columns.append(jitter(h, width))
        prior.append(p.compliance)
    return np.column_stack(columns), np.maximum(np.array(prior), 1e-9)


def columns_of(rig: Rig, known: dict[str, Cause]) -> Columns:
    """Evaluate every shape of every cause, and every competitor, on a rig's record."""
    base, prior = base_columns(rig)
    blocks: list[np.ndarray] = []
    terms: list[Term] = []
    width = 0
    for cause in known.values():
        shapes = cause.shapes(rig)
        for shape, block in zip(shapes, cause.columns_of_all(shapes, rig.history), strict=True):
            k = block.shape[1]
            spread = np.full(k, cause.spread(shape, rig))
            terms.append(
                Term(cause, shape, "", cause.title, slice(width, width + k), spread, cause.positive, -log(len(shapes)))
            )
            blocks.append(block.astype(np.float32))
            width += k
    rivals = competitors(rig)
    for rival in rivals:
        terms.append(_competitor(rival, rivals, width, rig))
        blocks.append(rival.columns.astype(np.float32))
        width += rival.columns.shape[1]
    return Columns(rig, base, prior, np.hstack(blocks), tuple(terms))


def _competitor(rival: Unnamed, rivals: Sequence[Unnamed], at: int, rig: Rig) -> Term:
    alike = sum(r.channel == rival.channel for r in rivals)
    k = rival.columns.shape[1]
    prior = np.full(k, UNNAMED_SPREAD * rig.scale_arcsec)
    return Term(None, {}, rival.channel, rival.what, slice(at, at + k), prior, rival.positive, -log(alike))


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
    y: np.ndarray
    base: np.ndarray
    x: np.ndarray
    """(r,), (r, b), (r, P) whitened; x scaled to unit prior."""

    def prepared(self, values: np.ndarray) -> np.ndarray:
        """(n, k) further columns of the record, whitened like all others."""
        stretches = stretches_of(self.columns.rig.history, self.kept)
        block = max(1, int(self.kept.sum()) // MOST_ROWS)
        return _summed(self.noise.whitened(values[self.kept].astype(float), stretches), block)

    @property
    def terms(self) -> tuple[Term, ...]:
        return self.columns.terms


def race(columns: Columns, target: np.ndarray, kept: np.ndarray, noise: Noise) -> Race:
    """Whiten the kept rows and form all products."""
    empty = np.empty((0, 0))
    bare = Race(
        columns, noise, kept, target, empty, np.empty(0), np.empty(0), empty, np.empty(0), empty,
        0.0, 0, np.empty(0), empty, empty,
    )  # fmt: skip
    y = bare.prepared(target[:, None])[:, 0]
    base = bare.prepared(columns.base)
    prior = np.concatenate([t.prior for t in columns.terms]) if columns.terms else np.empty(0)
    step = 64
    wide = [bare.prepared(columns.all[:, i : i + step]) for i in range(0, columns.all.shape[1], step)]
    x = np.hstack(wide) * prior if wide else np.empty((len(y), 0))
    block = max(1, int(kept.sum()) // MOST_ROWS)
    base_gram = base.T @ base + np.diag(columns.base_prior**-2)
    base_right = base.T @ y
    cross = base.T @ x
    solved = np.linalg.solve(base_gram, np.column_stack([base_right, cross]))
    gram = x.T @ x - cross.T @ solved[:, 1:]
    right = x.T @ y - cross.T @ solved[:, 0]
    return replace(
        bare, gram=gram, right=right, scale=prior, base_gram=base_gram, base_right=base_right,
        base_cross=cross, total=float(y @ y), rows=len(y) * block, y=y, base=base, x=x,
    )  # fmt: skip


def with_terms(old: Race, shapes: Sequence[tuple[Term, Shape]]) -> Race:
    """The race with further shapes, each beside a term of the same cause; known ones are skipped."""
    known = {_shape_key(t.owner, t.shape) for t in old.terms}
    columns, terms, blocks = old.columns, list(old.terms), []
    width = columns.all.shape[1]
    for like, shape in shapes:
        key = _shape_key(like.owner, shape)
        if like.cause is None or key in known:
            continue
        known.add(key)
        block = like.cause.columns(shape, columns.rig.history)
        k = block.shape[1]
        spread = np.full(k, like.cause.spread(shape, columns.rig))
        terms.append(replace(like, shape=shape, at=slice(width, width + k), prior=spread))
        blocks.append(block.astype(np.float32))
        width += k
    if not blocks:
        return old
    new = np.hstack(blocks)
    prior = np.concatenate([t.prior for t in terms[len(old.terms) :]])
    x = old.prepared(new) * prior
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


def _shape_key(owner: str, shape: Shape) -> tuple[str, tuple[tuple[str, float], ...]]:
    return owner, tuple(sorted((k, float(f"{v:.6g}")) for k, v in shape.items()))


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
