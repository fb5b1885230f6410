"""Smallest denominator, used instead of 0 if the numerator is 0 too."""

ABOVE_ZERO = 1e-300
"""Below every length, area and energy of a design, in any unit; above the doubles that lose digits."""
