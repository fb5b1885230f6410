"""Plausible ranges of input values from physics and metrology, wide enough for any real gear.

Wave gears reach from 1 mm, of plastic or nickel, to telescope drives of metres. What lies outside is a slip
of the unit or of the exponent, and numbers such as 1e-310 would divide by zero further on.
"""

from __future__ import annotations

from typing import NamedTuple, TypeGuard

from flexspline.geometry.errors import plain_number


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value is a number, whole or not; true and false are none."""
    return isinstance(value, int | float) and not isinstance(value, bool)


class Range(NamedTuple):
    """Both ends belong to it."""

    low: float
    high: float

    def __contains__(self, value: object) -> bool:
        return isinstance(value, int | float) and self.low <= value <= self.high  # false for NaN

    def __str__(self) -> str:
        return f"from {plain_number(self.low, 6)} to {plain_number(self.high, 6)}"


LENGTH_mm = Range(1e-3, 1e4)
"""1 µm, because the CAD kernel does not distinguish much less (its tolerance is 1e-4 µm), to 10 m."""
CLEARANCE_um = Range(0, 1e4)
"""No clearance to one centimetre."""
YOUNGS_MODULUS_GPa = Range(1e-3, 2000)
"""From soft rubber to beyond diamond, which has 1220."""
POISSONS_RATIO = Range(0, 0.49)
"""From cork to rubber; displacement elements lock beyond."""
FATIGUE_LIMIT_MPa = Range(1e-3, 1e5)
"""From soft rubber to beyond any theoretical strength, including that of diamond."""
DENSITY_kg_per_m3 = Range(100, 25_000)
"""From light foam to beyond osmium, which has 22 590."""
MODULE_mm = Range(1e-3, 100)
"""As lengths; the largest that standards name (ISO 54 ends at 50)."""
TEETH = Range(10, 10_000)
"""With fewer, teeth are pointed or undercut; a ring of one metre with module 0.1 mm has as many as the upper
end."""
PRESSURE_ANGLE_deg = Range(5, 45)
"""At the lower end every tooth of ten or more has a tip; beyond the upper end flanks leave no tooth."""
TORQUE_Nm = Range(1e-9, 1e6)
"""A gear of 1 mm carries 1e-6 N·m; the largest in catalogues carry 1e4 N·m."""
TOLERANCE_pct = Range(0.01, 20)
"""Below the range rounding in the solver shows; above it K is of no use."""
EDGE_mm = Range(1e-3, 1000)
"""As lengths; no part of 10 m is meshed with fewer than ten elements."""
STIFFNESS_Nm_per_rad = Range(1e-12, 1e15)
"""A cup of 1 mm in soft rubber has some 1e-12, a solid shaft of 10 m in steel 1e14."""
TEMPERATURE_C = Range(-273.15, 1000)
"""From absolute zero to far beyond the point where grease chars and hardened steel softens. Broken sensors
read more."""
COUNTS_PER_TURN = Range(1, 1e12)
"""Of an encoder: from one mark to absolute encoders with 2³² counts, 3e-4 arcsec each."""
SMALLEST_ANGLE_arcsec = 1e-6
"""A record whose largest angle is smaller contains no information: the best encoders resolve 1e-3."""
SMALLEST_NUMBER = 1e-30
"""A smaller number in a file is read as 0, because products of such numbers leave the range of a double."""
