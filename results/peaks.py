"""A peak stress in words: whether it is valid for the part, and its comparison with a limit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexspline.fea.types import StressPeak
from flexspline.geometry.material import Material
from flexspline.pipeline.stress_limits import ON_HALF_SEAT, TabledPeak, share_of_limit
from flexspline.results.numbers import grouped
from flexspline.results.quantities import quantity

BORDER = "at excluded border"
"""The mark, where there is room for no more."""
AT_BORDER = "_at_excluded_border"
"""End of the key of a peak's mark, after the peak's name."""
HALF_SEAT = f"{ON_HALF_SEAT}_mises_MPa"
WITHOUT_HOLES = "wave_generator_peak_without_holes_mises_MPa"
"""Of result.json: the peak on the whole seat with which that on half of it is compared."""
MEANING = (
    "the stress still rises towards this edge, so the value depends on the excluded distance and is not a "
    "measure of the part's strength"
)


def border_note(exclusion_mm: float, twice_MPa: float | None) -> str:
    """The mark, the distance left out, and what the peak is at twice of it."""
    far = f"{exclusion_mm:.3g} mm from an edge"
    if twice_MPa is not None:
        twice = quantity("torque_peak_mises_MPa").with_unit(twice_MPa)
        far += f"; {twice} at {2 * exclusion_mm:.3g} mm"
    return f"{BORDER} ({far})"


def at_border(key: str, figures: Mapping[str, Any]) -> bool:
    """Whether a figure of result.json, or of a study's row, is a peak at the border of what is left out."""
    return bool(figures.get(f"{key.removesuffix('_mises_MPa')}{AT_BORDER}"))


def tabled_peak(name: str, figures: Mapping[str, Any]) -> TabledPeak:
    """A peak of result.json, or of a study's row, by its name there."""
    key = f"{name}_mises_MPa"
    return TabledPeak(figures[key], at_border(key, figures), figures.get(f"{name}_excluded_mm"))


def marked(figures: Mapping[str, Any], key: str) -> str:
    """The note of a figure of result.json; "" for all but peaks that are not the part's alone."""
    if not at_border(key, figures):
        return ""
    name = key.removesuffix("_mises_MPa")
    twice = figures.get(f"{name}_mises_at_twice_excluded_MPa")
    return border_note(figures[f"{name}_excluded_mm"], twice)


def half_seat_words(
    half_MPa: float, at_border: bool, without_holes_MPa: float | None, between: str = "with"
) -> str:
    """The peak on a seat half as wide, and that without bolt holes where the part's has them."""
    unit = quantity(HALF_SEAT)
    text = f"{unit.with_unit(half_MPa)} {between} a seat half as wide"
    if at_border:
        text += f" ({BORDER})"
    if without_holes_MPa is None:
        return text
    return f"without bolt holes {unit.with_unit(without_holes_MPa)}, and {text}"


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
