"""What the page takes from the program: kinds of parts, names of views, colours of charts and stress."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from flexspline.geometry.shapes import KINDS
from flexspline.pipeline.stress_limits import StressCase
from flexspline.results.style import ACCENT, INK, PALETTE, STEEL, colour_scale

VIEW_TITLES: Mapping[StressCase, str] = {
    "wave_generator": "On the wave generator",
    "flexspline_torque": "Flexspline under torque",
    "shaft_torque": "Shaft under torque",
}


@cache
def page_style() -> dict[str, Any]:
    """Kinds; views by name, in order; colours as hex; the stress scale as 256 colours of three bytes each."""
    return {
        "kinds": list(KINDS),
        "views": dict(VIEW_TITLES),
        "palette": list(PALETTE),
        "accent": ACCENT,
        "ink": INK,
        "steel": STEEL,
        "scale": colour_scale(),
    }
