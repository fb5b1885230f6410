"""Selects the triangles of a meridian that are refined next."""

from __future__ import annotations

import numpy as np

MOST_TRIANGLES = 400_000
"""A mesh with more triangles is the last one: 0.8 million nodes."""


def bulk(share: np.ndarray, fraction: float) -> np.ndarray:
    """Return the mask (m,) of the fewest triangles whose `share` (m,) sums to a fraction of the whole.

    Source: W. Dörfler, SIAM J. Numer. Anal. 33 (1996) 1106-1124.
    """
    order = np.argsort(-share)
    held = np.cumsum(share[order])
    mask = np.zeros(len(share), bool)
    mask[order[: int(np.searchsorted(held, fraction * held[-1])) + 1]] = True
    return mask
