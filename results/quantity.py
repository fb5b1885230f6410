"""A quantity of result.json: its names, and how its values are printed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from flexspline.results.numbers import THIN, decimals_for, figures_text, grouped, with_power

PrintKind = Literal["number", "count", "bounds", "text"]
STIFFNESS_UNIT = "N·m/rad"
LEAST_IN_kg = 10_000.0
"""Grams from which a mass is printed in kg."""
MOST_DECIMALS = 6
"""Digits behind the point: ends that agree so far are printed alike."""


@dataclass(frozen=True)
class Quantity:
    """One entry of result.json.

    Attributes
    ----------
    key : path in result.json, nested keys joined by dots.
    unit : as printed, "" for none.
    name : long name.
    symbol : letter and index joined by "_", e.g. ``K_b``; "" for none.
    kind : what stands under the key; "bounds" is a pair of numbers.
    digits : significant digits in print (kind "number" and "bounds").
    rounded : whether digits before the point are rounded to `digits` too, for what has no bounds.
    decimals : fixed decimals instead of significant digits.
    short_name : where there is room for a few words, as beside the live page's part; "" for none.
    note : beside it in the report: of a stiffness, what is held and what is driven.
    group : of figures that are listed together: "gear", what the whole gear does; "gear torque", the torques
        that divide its curve; "" for none.
    """

    key: str
    unit: str
    name: str
    symbol: str = ""
    kind: PrintKind = "number"
    digits: int = 4
    rounded: bool = False
    decimals: int | None = None
    note: str = ""
    short_name: str = ""
    group: Literal["", "gear", "gear torque"] = ""

    @property
    def mathtext(self) -> str:
        """The symbol for matplotlib, index upright."""
        letter, _, index = self.symbol.replace(" ", r"\ ").partition("_")
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
        if self.rounded:
            value = float(f"{value:.{self.digits}g}")
        return figures_text(value, self.digits)

    def short(self, value: float, letters: int = 9) -> str:
        """As `text`; where that takes more letters, three digits and a power of ten."""
        text = self.text(value)
        return text if len(text) <= letters else with_power(value, 3)

    def with_unit(self, value: float) -> str:
        """The number and its unit; kilograms for many grams."""
        if self.unit == "g" and value >= LEAST_IN_kg:
            return f"{figures_text(value / 1000, self.digits)}{THIN}kg"
        return f"{self.text(value)}{THIN}{self.unit}" if self.unit else self.text(value)

    def range_text(self, low: float, high: float) -> str:
        """Both ends with the same decimals, enough of them that unequal ends look unequal."""
        places = decimals_for(high, self.digits) if self.decimals is None else self.decimals
        while (
            low != high and grouped(low, places) == grouped(high, places) and places < MOST_DECIMALS
        ):
            places += 1
        return f"{grouped(low, places)} to {grouped(high, places)}"
