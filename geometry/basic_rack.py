"""The standard basic rack of gears (ISO 53), in modules."""

ADDENDUM = 1.0
"""From the pitch circle to the tip (ISO 53, h_aP)."""
DEDENDUM = 1.25
"""From the pitch circle to the root circle (ISO 53, profile A, h_fP)."""
