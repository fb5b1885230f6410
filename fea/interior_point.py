"""Parts of Mehrotra's method that both contact solvers use (SIAM J. Optim. 2 (1992) 575-601)."""

from __future__ import annotations

import numpy as np

CENTRING = 3
"""The target falls with this power of what the plain Newton step leaves (Mehrotra's choice)."""


def room(force: np.ndarray, push: np.ndarray, gap: np.ndarray, lift: np.ndarray) -> float:
    """Return the share of a step (`push`, `lift`), at most 1, that leaves forces and gaps (k,) positive."""
    nearest = max(float((-push / force).max()), float((-lift / gap).max()))
    return 1.0 if nearest <= 1 else 1 / nearest


def corrected(force: np.ndarray, gap: np.ndarray, push: np.ndarray, lift: np.ndarray) -> np.ndarray:
    """Return (k,) by how much forces times gaps shall grow, after a plain Newton step (`push`, `lift`).

    What that step leaves, gone as far as there is room, says how far to aim; `push` times `lift` is what a
    straight step misses.
    """
    both = force * gap
    reach = room(force, push, gap, lift)
    left = ((force + reach * push) * (gap + reach * lift)).mean() / both.mean()
    return np.asarray(left**CENTRING * both.mean() - both - push * lift)
