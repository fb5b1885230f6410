"""Simplifies an outline to its visible edges, because the page draws each of them 144 times."""

from __future__ import annotations

import numpy as np

from flexspline.geometry.above_zero import ABOVE_ZERO


def simplified(rim: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """Edges (k, 2), each from its start to its end, with runs of them replaced by their chord.

    `seen` (count, f), beginning with the place: no node that is left out is farther than 1 in any of
    them from the chord at its own share of the run's length (Ramer 1972, Douglas and Peucker 1973).
    """
    edges = [
        np.column_stack([kept[:-1], kept[1:]])
        for chain in _chains(rim)
        for kept in [chain[_kept(seen[chain])]]
    ]
    return np.concatenate(edges)


def _chains(rim: np.ndarray) -> list[np.ndarray]:
    """Nodes of each connected run; a closed one begins and ends at the same node."""
    after = dict(rim.tolist())
    ends = set(after.values())
    starts = [node for node in after if node not in ends]
    chains = []
    while after:
        node = starts.pop() if starts else next(iter(after))
        chain = [node]
        while node in after:
            node = after.pop(node)
            chain.append(node)
        chains.append(np.array(chain))
    return chains


def _kept(seen: np.ndarray) -> np.ndarray:
    """Mask of the nodes of a chain that stay; a closed one keeps the node farthest from its start."""
    kept = np.zeros(len(seen), bool)
    kept[[0, -1]] = True
    along = np.concatenate([[0], np.linalg.norm(np.diff(seen[:, :2], axis=0), axis=1).cumsum()])
    far = int(np.linalg.norm(seen[:, :2] - seen[0, :2], axis=1).argmax())
    runs = [(0, far), (far, len(seen) - 1)]
    while runs:
        first, last = runs.pop()
        kept[[first, last]] = True
        if last - first < 2:
            continue
        inner = slice(first + 1, last)
        share = (along[inner] - along[first]) / max(along[last] - along[first], ABOVE_ZERO)
        chord = seen[first] + share[:, None] * (seen[last] - seen[first])
        off = np.abs(seen[inner] - chord).max(axis=1)
        worst = int(off.argmax())
        if off[worst] > 1:
            runs += [(first, first + 1 + worst), (first + 1 + worst, last)]
    return kept
