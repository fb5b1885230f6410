"""Cylindrical coordinates: the order of displacement components."""

from __future__ import annotations

RADIAL, TANGENTIAL, AXIAL = 0, 1, 2
"""Index of a displacement component at a node."""
