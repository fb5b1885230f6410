"""Strain wave gears: stiffness with error bounds, stress, backlash, and what measurements say of them."""
