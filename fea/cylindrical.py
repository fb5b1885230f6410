"""Cylindrical coordinates: where the components of a displacement stand."""

from __future__ import annotations

RADIAL, TANGENTIAL, AXIAL = 0, 1, 2
"""Index of a displacement component at a node."""
