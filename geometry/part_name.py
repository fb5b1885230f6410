"""The parts of a gear by name."""

from __future__ import annotations

from typing import Literal, get_args

PartName = Literal["flexspline", "shaft"]
PART_NAMES: tuple[PartName, ...] = get_args(PartName)
"""In the order of the design file."""
