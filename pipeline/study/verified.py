"""The fast and the solid model's figures of one design, side by side."""

from __future__ import annotations

from dataclasses import dataclass

STRESS_SHARE = 0.05
"""The two models' peak stresses may differ by so much: neither states bounds of it."""


@dataclass(frozen=True)
class Check:
    """One figure of one design by both models; bounds where a model states them.

    `agrees`: the intervals meet; of figures without bounds, the values are within STRESS_SHARE.
    """

    key: str
    fast: float
    fast_bounds: tuple[float, float] | None
    solid: float
    solid_bounds: tuple[float, float] | None

    @property
    def agrees(self) -> bool:
        if self.fast_bounds is None or self.solid_bounds is None:
            return abs(self.solid - self.fast) <= STRESS_SHARE * abs(self.solid)
        low, high = self.fast_bounds
        return low <= self.solid_bounds[1] and self.solid_bounds[0] <= high

    @property
    def difference_pct(self) -> float:
        """Solid less fast, of the fast [%]."""
        return 100 * (self.solid / self.fast - 1)


@dataclass(frozen=True)
class Verified:
    """A design's checks, or why the solid model gave none.

    `contradicted`: it gave none because the models contradict each other.
    """

    slot: int
    checks: tuple[Check, ...]
    reason: str = ""
    contradicted: bool = False
