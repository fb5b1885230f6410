"""What each of many regressors would add to the evidence of many sets, by batches of small linear solves."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    column_indices,
)

_NONE = np.empty(0, int)


@dataclass(frozen=True)
class ColumnSets:
    """B sets with the same number s of columns, of the P of a record's evidence.

    Attributes
    ----------
    cross (B, s, P) : rows of the Gram matrix. pull (B, s, P) : posterior covariance times these.
    mean (B, s) : amplitudes. held (B, s) : whether one may not be negative.
    """

    cross: np.ndarray
    pull: np.ndarray
    mean: np.ndarray
    held: np.ndarray

    @staticmethod
    def of(evidence: GaussianEvidence, sets: Sequence[Sequence[int]]) -> ColumnSets:
        """Of sets of terms."""
        at = np.array([column_indices(evidence, terms) for terms in sets])
        inverse = np.linalg.inv(with_prior(evidence, at))
        cross = evidence.gram[at]
        mean = (inverse @ evidence.right[at][:, :, None])[:, :, 0]
        return ColumnSets(cross, inverse @ cross, mean, evidence.positive_columns[at])


@dataclass(frozen=True)
class RegressorGroup:
    """m regressors with the same number k of columns, for arithmetic on all of them at once.

    Attributes
    ----------
    at : (m, k) their columns. own : (m, k, k) their blocks of the evidence's matrix, prior included.
    """

    at: np.ndarray
    own: np.ndarray

    @staticmethod
    def of(evidence: GaussianEvidence, members: Sequence[int]) -> RegressorGroup:
        at = column_indices(evidence, members).reshape(len(members), -1)
        return RegressorGroup(at, with_prior(evidence, at))

    def gains(self, evidence: GaussianEvidence, sets: ColumnSets) -> tuple[np.ndarray, np.ndarray]:
        """Evidence (B, m) that each member adds to each set, and whether all signs stay physical."""
        c, p = sets.cross[:, :, self.at], sets.pull[:, :, self.at]  # (B, s, m, k)
        matrix = self.own - np.einsum("bsmk,bsml->bmkl", c, p)
        right = evidence.right[self.at] - np.einsum("bsmk,bs->bmk", c, sets.mean)
        _, logdet = np.linalg.slogdet(matrix)
        amplitude = np.linalg.solve(matrix, right[..., None])[..., 0]
        gain = (right * amplitude).sum(axis=2) / 2 - logdet / 2
        moved = sets.mean[:, :, None] - np.einsum("bsmk,bmk->bsm", p, amplitude)
        valid = ((amplitude >= 0) | ~evidence.positive_columns[self.at]).all(axis=2)
        return gain, valid & ((moved >= 0) | ~sets.held[:, :, None]).all(axis=1)


@dataclass(frozen=True)
class RegressorPool:
    """All M regressors that may join a set: first those of the first group, there owner by owner.

    Attributes
    ----------
    members : (M,) their numbers. groups : by number of columns. block : (M,) which owner's of which group.
    log_share, unnamed : (M,). of_owner : of each owner, its places among the M. against : of each member
    that does not stand beside every other owner, its place and those owners.
    """

    members: np.ndarray
    groups: tuple[RegressorGroup, ...]
    block: np.ndarray
    log_share: np.ndarray
    unnamed: np.ndarray
    of_owner: dict[str, np.ndarray]
    against: list[tuple[int, frozenset[str]]]

    @staticmethod
    def of(evidence: GaussianEvidence, allowed: Sequence[int]) -> RegressorPool:
        """Of the terms with these numbers."""
        blocks: dict[int, dict[str, list[int]]] = {}
        for i in allowed:
            term = evidence.terms[i]
            blocks.setdefault(term.width, {}).setdefault(term.owner, []).append(i)
        groups = [[i for block in of_width.values() for i in block] for of_width in blocks.values()]
        sizes = [len(block) for of_width in blocks.values() for block in of_width.values()]
        members = [i for group in groups for i in group]
        terms = [evidence.terms[i] for i in members]
        owners = np.array([t.owner for t in terms])
        return RegressorPool(
            np.array(members, int),
            tuple(RegressorGroup.of(evidence, group) for group in groups),
            np.repeat(np.arange(len(sizes)), sizes),
            np.array([t.log_share for t in terms]),
            np.array([t.cause is None for t in terms], bool),
            {o: np.flatnonzero(owners == o) for o in dict.fromkeys(owners.tolist())},
            [(j, t.against) for j, t in enumerate(terms) if t.against],
        )

    def gains(self, evidence: GaussianEvidence, sets: ColumnSets) -> tuple[np.ndarray, np.ndarray]:
        """Evidence (B, M) that each member adds to each set, and whether all signs stay physical."""
        gains_of_groups = [group.gains(evidence, sets) for group in self.groups]
        gain, valid = zip(*gains_of_groups, strict=True)
        return np.concatenate(gain, axis=1), np.concatenate(valid, axis=1)

    def barred(self, present: Collection[str], shut: Collection[str]) -> np.ndarray:
        """(M,) members that do not stand beside the causes present, or are shut out by a term there."""
        out = self.owned_by(shut)
        for j, against in self.against:
            out[j] |= not against.isdisjoint(present)
        return out

    def owned_by(self, owners: Collection[str]) -> np.ndarray:
        """(M,) members of these owners."""
        out = np.zeros(len(self.members), bool)
        for o in owners:
            out[self.of_owner.get(o, _NONE)] = True
        return out

    def best_of_owners(self, score: np.ndarray, most: int) -> np.ndarray:
        """Places of the members with the highest scores (M,), at most so many of one owner's in a group."""
        order = np.lexsort((-score, self.block))
        rank = np.arange(len(order)) - np.searchsorted(self.block, self.block)
        return order[rank < most]


def with_prior(evidence: GaussianEvidence, at: np.ndarray) -> np.ndarray:
    """(B, s, s) blocks of the evidence's matrix of B sets of columns (B, s), their unit priors included."""
    return np.asarray(evidence.gram[at[:, :, None], at[:, None, :]] + np.eye(at.shape[1]))
