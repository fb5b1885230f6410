"""Names of the parts of a gear."""

from __future__ import annotations

from typing import Literal, get_args

PartName = Literal["flexspline", "shaft"]
PART_NAMES: tuple[PartName, ...] = get_args(PartName)
"""In the order of the design file."""
