"""K_b of each load case and K_e as solved, and which of them the backlash sum takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.backlash import series_stiffness
from flexspline.pipeline.rim_case import RIM_CASES, figure_of

if TYPE_CHECKING:
    from flexspline.fea.toothed_ring.equivalent import EquivalentRing
    from flexspline.fea.types import Shortfall, Stiffness, StressPeak
    from flexspline.geometry.design import Design

FIGURES = ("K_b", *map(figure_of, RIM_CASES), "K_e")
"""In the order of the reports."""


def in_order(figures: Mapping[str, Stiffness | None]) -> dict[str, Stiffness]:
    """Return those of `FIGURES` that were solved, in their order."""
    return {name: figure for name in FIGURES if (figure := figures.get(name)) is not None}


@dataclass(frozen=True)
class Stiffnesses:
    """All stiffnesses that were solved, and the peaks on the wave generator.

    Attributes
    ----------
    solved : by the name of the figure, in the order of `FIGURES`.
    half_seat_peak : the wave generator's peak on a seat half as wide as the ring.
    full_seat_peak : the same on the whole seat, bolt holes left out as in `half_seat_peak`; of a part with
        holes alone.
    ring : the plain ring that stood for the teeth in all K_b, None where none were drawn.
    missing : why a figure that was asked for is not there, by its name.
    """

    solved: Mapping[str, Stiffness]
    wave_generator_peak: StressPeak | None = None
    half_seat_peak: StressPeak | None = None
    ring: EquivalentRing | None = None
    missing: Mapping[str, Shortfall] = field(default_factory=dict)
    full_seat_peak: StressPeak | None = None

    def __getitem__(self, name: str) -> Stiffness:
        """The figure of that name.

        Raises
        ------
        NotFoundError : it failed, or nobody asked for it.
        """
        if name not in self.solved:
            raise NotFoundError(name, str(self.missing.get(name, "it was not requested")), self)
        return self.solved[name]

    @property
    def passing(self) -> bool:
        """Whether more time or memory would find some figure that is missing."""
        return any(why.of_the_machine for why in self.missing.values())

    @property
    def K_b(self) -> Stiffness:
        """K_b of the case "uniform"; raises NotFoundError."""
        return self["K_b"]

    @property
    def K_e(self) -> Stiffness:
        """K_e of the shaft; raises NotFoundError."""
        return self["K_e"]

    def in_sum(self, design: Design) -> Stiffness:
        """Return the K_b that enters the backlash sum, by `solver.load_case`; raises NotFoundError."""
        return self[design.solver.K_b_in_sum]

    def has_sum(self, design: Design) -> bool:
        """Whether both K of the backlash sum are there."""
        return {design.solver.K_b_in_sum, "K_e"} <= set(self.solved)

    def require(self, design: Design) -> None:
        """Require both K of the sum and K_b of the case "uniform", which every answer is about.

        Raises
        ------
        NotFoundError : one of them is not there.
        """
        for name in ("K_b", "K_e", design.solver.K_b_in_sum):
            self[name]

    def series_Nm_per_rad(self, design: Design) -> float:
        """Return K of 1/K = 1/K_e + 1/K_b; raises NotFoundError."""
        return series_stiffness(self.in_sum(design).K_Nm_per_rad, self.K_e.K_Nm_per_rad)


def series_bounds_Nm_per_rad(K_b: Stiffness, K_e: Stiffness) -> tuple[float, float]:
    """Return K in series at both parts' lower and at both parts' upper bounds."""
    low = series_stiffness(K_b.lower_Nm_per_rad, K_e.lower_Nm_per_rad)
    high = series_stiffness(K_b.upper_Nm_per_rad, K_e.upper_Nm_per_rad)
    return low, high


class NotFoundError(ComputationError):
    """A figure that the answer needs failed: its `name`, and all other `stiffnesses`."""

    def __init__(self, name: str, why: str, stiffnesses: Stiffnesses) -> None:
        self.name, self.stiffnesses = name, stiffnesses
        super().__init__(f"{name} was not found: {why}")
