"""The design file's own uncertainty in words: stated, in part, or not at all."""

from __future__ import annotations

from collections.abc import Collection

from flexspline.geometry.listed import joined
from flexspline.pipeline.backlash import STD_KEY, Backlash
from flexspline.results.quantities import quantity

SOURCES = {
    "youngs_modulus": "Young's modulus",
    "flank_clearance": "flank clearance",
    "radial_clearance": "bearing play",
}
"""What the standard deviation of the backlash may come from."""
NOT_STATED = "not stated"


def spread_text(backlash: Backlash) -> str:
    """``± 12.9 (1σ)``, of what alone where sources are left out, or that no uncertainty is stated."""
    if backlash.std_arcsec is None:
        return f"1σ {NOT_STATED}"
    only = stated_only(backlash.std_by_source_arcsec)
    return f"± {quantity(STD_KEY).text(backlash.std_arcsec)} (1σ{only})"


def stated_only(sources: Collection[str]) -> str:
    """``, Young's modulus only`` where the design file leaves sources out, else "".

    `sources`: those that it states.
    """
    if not sources or set(SOURCES) <= set(sources):
        return ""
    stated = [name for key, name in SOURCES.items() if key in sources]
    return f", {joined(stated, 'and')} only"


def missing(backlash: Backlash) -> tuple[str, ...]:
    """Names of the sources that the design file leaves out."""
    return tuple(name for key, name in SOURCES.items() if key not in backlash.std_by_source_arcsec)


def spread_sentence(backlash: Backlash) -> str:
    """One standard deviation of the sum, and what it leaves out; without a full stop."""
    if backlash.std_arcsec is None:
        return "the design file states no uncertainty, so the sum has no standard deviation"
    std = quantity(STD_KEY).with_unit(backlash.std_arcsec)
    left_out = missing(backlash)
    without = f", with {joined(left_out, 'and')} {NOT_STATED}" if left_out else ""
    return f"one standard deviation of the sum is {std}{without}"


def as_stated(value: float, std: float, unit: str) -> str:
    """As the design file has them, not rounded: ``3 ± 1 µm``; without a standard deviation ``3 µm``."""
    return f"{value:g} ± {std:g} {unit}" if std else f"{value:g} {unit}"
