"""The one table of quantities: result.json key, unit, long name, symbol and how it is printed.

JSON, CSV, figures and the report all read it; no other file spells a unit or a symbol.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, log10
from typing import Literal

THIN = "\N{NARROW NO-BREAK SPACE}"
"""Between groups of three digits, and between a number and its unit."""

Kind = Literal["number", "count", "bounds", "text"]


@dataclass(frozen=True)
class Quantity:
    """One entry of result.json.

    Attributes
    ----------
    key : path in result.json, nested keys joined by dots.
    column : the CSV header, flat, the unit still its suffix.
    unit : as printed, "" for none.
    name : long name.
    symbol : letter and index joined by "_", e.g. ``K_b``; "" for none.
    kind : what stands under the key; "bounds" is a pair of numbers.
    digits : significant digits in print (kind "number" and "bounds").
    decimals : fixed decimals instead of significant digits.
    """

    key: str
    column: str
    unit: str
    name: str
    symbol: str = ""
    kind: Kind = "number"
    digits: int = 4
    decimals: int | None = None

    @property
    def mathtext(self) -> str:
        """The symbol for matplotlib, index upright."""
        letter, _, index = self.symbol.partition("_")
        return f"${letter}_{{\\mathrm{{{index}}}}}$" if index else f"${letter}$"

    @property
    def axis(self) -> str:
        """Label of an axis or a table's column: "long name in unit"."""
        return f"{self.name} in {self.unit}" if self.unit else self.name

    def text(self, value: float) -> str:
        """The number as printed, without unit: ``44712.3`` → ``44 712`` for five digits."""
        if self.kind == "count":
            return grouped(value, 0)
        if self.decimals is not None:
            return grouped(value, self.decimals)
        return grouped(value, _decimals(value, self.digits))

    def short(self, value: float, letters: int = 9) -> str:
        """As `text`; where that takes more letters, three digits and a power of ten."""
        text = self.text(value)
        return text if len(text) <= letters else with_power(value, 3)

    def with_unit(self, value: float) -> str:
        """The number and its unit."""
        return f"{self.text(value)}{THIN}{self.unit}" if self.unit else self.text(value)

    def range_text(self, low: float, high: float) -> str:
        """Both ends with the same decimals, enough of them that unequal ends look unequal."""
        places = _decimals(high, self.digits) if self.decimals is None else self.decimals
        while low != high and grouped(low, places) == grouped(high, places) and places < 6:
            places += 1
        return f"{grouped(low, places)} to {grouped(high, places)}"


def bounds_kind(guaranteed: bool) -> str:
    """What bounds are: "guaranteed" where both ends are theorems, else "estimated"."""
    return "guaranteed" if guaranteed else "estimated"


def grouped(value: float, decimals: int) -> str:
    """Fixed decimals, true minus sign, groups of three from five digits before the point on."""
    text = f"{abs(value):,.{decimals}f}"
    whole, point, rest = text.partition(".")
    whole = whole.replace(",", "") if abs(value) < 9999.5 else whole.replace(",", THIN)
    negative = value < 0 and float(f"{abs(value):.{decimals}f}") > 0
    return ("\N{MINUS SIGN}" if negative else "") + whole + point + rest


def with_power(value: float, digits: int = 1) -> str:
    """So many significant digits and a power of ten: ``3·10⁻⁶``; ``0`` is 0."""
    if not value:
        return "0"
    digit, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{digit}·10{str(int(exponent)).translate(_RAISED)}".replace("-", "\N{MINUS SIGN}")


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _decimals(value: float, digits: int) -> int:
    if value == 0:
        return 0
    return max(0, digits - 1 - floor(log10(abs(value))))


_STIFFNESS = "N·m/rad"

QUANTITIES: tuple[Quantity, ...] = (
    Quantity("design", "design", "", "Design", kind="text"),
    Quantity("version", "version", "", "Program version", kind="text"),
    Quantity(
        "K_b_Nm_per_rad",
        "K_b_Nm_per_rad",
        _STIFFNESS,
        "Flexspline stiffness, even torque on the ring (uniform)",
        "K_b",
        digits=5,
    ),
    Quantity(
        "K_b_bounds_Nm_per_rad",
        "K_b_bounds_Nm_per_rad",
        _STIFFNESS,
        "Bounds of the flexspline stiffness (uniform)",
        "K_b",
        kind="bounds",
        digits=5,
    ),
    Quantity(
        "K_b_lobes_Nm_per_rad",
        "K_b_lobes_Nm_per_rad",
        _STIFFNESS,
        "Flexspline stiffness, torque at the two lobes (lobes)",
        "K_b,lobes",
        digits=4,
    ),
    Quantity(
        "K_b_lobes_bounds_Nm_per_rad",
        "K_b_lobes_bounds_Nm_per_rad",
        _STIFFNESS,
        "Bounds of the flexspline stiffness (lobes)",
        "K_b,lobes",
        kind="bounds",
        digits=4,
    ),
    Quantity(
        "K_b_lobes_contact_Nm_per_rad",
        "K_b_lobes_contact_Nm_per_rad",
        _STIFFNESS,
        "Flexspline stiffness, torque at the two lobes, rim may lift off",
        "K_b,contact",
        digits=4,
    ),
    Quantity(
        "K_b_lobes_contact_bounds_Nm_per_rad",
        "K_b_lobes_contact_bounds_Nm_per_rad",
        _STIFFNESS,
        "Bounds of the flexspline stiffness, lobes, rim may lift off",
        "K_b,contact",
        kind="bounds",
        digits=4,
    ),
    Quantity(
        "K_b_lobes_unsupported_Nm_per_rad",
        "K_b_lobes_unsupported_Nm_per_rad",
        _STIFFNESS,
        "Flexspline stiffness, torque at the two lobes, rim unsupported",
        "K_b,free",
        digits=4,
    ),
    Quantity(
        "K_b_lobes_unsupported_bounds_Nm_per_rad",
        "K_b_lobes_unsupported_bounds_Nm_per_rad",
        _STIFFNESS,
        "Bounds of the flexspline stiffness, lobes, rim unsupported",
        "K_b,free",
        kind="bounds",
        digits=4,
    ),
    Quantity(
        "K_e_Nm_per_rad",
        "K_e_Nm_per_rad",
        _STIFFNESS,
        "Output shaft stiffness",
        "K_e",
        digits=5,
    ),
    Quantity(
        "K_e_bounds_Nm_per_rad",
        "K_e_bounds_Nm_per_rad",
        _STIFFNESS,
        "Bounds of the output shaft stiffness",
        "K_e",
        kind="bounds",
        digits=5,
    ),
    Quantity(
        "K_series_Nm_per_rad",
        "K_series_Nm_per_rad",
        _STIFFNESS,
        "Series stiffness of flexspline and shaft",
        "K",
        digits=5,
    ),
    Quantity(
        "wave_generator_peak_mises_MPa",
        "wave_generator_peak_mises_MPa",
        "MPa",
        "Peak von Mises stress, wave-generator ellipse",
        "σ_WG",
        digits=3,
    ),
    Quantity(
        "wave_generator_peak_half_seat_mises_MPa",
        "wave_generator_peak_half_seat_mises_MPa",
        "MPa",
        "Peak von Mises stress, ellipse, seat half as wide as the ring",
        "σ_WG,half",
        digits=3,
    ),
    Quantity(
        "torque_peak_mises_MPa",
        "torque_peak_mises_MPa",
        "MPa",
        "Peak von Mises stress, load torque",
        "σ_T",
        digits=3,
    ),
    Quantity(
        "shaft_torque_peak_mises_MPa",
        "shaft_torque_peak_mises_MPa",
        "MPa",
        "Peak von Mises stress of the shaft, load torque",
        "σ_T,shaft",
        digits=3,
    ),
    *(
        Quantity(
            f"{part}_{key}", f"{part}_{key}", unit, f"{name} of the {part}", f"{symbol}_{index}"
        )
        for part, index in (("flexspline", "b"), ("shaft", "e"))
        for key, unit, name, symbol in (
            ("mass_g", "g", "Mass", "m"),
            ("length_mm", "mm", "Length", "L"),
        )
    ),
    Quantity("ring_thickness_mm", "ring_thickness_mm", "mm", "Rim under the teeth", "t_rim"),
    *(
        Quantity(
            f"equivalent_ring_thickness{leaf}_mm",
            f"equivalent_ring_thickness{leaf}_mm",
            "mm",
            f"Plain ring as stiff as the toothed one, {name}",
            symbol,
        )
        for leaf, name, symbol in (
            ("", "bending (in K_b)", "t_b"),
            ("_membrane", "membrane", "t_m"),
            ("_torsion", "torsion", "t_t"),
        )
    ),
    Quantity(
        "equivalent_ring_difference_pct",
        "equivalent_ring_difference_pct",
        "%",
        "That plain ring, bending, over the rim",
        decimals=1,
    ),
    *(
        Quantity(
            f"backlash_arcsec.{leaf}",
            f"backlash_{leaf}_arcsec",
            "arcsec",
            name,
            symbol,
            decimals=1,
        )
        for leaf, name, symbol in (
            ("shaft", "Shaft wind-up", "Δ_1"),
            ("flexspline", "Flexspline wind-up", "Δ_2"),
            ("flank_clearance", "Flank clearance", "Δ_3"),
            ("bearing_play", "Bearing play", "Δ_4"),
            ("total", "Backlash, total", "Δ_bl"),
            ("std", "Standard deviation of the total", "s_bl"),
        )
    ),
    Quantity(
        "extended.total_arcsec",
        "extended_total_arcsec",
        "arcsec",
        "Backlash with the extended model",
        "Δ_ext",
        decimals=1,
    ),
    Quantity(
        "linear_torque_limit_Nm",
        "linear_torque_limit_Nm",
        "N·m",
        "Torque beyond which the linear model is not valid",
        "T_lin",
        digits=3,
    ),
    Quantity(
        "linear_torque_limit_reason",
        "linear_torque_limit_reason",
        "",
        "Reason for that limit",
        kind="text",
    ),
    Quantity("solver.model", "solver_model", "", "Model of K_b", kind="text"),
    Quantity("solver.elements", "solver_elements", "", "Elements, finest mesh", kind="count"),
    Quantity("solver.dofs", "solver_dofs", "", "Unknowns, finest mesh", kind="count"),
    Quantity("solver.wall_s", "solver_wall_s", "s", "Elapsed time", decimals=1),
    Quantity("solver.symmetry", "solver_symmetry", "", "Part solved", kind="text"),
)

BY_KEY = {q.key: q for q in QUANTITIES}


def quantity(key: str) -> Quantity:
    """The entry of a result.json key (nested keys joined by dots).

    Raises
    ------
    KeyError : no such key in the table.
    """
    return BY_KEY[key]
