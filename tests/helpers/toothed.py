"""The cup of the examples with its teeth drawn: 200 teeth of module 0.2 at 20° on a rim of 0.55 mm."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design


def toothed(flank: str, changes: Mapping[str, object] = MappingProxyType({})) -> Design:
    """With other values at some dotted keys."""
    drawn = {"flexspline.teeth": "drawn", "flexspline.tooth_flank": flank}
    return load_design(EXAMPLES / "xb1-40.toml").changed({**drawn, **changes})
