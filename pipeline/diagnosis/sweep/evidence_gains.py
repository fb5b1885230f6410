"""What each of many regressors would add to the evidence of a set, by one batch of small linear solves."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence import GaussianEvidence

_NONE = np.empty(0, int)


@dataclass(frozen=True)
class RegressorGroup:
    """m regressors with the same number k of columns, for arithmetic on all of them at once.

    Attributes
    ----------
    members : (m,) their numbers. at : (m, k) their columns. own : (m, k, k) their blocks of the
        evidence's matrix, prior included. log_share, unnamed, positive : (m,).
    of_owner : of each owner, its places among the m. against : of each member that does not stand beside
        every other owner, its place and those owners.
    """

    members: np.ndarray
    at: np.ndarray
    own: np.ndarray
    log_share: np.ndarray
    unnamed: np.ndarray
    positive: np.ndarray
    of_owner: dict[str, np.ndarray]
    against: list[tuple[int, frozenset[str]]]

    @staticmethod
    def of(evidence: GaussianEvidence, members: list[int]) -> RegressorGroup:
        terms = [evidence.terms[i] for i in members]
        at = np.array([np.arange(t.at.start, t.at.stop) for t in terms])
        owners = [t.owner for t in terms]
        return RegressorGroup(
            np.array(members),
            at,
            evidence.gram[at[:, :, None], at[:, None, :]] + np.eye(at.shape[1]),
            np.array([t.log_share for t in terms]),
            np.array([t.cause is None for t in terms]),
            np.array([t.positive for t in terms]),
            {o: np.flatnonzero([x == o for x in owners]) for o in dict.fromkeys(owners)},
            [(j, t.against) for j, t in enumerate(terms) if t.against],
        )

    def barred(self, present: set[str], shut: frozenset[str]) -> np.ndarray:
        """(m,) members that do not stand beside the causes present, or are shut out by a term there."""
        out = self.owned_by(shut)
        for j, against in self.against:
            out[j] |= not against.isdisjoint(present)
        return out

    def owned_by(self, owners: Collection[str]) -> np.ndarray:
        """(m,) members of these owners."""
        out = np.zeros(len(self.members), bool)
        for o in owners:
            out[self.of_owner.get(o, _NONE)] = True
        return out

    def best_of_owners(self, score: np.ndarray, most: int) -> np.ndarray:
        """Places of each owner's members with the highest scores (m,), at most so many of one owner."""
        places = list(self.of_owner.values())
        owner = np.repeat(np.arange(len(places)), [len(mine) for mine in places])
        order = np.concatenate(places)
        order = order[np.lexsort((-score[order], owner))]
        rank = np.arange(len(owner)) - np.searchsorted(owner, owner)
        return order[rank < most]

    def gains(
        self,
        evidence: GaussianEvidence,
        cross: np.ndarray,
        pull: np.ndarray,
        mean: np.ndarray,
        held: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Evidence (m,) that each member adds to a set, and whether all signs stay as physics has them.

        Of the set's s columns: `cross` (s, P) their rows of the Gram matrix, `pull` (s, P) the posterior
        covariance times these, `mean` (s,) their amplitudes, `held` (s,) whether one may not be negative.
        """
        c, p = cross[:, self.at], pull[:, self.at]  # (s, m, k)
        matrix = self.own - np.einsum("smk,sml->mkl", c, p)
        right = evidence.right[self.at] - np.einsum("smk,s->mk", c, mean)
        _, logdet = np.linalg.slogdet(matrix)
        amplitude = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        gain = (right * amplitude).sum(axis=1) / 2 - logdet / 2
        valid = ~self.positive | (amplitude >= 0).all(axis=1)
        if held.any():
            moved = mean[held, None] - np.einsum("smk,mk->sm", p[held], amplitude)
            valid &= (moved >= 0).all(axis=0)
        return gain, valid
