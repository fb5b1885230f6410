"""Accepted units of measured columns, how they are written, and their conversion factors."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

from flexspline.geometry.other_unit import KGF_N, LBF_N, INCH_mm
from flexspline.pipeline.backlash import ARCSEC_PER_RAD

Factors = Mapping[str, float]


ARCSEC_PER_TURN = 1_296_000.0
"""360 deg of 60 arcmin of 60 arcsec."""
INCH_M, FOOT_M = INCH_mm / 1e3, 0.3048
"""Exact: NIST SP 811 (2008), appendix B.8."""

TORQUE: Factors = {
    "Nm": 1.0, "Nmm": 1e-3, "mNm": 1e-3, "Ncm": 1e-2, "kNm": 1e3, "uNm": 1e-6, "daNm": 10.0,
    "in_lbf": LBF_N * INCH_M, "ft_lbf": LBF_N * FOOT_M, "in_ozf": LBF_N / 16 * INCH_M,
    "kgf_m": KGF_N, "kgf_cm": KGF_N * 1e-2, "kgf_mm": KGF_N * 1e-3, "gf_cm": KGF_N * 1e-5,
}  # fmt: skip
"""[N·m] in one of each unit."""
ANGLE: Factors = {
    "arcsec": 1.0, "arcmin": 60.0, "deg": 3600.0, "mdeg": 3.6, "gon": 3240.0,
    "urad": 0.18 * 3.6 / pi, "mrad": 180 * 3.6 / pi, "rad": ARCSEC_PER_RAD,
    "rev": ARCSEC_PER_TURN,
}  # fmt: skip
"""[arcsec] in one of each unit; a gon is a 400th of a turn."""
TIME: Factors = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}
"""[s] in one of each unit."""
TEMPERATURE: Factors = {"C": 1.0, "K": 1.0}
"""[°C] in one of each unit, of a difference; the two zeros are KELVIN_AT_0_C apart."""
STIFFNESS: Factors = {
    "Nm_per_rad": 1.0, "kNm_per_rad": 1e3, "Nm_per_deg": 180 / pi, "Nm_per_arcmin": 10800 / pi,
}  # fmt: skip
"""[N·m/rad] in one of each unit: a half turn is π rad, 180 deg, 10 800 arcmin."""


KELVIN_AT_0_C = 273.15
"""[K]: SI Brochure, 9th edition (2019), section 2.3.1."""
COUNTS = "counts"
"""Of an encoder: an angle only once the counts of a turn are known."""


@dataclass(frozen=True)
class MeasuredQuantity:
    """A measured quantity: our unit, what one of each accepted unit is worth in it, and its name."""

    unit: str
    factors: Factors
    name: str


_DEGREES = {unit: factor / 3600 for unit, factor in ANGLE.items()}
"""What one of each unit of angle is in deg, of 3600 arcsec: our unit of the input angle alone."""
QUANTITIES: Mapping[str, MeasuredQuantity] = {
    "torque": MeasuredQuantity("Nm", TORQUE, "torque"),
    "angle": MeasuredQuantity("arcsec", ANGLE, "angle"),
    "angle_plus": MeasuredQuantity("arcsec", ANGLE, "angle"),
    "angle_minus": MeasuredQuantity("arcsec", ANGLE, "angle"),
    "time": MeasuredQuantity("s", TIME, "time"),
    "input_angle": MeasuredQuantity("deg", _DEGREES, "angle"),
    "temperature": MeasuredQuantity("C", TEMPERATURE, "temperature"),
    "stiffness": MeasuredQuantity("Nm_per_rad", STIFFNESS, "stiffness"),
    "stiffness_std": MeasuredQuantity("Nm_per_rad", STIFFNESS, "stiffness"),
}
"""By the name that our columns begin with."""


_NEWTON_METRES = (
    "newtonmeter newtonmetre newtonmeters newtonmetres "
    "newton-meter newton-metre newton-meters newton-metres"
)
_INCH, _FOOT, _CM = "in inch inches", "ft foot feet", "cm"
_POUND = "lbf lb lbs lbsf pound pounds pound-force pounds-force"
_OUNCE = "ozf oz ounce ounces ounce-force"
_KGF = "kgf kg kp"


def _products(forces: str, lengths: str) -> str:
    """Every way of writing force times length: in both orders, with a hyphen between or nothing."""
    pairs = [(f, n) for f in forces.split() for n in lengths.split()]
    return " ".join(
        f"{one}{between}{two}"
        for pair in pairs
        for one, two in (pair, pair[::-1])
        for between in ("", "-")
    )


_WRITTEN: Mapping[str, Mapping[str, str]] = {
    "torque": {
        "Nm": f"Nm NM nm N-m N-M n-m {_NEWTON_METRES} 牛米 牛-米 牛顿米 牛顿-米 ニュートンメートル",
        "Nmm": "Nmm N-mm 牛毫米 牛-毫米", "mNm": "mNm mnm mN-m 毫牛米 毫牛-米", "Ncm": "Ncm N-cm cNm cN-m",
        "kNm": "kNm knm KNm kN-m 千牛米 千牛-米", "uNm": "uNm µNm μNm uN-m µN-m μN-m", "daNm": "daNm daN-m",
        "in_lbf": _products(_POUND, _INCH), "ft_lbf": _products(_POUND, _FOOT),
        "in_ozf": _products(_OUNCE, _INCH), "kgf_m": _products(_KGF, "m"),
        "kgf_cm": _products(_KGF, _CM), "kgf_mm": _products(_KGF, "mm"), "gf_cm": _products("gf g", _CM),
    },
    "angle": {
        "arcsec": "arcsec arcsecs arc-sec arc-seconds arcsecond arcseconds asec ″ \" '' ′′ ’’ ” "
        "secondsofarc secofarc bogensekunde bogensekunden 角秒 弧秒 秒角 秒",
        "arcmin": "arcmin arcmins arc-min arc-minutes arcminute arcminutes amin ′ ' ’ "
        "minutesofarc minofarc bogenminute bogenminuten 角分 弧分 分角 分",
        "deg": "deg degs degree degrees ° º Grad 度",
        "mdeg": "mdeg m°", "gon": "gon",
        "urad": "urad µrad μrad microradian microradians",
        "mrad": "mrad millirad milliradian milliradians 毫弧度",
        "rad": "rad rads radian radians radiant 弧度 ラジアン",
        "rev": "rev revs revolution revolutions turn turns umdrehung umdrehungen 圈",
        COUNTS: "counts count cts inc incs increment increments inkr inkremente pulses ticks digits",
    },
    "time": {
        "s": "s sec secs second seconds sek sekunde sekunden 秒",
        "ms": "ms msec millisecond milliseconds millisekunden 毫秒 ミリ秒",
        "us": "us µs μs microseconds",
        "min": "min mins minute minutes minuten 分 分钟",
        "h": "h hr hrs hour hours std stunde stunden 小时 时 時間",
    },
    "temperature": {
        "C": "C c °C ℃ ºC degC degc celsius gradcelsius 度 摄氏度", "K": "K kelvin degK °K",
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
"""By the quantity's name: our word for each way of writing a unit, without spaces; the sign of a product is
left out, a hyphen stays."""
_PRODUCT = re.compile(
    r"(?<=[A-Za-z牛顿ン])\s*[·⋅∙•・･×*.]\s*(?=[A-Za-zµμ米毫メ])|\s+|[⁻^](?=\d|¹)|(?<=[A-Za-z])\.$"
)
"""Signs of a product, spaces, a power's sign, and the dot of an abbreviation at the end."""
_HYPHEN = re.compile(r"(?<=[A-Za-z牛顿])\.?[-−‐‑–_](?=[A-Za-z米毫])")
"""What may stand for a product in a unit of two words; `m-s` and `m_Nm` are none, so a table holds them."""


def _in_any_case(ways: Mapping[str, str]) -> Mapping[str, str]:
    """Of ways in small letters, those that one unit alone has; grad (gon) is no Grad (°)."""
    units: dict[str, set[str]] = {}
    for way, unit in ways.items():
        units.setdefault(way.lower(), set()).add(unit)
    return {way: u.pop() for way, u in units.items() if len(u) == 1 and way != "grad"}


_IN_ANY_CASE = {name: _in_any_case(ways) for name, ways in UNITS.items()}


def unit_named(name: str, written: str) -> str | None:
    """Our word for a unit of the quantity `name`; None for what is none."""
    ways = UNITS[name]
    bare = written.strip()
    plain = _PRODUCT.sub("", bare)
    for way in (plain, bare, _HYPHEN.sub("-", plain)):
        if way in ways:
            return ways[way]
        lower = way.lower()
        if len(lower) > 3 and lower != "grad" and lower in ways:
            return ways[lower]
        if not _is_mega(name, way) and len(lower) > 1 and lower in _IN_ANY_CASE[name]:
            return _IN_ANY_CASE[name][lower]
    return None


def _is_mega(name: str, way: str) -> bool:
    """Whether a small first letter would make another unit of it: mNm is no MNm."""
    return way.startswith("M") and way[1:].lower() in _IN_ANY_CASE[name]


def symbol(unit: str) -> str:
    """A unit as it is printed: in·lbf, Nm/rad, °C."""
    return "°C" if unit == "C" else unit.replace("_per_", "/").replace("_", "·")
