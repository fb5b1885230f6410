"""Contact of a gear's flanks, seat and balls at a given turn of the output, for solve.py."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls

from flexspline.fea.types import NMM_PER_NM


def forces(
    compliance: np.ndarray, gap: np.ndarray, hertz: np.ndarray, start: np.ndarray | None
) -> np.ndarray:
    """F ≥ 0 with gap + compliance F + hertz F^(2/3) ≥ 0, complementary."""
    found = np.ones(len(gap)) if start is None else start
    ridge = 1e-12 * compliance.diagonal().max()
    for _ in range(100):
        near = np.maximum(found, 1.0)  # below 1 N a straight line, off by 0.1 µm at most
        slope = 2 / 3 * hertz * near ** (-1 / 3)
        lower = cholesky(compliance + np.diag(slope + ridge), lower=True)
        right = -solve_triangular(lower, gap + hertz * near ** (2 / 3) - slope * near, lower=True)
        new, _ = nnls(lower.T, right, maxiter=20 * len(gap))
        settled = np.abs(new - found).max() < 1e-6 * new.max()
        found = new
        if settled or not hertz.any():
            return found
    raise SystemExit("the balls' forces did not settle")


@dataclass(frozen=True)
class Problem:
    """Contacts: flanks (teeth · slices, front then back), seat points, balls.

    Attributes
    ----------
    compliance : gap per force [mm/N].
    gap, turning : at rest [mm], and what a turn adds [mm/rad].
    hertz : C of δ = C F^(2/3) [mm/N^(2/3)], 0 where there is none.
    flanks, slices : how many flank contacts, and of each tooth.
    seat : angles of the seat points [rad].
    """

    compliance: np.ndarray
    gap: np.ndarray
    hertz: np.ndarray
    turning: np.ndarray
    flanks: int
    slices: int
    seat: np.ndarray

    def forces(self, turn: float, start: np.ndarray | None = None) -> np.ndarray:
        """At a turn [rad]; `start`: forces near the answer."""
        return forces(self.compliance, self.gap + self.turning * turn, self.hertz, start)

    def curve(self, turns: tuple[float, ...]) -> list[dict]:
        """At each turn [rad]: torque of the whole gear, teeth and share of the seat's angles that carry."""
        found, last = [], None
        for turn in turns:
            last = self.forces(turn, last)
            teeth = last[: self.flanks].reshape(2, -1, self.slices).sum(axis=2)
            on = last[self.flanks : self.flanks + len(self.seat)] > 0
            strips = np.unique(np.round(self.seat, 9))
            touched = len(np.unique(np.round(self.seat[on], 9)))
            found.append({
                "turn_rad": turn, "torque_Nm": float(-2 * self.turning @ last / NMM_PER_NM),
                "teeth": 2 * int((teeth > 0).sum()), "largest_tooth_N": float(teeth.max()),
                "seat_share": touched / len(strips),
            })  # fmt: skip
        return found
