"""Points as (r, φ, z) and as (x, y, z), both (n, 3); r and z in mm, φ in rad from -π/2 to 3π/2."""

from __future__ import annotations

import numpy as np


def polar(points: np.ndarray) -> np.ndarray:
    """Return (r, φ, z) of points (x, y, z)."""
    x, y, z = points.T
    phi = np.arctan2(y, x)
    return np.column_stack([np.hypot(x, y), np.where(phi < -np.pi / 2, phi + 2 * np.pi, phi), z])


def cartesian(points: np.ndarray) -> np.ndarray:
    """Return (x, y, z) of points (r, φ, z)."""
    r, phi, z = points.T
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), z])


def middles(ends: np.ndarray) -> np.ndarray:
    """Return the middles (e, 3) of edges (e, 2, 3) as (r, φ, z); an end on the axis has the other's angle."""
    off_axis = ends[:, :, 0] > 0
    middle = ends.mean(axis=1)
    middle[:, 1] = (ends[:, :, 1] * off_axis).sum(axis=1) / np.maximum(1, off_axis.sum(axis=1))
    return np.asarray(middle)
