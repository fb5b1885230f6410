"""Forces that only push: the linear complementarity problem p ≥ 0, u = u0 + S p ≥ 0, p·u = 0.

Solved by Mehrotra's predictor-corrector interior point method (SIAM J. Optim. 2 (1992) 575-601). Its rounds
hardly depend on the number of places. A primal-dual active set does not settle on a thin rim with many of
them: S is no inverse of an M-matrix (pushed here, the rim bends outwards there), so the set runs in a circle.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from flexspline.fea.axisymmetric.harmonics import HarmonicError
from flexspline.fea.interior_point import corrected, room

SEAT_RESIDUAL = 1e-10
"""The rounds end when forces times gaps, and the residual of the gaps, are below this share of the largest.
Judgement: far below the error by the number of angles on the seat."""
MOST_ROUNDS = 100
"""Most rounds. Rims of 150 random designs took up to 18, 2000 random problems up to 20."""
SEAT_STEP_SHARE = 0.995
"""Share of the way to the nearest bound that a step may go: near 1, as usual in primal-dual interior-point
methods (S. J. Wright, Primal-Dual Interior-Point Methods, SIAM 1997)."""


def pushing(matrix: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return forces p (n,) ≥ 0 that leave gaps free + matrix @ p ≥ 0 and act only where a gap is closed.

    `matrix` (n, n) is symmetric and positive definite; `free` (n,) are the gaps without forces.

    Raises
    ------
    HarmonicError : the forces did not settle.
    """
    size = float(np.abs(free).max())
    if free.min() >= 0:
        return np.zeros_like(free)
    force = np.full(len(free), size / matrix.diagonal().mean())
    gap = np.full(len(free), size)
    for _ in range(MOST_ROUNDS):
        residual = gap - free - matrix @ force
        both = force * gap
        if (
            np.abs(residual).max() < SEAT_RESIDUAL * size
            and both.max() < SEAT_RESIDUAL * size * force.max()
        ):
            return force
        factor = cho_factor(matrix + np.diag(gap / force), check_finite=False)

        def towards(product: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            """Newton step to forces times gaps larger by `product`, and to gaps that fit."""
            by = cho_solve(factor, product / force + residual)  # noqa: B023  (called in this round only)
            return by, matrix @ by - residual  # noqa: B023

        push, lift = towards(-both)
        push, lift = towards(corrected(force, gap, push, lift))
        reach = SEAT_STEP_SHARE * room(force, push, gap, lift)
        force, gap = force + reach * push, gap + reach * lift
    raise HarmonicError(
        f"the contact on the seat did not settle in {MOST_ROUNDS} rounds: force times gap is "
        f"{both.max() / (size * force.max()):.1e} of the largest, allowed {SEAT_RESIDUAL:.0e}"
    )
