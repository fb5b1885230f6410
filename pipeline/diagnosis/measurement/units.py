"""Accepted units of measured columns, and what one of each is worth in ours."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

Factors = dict[str, float]


# what one of each unit is in ours: N·m, arcsec, s
TORQUE: Factors = {"Nm": 1.0, "Nmm": 1e-3}
ANGLE: Factors = {
    "arcsec": 1.0, "arcmin": 60.0, "deg": 3600.0,
    "mrad": 180 * 3.6 / pi, "rad": 180 * 3600 / pi,
}  # fmt: skip


TIME: Factors = {"s": 1.0, "min": 60.0, "h": 3600.0}


KELVIN_AT_0_C = 273.15
"""SI Brochure, 9th edition (2019), section 2.3.1."""


QUANTITIES: Mapping[str, tuple[str, Factors]] = {
    "torque": ("Nm", TORQUE),
    "angle": ("arcsec", ANGLE),
    "angle_plus": ("arcsec", ANGLE),
    "angle_minus": ("arcsec", ANGLE),
    "time": ("s", TIME),
    "input_angle": ("deg", {unit: factor / 3600 for unit, factor in ANGLE.items()}),
    "temperature": ("C", {"C": 1.0, "K": 1.0}),
    "stiffness": ("Nm_per_rad", {"Nm_per_rad": 1.0}),
    "stiffness_std": ("Nm_per_rad", {"Nm_per_rad": 1.0}),
}
"""Quantity: our unit, and what one of each accepted unit is worth in it."""
