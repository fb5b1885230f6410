"""The cup of the examples with its teeth drawn: 200 teeth of module 0.2 at 20° on a rim of 0.55 mm."""

from __future__ import annotations

import tomllib

from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from

CUP = EXAMPLES / "xb1-40.toml"


def toothed(flank: str, **changes: float) -> Design:
    """Loaded and checked; ``gear__module_mm=2.0`` sets a key of the design file."""
    data = tomllib.loads(CUP.read_text(encoding="utf-8"))
    data["flexspline"] |= {"teeth": "drawn", "tooth_flank": flank}
    for dotted, value in changes.items():
        table, key = dotted.split("__")
        data[table][key] = value
    return design_from(data)
