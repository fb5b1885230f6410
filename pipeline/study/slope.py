"""dK/dp of one dimension, found by two methods."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from flexspline.fea.types import MET, Shortfall
from flexspline.geometry.part_name import PartName

ALIKE = 0.01
"""Slopes that differ by less, in K per 100 % of the dimension over K, are one: no decision hangs on it."""


@dataclass(frozen=True)
class Slope:
    """One dimension's influence on its part's K.

    Attributes
    ----------
    held : dK/dp from the energy with the field held [N·m/rad per mm].
    solved : dK/dp from differences of K solved again.
    why : why one of them is None.
    solved_error : what the bounds of K and the extrapolation leave open of it.
    K_Nm_per_rad : of the part, hole-free.
    backlash_arcsec_per_mm : d(wind-up of the part between −T_L and +T_L)/dp, by the K that enters the sum;
        None where that has no slope.
    why_no_sum : why it has none.
    """

    key: str
    part: PartName
    value_mm: float
    held: float | None
    solved: float | None
    solved_error: float
    K_Nm_per_rad: float
    backlash_arcsec_per_mm: float | None
    why: Shortfall = MET
    why_no_sum: Shortfall = MET

    @property
    def best(self) -> float:
        """The slope with the field held, where there is one, else the other."""
        return self.held if self.held is not None else (self.solved or 0.0)

    @property
    def elasticity(self) -> float:
        """% of K per % of the dimension."""
        return self.best * self.value_mm / self.K_Nm_per_rad

    @property
    def agree(self) -> bool | None:
        """Whether both ways meet within the second's error and a percent of K per 100 %."""
        if self.held is None or self.solved is None:
            return None
        slack = self.solved_error + ALIKE * self.K_Nm_per_rad / self.value_mm
        return abs(self.held - self.solved) <= slack


@dataclass(frozen=True)
class Slopes:
    """The slopes of one design; `missing`: why a dimension has none, by its key."""

    slopes: tuple[Slope, ...]
    missing: Mapping[str, Shortfall]
