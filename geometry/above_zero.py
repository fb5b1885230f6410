"""What stands for 0 in a denominator whose numerator is 0 too."""

ABOVE_ZERO = 1e-300
"""Below every length, area and energy of a design, in any unit; above the doubles that lose digits."""
