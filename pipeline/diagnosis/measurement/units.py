"""Accepted units of measured columns, how they are written, and what one of each is worth in ours."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

Factors = Mapping[str, float]


# what one of each unit is in ours: N·m, arcsec, s, °C, N·m/rad
TORQUE: Factors = {"Nm": 1.0, "Nmm": 1e-3, "mNm": 1e-3, "Ncm": 1e-2, "kNm": 1e3}
ANGLE: Factors = {
    "arcsec": 1.0, "arcmin": 60.0, "deg": 3600.0, "mdeg": 3.6, "gon": 3240.0,
    "urad": 0.18 * 3.6 / pi, "mrad": 180 * 3.6 / pi, "rad": 180 * 3600 / pi,
}  # fmt: skip
TIME: Factors = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}
TEMPERATURE: Factors = {"C": 1.0, "K": 1.0}
STIFFNESS: Factors = {
    "Nm_per_rad": 1.0, "kNm_per_rad": 1e3, "Nm_per_deg": 180 / pi, "Nm_per_arcmin": 10800 / pi,
}  # fmt: skip


KELVIN_AT_0_C = 273.15
"""SI Brochure, 9th edition (2019), section 2.3.1."""
COUNTS = "counts"
"""Of an encoder: an angle only once the counts of a turn are known."""
ARCSEC_PER_TURN = 1_296_000.0


@dataclass(frozen=True)
class Quantity:
    """A measured quantity: our unit, what one of each accepted unit is worth in it, and its name."""

    unit: str
    factors: Factors
    name: str


_DEGREES = {unit: factor / 3600 for unit, factor in ANGLE.items()}
QUANTITIES: Mapping[str, Quantity] = {
    "torque": Quantity("Nm", TORQUE, "torque"),
    "angle": Quantity("arcsec", ANGLE, "angle"),
    "angle_plus": Quantity("arcsec", ANGLE, "angle"),
    "angle_minus": Quantity("arcsec", ANGLE, "angle"),
    "time": Quantity("s", TIME, "time"),
    "input_angle": Quantity("deg", _DEGREES, "angle"),
    "temperature": Quantity("C", TEMPERATURE, "temperature"),
    "stiffness": Quantity("Nm_per_rad", STIFFNESS, "stiffness"),
    "stiffness_std": Quantity("Nm_per_rad", STIFFNESS, "stiffness"),
}
"""By the name that our columns begin with."""


_WRITTEN: Mapping[str, Mapping[str, str]] = {
    "torque": {
        "Nm": "Nm NM nm N_m N-m newtonmeter newtonmetre newtonmeters newtonmetres newton-meter",
        "Nmm": "Nmm", "mNm": "mNm mnm", "Ncm": "Ncm", "kNm": "kNm knm KNm",
    },
    "angle": {
        "arcsec": "arcsec arcsecs arc-sec arc-seconds arcsecond arcseconds asec ″ \" '' ” "
        "bogensekunde bogensekunden",
        "arcmin": "arcmin arcmins arc-min arc-minutes arcminute arcminutes amin ′ ' ’ bogenminute "
        "bogenminuten",
        "deg": "deg degs degree degrees ° º Grad",
        "mdeg": "mdeg m°", "gon": "gon",
        "urad": "urad µrad μrad", "mrad": "mrad milliradian milliradians",
        "rad": "rad radian radians radiant",
        COUNTS: "counts count cts inc incs increment increments inkr inkremente pulses ticks digits",
    },
    "time": {
        "s": "s sec secs second seconds sek sekunde sekunden",
        "ms": "ms msec millisecond milliseconds millisekunden",
        "us": "us µs μs microseconds",
        "min": "min mins minute minutes minuten", "h": "h hr hrs hour hours std stunde stunden",
    },
    "temperature": {
        "C": "C c °C ℃ ºC degC degc celsius gradcelsius", "K": "K kelvin degK °K",
    },
    "stiffness": {
        "Nm_per_rad": "Nm_per_rad Nm/rad Nmrad-1 Nm/rad.", "kNm_per_rad": "kNm_per_rad kNm/rad",
        "Nm_per_deg": "Nm_per_deg Nm/deg Nm/°", "Nm_per_arcmin": "Nm_per_arcmin Nm/arcmin Nm/′ Nm/'",
    },
}  # fmt: skip
UNITS: Mapping[str, Mapping[str, str]] = {
    name: {way: unit for unit, ways in units.items() for way in ways.split()}
    for name, units in _WRITTEN.items()
}
"""By the quantity's name: our word for each way of writing a unit, without spaces and product signs."""
_PRODUCT = re.compile(r"(?<=[A-Za-z])\s*[·⋅∙•×*.]\s*(?=[A-Za-z])|\s+|[⁻^](?=\d|¹)")


def unit_named(name: str, written: str) -> str | None:
    """Our word for a unit of the quantity `name`; None for what is none."""
    ways = UNITS[name]
    plain = _PRODUCT.sub("", written.strip())
    if plain in ways:
        return ways[plain]
    # words in any case; symbols are told by case: mNm is no MNm, and grad (gon) no Grad (°)
    lower = plain.lower()
    long = len(lower) > 3 and lower != "grad"
    return ways.get(lower) if long else None


def names_with(written: str) -> tuple[str, ...]:
    """Names of the quantities that have a unit so written."""
    return tuple(name for name in UNITS if unit_named(name, written) is not None)
