"""Nodal averages of element values."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

ElementValues = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Of some elements: nodes (m, k), the weight of each (m,), and its values (m, k, components) at its nodes."""


def nodal_average(count: int, components: int, parts: Iterable[ElementValues]) -> np.ndarray:
    """Return the weighted mean (count, components) at every node over the elements that meet there."""
    shares, sums = np.zeros(count), np.zeros((components, count))
    for nodes, weight, values in parts:
        at, share = nodes.ravel(), np.repeat(weight, nodes.shape[1])
        shares += np.bincount(at, share, count)
        for component, total in enumerate(sums):
            total += np.bincount(at, share * values[..., component].ravel(), count)
    return (sums / shares).T
