"""Gap and compliance of the simulation as fitted to a record, the design's uncertainty as their prior."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Estimate:
    """A value and its standard deviation, in one unit."""

    value: float
    std: float


@dataclass(frozen=True)
class Calibration:
    """What the extended model has beside its causes, common to all units.

    Attributes
    ----------
    gap_arcsec : the whole gap at 20 °C.
    beside_effects : whether effects found were fitted beside it, and are not in it.
    compliance : [arcsec per N·m]; None where the record leaves it as simulated.
    """

    gap_arcsec: Estimate
    beside_effects: bool
    compliance: Estimate | None = None
