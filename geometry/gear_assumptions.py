"""All that the whole gear takes where a design file is silent."""

from __future__ import annotations

from flexspline.geometry.assumed import Assumed
from flexspline.geometry.circular_spline import circular_spline
from flexspline.geometry.design import Design
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.wave_generator import flexible_bearing


def gear_assumptions(design: Design) -> tuple[Assumed, ...]:
    """Values of optional keys that the design leaves out, key by key."""
    return (
        *rated_torque(design)[1],
        *circular_spline(design).assumed,
        *flexible_bearing(design).assumed,
    )
