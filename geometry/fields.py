"""Types of the design file's fields: frozen strict tables, and numbers with their ranges."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from flexspline.geometry import ranges
from flexspline.geometry.errors import DesignError

SMALLEST_MM = ranges.LENGTH_mm.low


def _zero_or_visible(value: float) -> float:
    if 0 < value < SMALLEST_MM:
        raise ValueError(f"must be 0 or at least {SMALLEST_MM}")
    return value


def within(range_: ranges.Range, description: str | None = None) -> Any:
    """A field's limits."""
    return Field(ge=range_.low, le=range_.high, allow_inf_nan=False, description=description)


Length = Annotated[float, within(ranges.LENGTH_mm, "mm")]
LengthOrZero = Annotated[
    float,
    Field(
        ge=0,
        le=ranges.LENGTH_mm.high,
        allow_inf_nan=False,
        description="mm",
        json_schema_extra={"anyOf": [{"const": 0}, {"minimum": SMALLEST_MM}]},
    ),
    AfterValidator(_zero_or_visible),
]
Percent = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False, description="%")]
"""Of a standard deviation: beyond 100 % the quantity would be known no better than its sign."""
MM_PER_UM, UM_PER_MM = 1e-3, 1e3
"""[mm/µm], [µm/mm]: dimensions are in mm, clearances in µm."""
Micrometre = Annotated[float, within(ranges.CLEARANCE_um, "µm")]
BoltCount = Annotated[int, Field(ge=0, le=200)]
"""The examples have 6 and 12; the end keeps a slip of the keyboard from asking for thousands."""


UNCHANGED = "a design does not change; Design.changed({key: value}) makes another one"


class DesignTable(BaseModel):
    """A table of the design file: unknown keys and other types are refused, values never change."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    def __setattr__(self, name: str, value: Any) -> None:
        raise DesignError(name, value, UNCHANGED)

    def __delattr__(self, name: str) -> None:
        raise DesignError(name, getattr(self, name, None), UNCHANGED)
