"""Bisection of tetrahedron edges, with all elements and facets that contain them.

Edges are ranked by length; equal lengths are ranked by number. Each tetrahedron is halved at the
highest-ranked of its edges that are to be halved, as in bisection of longest edges (Rivara, Int. J. Numer.
Methods Eng. 20, 1984, 745-756), and its halves at theirs. How a face is cut depends on its own edges alone,
so both its tetrahedra and the boundary's facet are cut in the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from flexspline.fea.edges import SIDES, distinct_edges, edge_numbers

PAIRS = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
"""Edges of a tetrahedron."""


@dataclass(frozen=True)
class Simplices:
    """Tetrahedra (m, 4), positive, and facets (k, 3), outward, each on a surface (k,), of `nodes` nodes.

    `parents` (m,), after halving: the tetrahedron of the mesh before that each is a part of.
    """

    nodes: int
    tets: np.ndarray
    facets: np.ndarray
    facet_surface: np.ndarray
    parents: np.ndarray | None = None

    def edges(self) -> np.ndarray:
        """Each edge once (e, 2), the lesser node first."""
        return distinct_edges(self.tets[:, PAIRS], self.nodes)


def halved(
    mesh: Simplices, edges: np.ndarray, lengths: np.ndarray, marked: np.ndarray
) -> tuple[Simplices, np.ndarray]:
    """Halve those edges (e, 2) of the mesh that are `marked` (e,); `lengths` (e,) rank them.

    Also returns the halved edges (j, 2). Their new middle nodes are numbered from `mesh.nodes` on, in this
    order.
    """
    if not np.any(marked):
        return replace(mesh, parents=np.arange(len(mesh.tets))), edges[:0]
    n = mesh.nodes
    key = edge_numbers(edges, n)
    rising = np.argsort(key)
    edges, lengths, key = edges[rising], lengths[rising], key[rising]
    halve = np.asarray(marked)[rising]
    order = np.lexsort((np.arange(len(key)), lengths))
    rank = np.empty(len(key), np.int64)
    rank[order] = np.arange(len(key))
    cut = np.flatnonzero(halve)
    middle = np.full(len(key), -1)
    middle[cut] = n + np.arange(len(cut))

    def marked_rank(pairs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ranks of pairs of nodes, -1 where they are not to be halved, and the nodes between."""
        old = np.asarray((pairs < n).all(axis=-1))
        at = np.minimum(
            np.searchsorted(key, edge_numbers(np.where(old[..., None], pairs, 0), n)), len(key) - 1
        )
        there = old & (key[at] == edge_numbers(pairs, n)) & halve[at]
        return np.where(there, rank[at], -1), middle[at]

    tets, whose = _cut(mesh.tets, PAIRS, marked_rank)
    facets, parent = _cut(mesh.facets, SIDES, marked_rank)
    finer = Simplices(n + len(cut), tets, facets, mesh.facet_surface[parent], whose)
    return finer, edges[cut]


def _cut(
    simplices: np.ndarray,
    pairs: np.ndarray,
    marked_rank: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray]:
    """Simplices halved at their highest marked edges until none is left, and whose parts they are."""
    done, owners = [], []
    owner = np.arange(len(simplices))
    while len(simplices):
        rank, between = marked_rank(simplices[:, pairs])
        whole = (rank < 0).all(axis=1)
        done.append(simplices[whole])
        owners.append(owner[whole])
        simplices, owner = simplices[~whole], owner[~whole]
        best = rank[~whole].argmax(axis=1)
        rows = np.arange(len(simplices))
        node = between[~whole][rows, best]
        one, other = simplices.copy(), simplices.copy()
        one[rows, pairs[best, 1]] = node
        other[rows, pairs[best, 0]] = node
        simplices, owner = np.vstack([one, other]), np.concatenate([owner, owner])
    return np.vstack(done), np.concatenate(owners)
