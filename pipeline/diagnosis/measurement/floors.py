"""Values that replace 0 in a denominator if the numerator may exceed 0; far below the resolution of a rig.

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
FINEST_TORQUE_Nm = 1e-9
"""No torque cell resolves it: added to a deadband, so that a torque without noise has one above 0."""
ROUNDING_ARCSEC = 1e-9
"""Doubles round a whole turn at 2e-10, and no reading resolves 1e-6: a deviation of angles that is less is
none. Added to a record's deviation, so that one without noise has one above 0."""
ROUNDING_OF_SUMS = 1e-9
"""Of the largest term. A sum of n doubles is off by n·2⁻⁵³ of it at the most: 1e-10 for a million rows."""
