"""Plausible ranges of input values from physics and metrology, wide enough for any real gear.

Wave gears reach from 1 mm, of plastic or nickel, to telescope drives of metres. What lies outside is a slip
of the unit or of the exponent, and numbers such as 1e-310 would divide by zero further on.
"""

from __future__ import annotations

from typing import NamedTuple

from flexspline.geometry.errors import plain_number


class Range(NamedTuple):
    """Both ends belong to it."""

    low: float
    high: float

    def __contains__(self, value: object) -> bool:
        return isinstance(value, int | float) and self.low <= value <= self.high  # false for NaN

    def __str__(self) -> str:
        return f"from {plain_number(self.low, 6)} to {plain_number(self.high, 6)}"


LENGTH_mm = Range(1e-3, 1e4)
"""Below 1 µm is beneath what the CAD kernel keeps apart (its tolerance is 1e-4 µm); 10 m."""
CLEARANCE_um = Range(0, 1e4)
"""None; a centimetre."""
YOUNGS_MODULUS_GPa = Range(1e-3, 2000)
"""Soft rubber; diamond has 1220."""
POISSONS_RATIO = Range(0, 0.49)
"""Cork; rubber, beyond which displacement elements lock."""
FATIGUE_LIMIT_MPa = Range(1e-3, 1e5)
"""Soft rubber; beyond any theoretical strength, diamond's included."""
DENSITY_kg_per_m3 = Range(100, 25_000)
"""Light foam; osmium has 22 590."""
MODULE_mm = Range(1e-3, 100)
"""As lengths; the largest that standards name (ISO 54 ends at 50)."""
TEETH = Range(10, 10_000)
"""Fewer are pointed or undercut; at 0.1 mm a ring of a metre has as many."""
PRESSURE_ANGLE_deg = Range(5, 45)
"""The least, where every tooth of ten or more has a tip; beyond, flanks leave no tooth."""
TORQUE_Nm = Range(1e-9, 1e6)
"""A gear of 1 mm carries 1e-6; the largest in catalogues carry 1e4."""
TOLERANCE_pct = Range(0.01, 20)
"""Below, rounding in the solver shows; above, a K is of no use."""
EDGE_mm = Range(1e-3, 1000)
"""As lengths; no part of 10 m is meshed with fewer than ten elements."""
STIFFNESS_Nm_per_rad = Range(1e-12, 1e15)
"""A cup of 1 mm in soft rubber has some 1e-12, a solid shaft of 10 m in steel 1e14."""
TEMPERATURE_C = Range(-273.15, 1000)
"""Absolute zero; far beyond where grease chars and hardened steel turns soft. Broken sensors read more."""
COUNTS_PER_TURN = Range(1, 1e12)
"""Of an encoder: one mark; absolute ones reach 2³² with a count of 3e-4 arcsec."""
SMALLEST_ANGLE_arcsec = 1e-6
"""A record whose largest angle is smaller holds nothing: the best encoders tell 1e-3 apart."""
SMALLEST_NUMBER = 1e-30
"""What is read below this is 0: products of such numbers leave the range of a double."""
