"""What goes into a report: typed values and the pictures' paths, nothing formatted yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from flexspline.fea.toothed_ring.equivalent import EquivalentRing
from flexspline.fea.types import Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.gear.gear_curve import GearCurve
from flexspline.pipeline.linear_limit import LinearLimit
from flexspline.pipeline.stiffnesses import series_bounds_Nm_per_rad
from flexspline.results.quantities import quantity
from flexspline.results.report.attached import Attachment


@dataclass(frozen=True)
class ExtendedSum:
    """The backlash with what an extended model adds, and the name of the model's file."""

    model: str
    total_arcsec: float


@dataclass(frozen=True)
class ReportContent:
    """Everything that one report says.

    Attributes
    ----------
    version : of this program.
    stiffnesses : those that were solved, by the name of the figure ("K_b"), in the report's order; K_b of the
        case "uniform" and K_e are among them.
    K_series_Nm_per_rad : of the K_b that enters the sum and K_e.
    pictures : PNG files by the names that `results.pictures` gives them; one that is not there is left out.
    missing_pictures : why, by the same names, of those that could not be drawn.
    flexspline_peak, shaft_peak : under the load torque; wave_generator_peak : under the ellipse.
    half_seat_peak : the ellipse's on a seat half as wide as the ring, without bolt holes; full_seat_peak : on
        the whole seat without them, where wave_generator_peak is that with holes.
    linear_limit : beyond which torque the figures are not valid.
    ring : the plain ring that stands for drawn teeth, None where none are drawn.
    gear : the whole gear's curve; `gear_missing`: why there is none.
    warnings : one line each.
    stage_seconds : elapsed time of each stage that was computed and not read from the cache.
    versions : name and version of the libraries that computed and drew.
    extended : the sum with an extended model, whose terms the budget shows.
    attached : the files that the report carries, the design file first.
    """

    design: Design
    version: str
    stiffnesses: Mapping[str, Stiffness]
    K_series_Nm_per_rad: float
    backlash: Backlash
    pictures: Mapping[str, Path] = field(default_factory=dict)
    missing_pictures: Mapping[str, str] = field(default_factory=dict)
    flexspline_peak: StressPeak | None = None
    shaft_peak: StressPeak | None = None
    wave_generator_peak: StressPeak | None = None
    half_seat_peak: StressPeak | None = None
    full_seat_peak: StressPeak | None = None
    linear_limit: LinearLimit | None = None
    ring: EquivalentRing | None = None
    warnings: tuple[str, ...] = ()
    gear: GearCurve | None = None
    gear_missing: str = ""
    stage_seconds: Mapping[str, float] | None = None
    versions: Mapping[str, str] | None = None
    extended: ExtendedSum | None = None
    attached: tuple[Attachment, ...] = ()

    @property
    def K_b(self) -> Stiffness:
        """Of the flexspline, load case "uniform"."""
        return self.stiffnesses["K_b"]

    @property
    def K_e(self) -> Stiffness:
        """Of the shaft."""
        return self.stiffnesses["K_e"]

    @property
    def K_b_in_sum(self) -> Stiffness:
        """The K_b that `solver.load_case` puts into the sum."""
        return self.stiffnesses[self.design.solver.K_b_in_sum]

    @property
    def sum_symbol(self) -> str:
        """Of the K_b in the sum: that of its load case."""
        return quantity(f"{self.design.solver.K_b_in_sum}_Nm_per_rad").symbol

    @property
    def K_series_bounds_Nm_per_rad(self) -> tuple[float, float]:
        """Of the two springs of the sum."""
        return series_bounds_Nm_per_rad(self.K_b_in_sum, self.K_e)
