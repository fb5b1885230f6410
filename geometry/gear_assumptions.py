"""Assumed values of the whole gear for optional keys that the design file leaves out."""

from __future__ import annotations

from collections.abc import Iterator

from flexspline.geometry.assumed import Assumed
from flexspline.geometry.circular_spline import circular_spline
from flexspline.geometry.design import Design
from flexspline.geometry.material import Materials
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.wave_generator import flexible_bearing


def gear_assumptions(design: Design) -> tuple[Assumed, ...]:
    """Values of optional keys that the design leaves out, key by key."""
    return (
        *rated_torque(design)[1],
        *circular_spline(design).assumed,
        *flexible_bearing(design).assumed,
        *_materials(design.material),
    )


def _materials(material: Materials) -> Iterator[Assumed]:
    for key, of, why in (
        ("circular_spline", material.of_circular_spline, "the flexspline's"),
        ("bearing", material.of_bearing, f"{material.of_bearing.name}, of races and balls"),
    ):
        if key not in material.stated:
            yield Assumed(f"material.{key}.youngs_modulus_GPa", of.youngs_modulus_GPa, why)
