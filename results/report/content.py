"""What goes into a report: typed values and the pictures' paths, nothing formatted yet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from flexspline.fea.types import StressPeak
from flexspline.geometry.design import Design
from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.gear.gear_curve import GearCurve
from flexspline.pipeline.linear_limit import LinearLimit
from flexspline.pipeline.stiffnesses import Stiffnesses
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
    stiffnesses : K_b of the case "uniform", that of the sum and K_e are among them.
    pictures : PNG files by the names that `results.pictures` gives them; one that is not there is left out.
    missing_pictures : why, by the same names, of those that could not be drawn.
    flexspline_peak, shaft_peak : under the load torque; wave_generator_peak : under the ellipse.
    linear_limit : beyond which torque the figures are not valid.
    gear : the whole gear's curve; `stiffnesses.missing` says why there is none.
    warnings : one line each.
    stage_seconds : elapsed time of each stage that was computed and not read from the cache.
    versions : name and version of the libraries that computed and drew.
    extended : the sum with an extended model, whose terms the budget shows.
    attached : the files that the report carries, the design file first.
    """

    design: Design
    version: str
    stiffnesses: Stiffnesses
    backlash: Backlash
    pictures: Mapping[str, Path] = field(default_factory=dict)
    missing_pictures: Mapping[str, str] = field(default_factory=dict)
    flexspline_peak: StressPeak | None = None
    shaft_peak: StressPeak | None = None
    wave_generator_peak: StressPeak | None = None
    linear_limit: LinearLimit | None = None
    warnings: tuple[str, ...] = ()
    gear: GearCurve | None = None
    stage_seconds: Mapping[str, float] | None = None
    versions: Mapping[str, str] | None = None
    extended: ExtendedSum | None = None
    attached: tuple[Attachment, ...] = ()

    @property
    def sum_symbol(self) -> str:
        """Of the K_b in the sum: that of its load case."""
        return quantity(f"{self.design.solver.K_b_in_sum}_Nm_per_rad").symbol
