"""ISO 2768-1, class m: how far a dimension may be off the drawing without being wrong."""

from __future__ import annotations

LINEAR_MM = (
    (6.0, 0.1), (30.0, 0.2), (120.0, 0.3), (400.0, 0.5), (1000.0, 0.8), (2000.0, 1.2), (4000.0, 2.0),
)  # fmt: skip
"""Nominal size up to, permissible deviation ± [mm]; ISO 2768-1:1989, table 1. The table begins at
0.5 mm: below, the standard wants a deviation on the drawing, a design file has none, and the
smallest class's 0.1 mm is used."""
RADIUS_MM = ((3.0, 0.2), (6.0, 0.5), (float("inf"), 1.0))
"""The same for radii and chamfers; table 2."""


def general_tolerance_mm(nominal_mm: float, radius: bool = False) -> float:
    """Permissible deviation ± [mm] of a length [mm] without its own tolerance.

    Examples
    --------
    >>> general_tolerance_mm(30.0), general_tolerance_mm(30.1), general_tolerance_mm(1.0, radius=True)
    (0.2, 0.3, 0.2)
    """
    table = RADIUS_MM if radius else LINEAR_MM
    for limit, tolerance in table:
        if nominal_mm <= limit:
            return tolerance
    return table[-1][1]
