"""The standard basic rack of gears (ISO 53), in modules."""

ADDENDUM = 1.0
"""From the pitch circle to the tip."""
DEDENDUM = 1.25
"""From the pitch circle to the root circle."""
