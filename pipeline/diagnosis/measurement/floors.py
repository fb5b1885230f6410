"""What stands for 0 in a denominator where the numerator may be more than 0, far below what a rig resolves.

Where both are 0 together, `ABOVE_ZERO` does.
"""

from __future__ import annotations

LEAST_TIME_S = 1e-12
"""Between rows; no clock of a rig resolves 1e-9 s. Torque that changes within one time stamp has a rate
beyond all others, whose square is still a number."""
LEAST_TORQUE_Nm = 1e-12
"""No torque cell resolves 1e-9 N·m: torque that moves by less stands still, but for rounding."""
LEAST_ANGLE_ARCSEC = 1e-12
"""No reading resolves 1e-6 arcsec, and doubles round a whole turn at 2e-10: an angle that is less is none."""
