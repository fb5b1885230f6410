"""A peak stress in words: whether it is valid for the part, and its comparison with a limit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexspline.fea.types import StressPeak
from flexspline.geometry.material import Material
from flexspline.pipeline.stress_limits import share_of_limit
from flexspline.results.numbers import grouped
from flexspline.results.quantities import quantity

BORDER = "at excluded border"
"""The mark, where there is room for no more."""
MEANING = (
    "the stress still rises towards this edge, so the value depends on the excluded distance and is not a "
    "measure of the part's strength"
)


def border_note(exclusion_mm: float, twice_MPa: float | None) -> str:
    """The mark, the distance left out, and what the peak is at twice of it."""
    text = f"{BORDER}, {exclusion_mm:.3g} mm from an edge"
    if twice_MPa is None:
        return text
    twice = quantity("torque_peak_mises_MPa").with_unit(twice_MPa)
    return f"{text} ({twice} at {2 * exclusion_mm:.3g} mm)"


def marked(figures: Mapping[str, Any], key: str) -> str:
    """The note of a figure of result.json; "" for all but peaks that are not the part's alone."""
    name = key.removesuffix("_mises_MPa")
    if name == key or not figures.get(f"{name}_at_excluded_border"):
        return ""
    twice = figures.get(f"{name}_mises_at_twice_excluded_MPa")
    return border_note(figures[f"{name}_excluded_mm"], twice)


def limit_note(peak: StressPeak, material: Material) -> str:
    """The peak beside the stated fatigue limit, or why it does not stand there."""
    limit = material.fatigue_limit_MPa
    if limit is None:
        return "no fatigue limit stated"
    share = share_of_limit(peak, material)
    if share is None:
        return f"not compared with the fatigue limit of {limit:g} MPa"
    return (
        f"{grouped(100 * share, 0 if share >= 0.1 else 2)} % of the fatigue limit of {limit:g} MPa"
    )
