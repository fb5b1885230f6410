"""A shaft of any segments, on the example cup without holes."""

from __future__ import annotations

import tomllib

from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design


def shaft_of(
    segments: list[tuple[float, float, float]], settings: str = "", fillet: float = 0.5
) -> Design:
    """A shaft of (length, outer, inner) segments gripped over 5 mm; `settings`: further keys, as TOML."""
    shaft = {"fillet_mm": fillet, "grip_length_mm": 5.0} | tomllib.loads(settings)
    shaft["segment"] = [
        {"length_mm": length, "outer_diameter_mm": outer, "inner_diameter_mm": inner}
        for length, outer, inner in segments
    ]
    return load_design(EXAMPLES / "keyed-shaft.toml").changed({"shaft": shaft})
