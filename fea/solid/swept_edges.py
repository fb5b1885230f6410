"""Sharp edges and patch edges of a swept part, as points."""

from __future__ import annotations

from math import ceil, radians

import numpy as np

from flexspline.fea.solid.column import column_of
from flexspline.fea.solid.layered import layered_edges
from flexspline.fea.solid.polar import cartesian
from flexspline.fea.solid.prisms import mirrored
from flexspline.fea.solid.sweeps import bent_block, goes_about_axis, half_holes
from flexspline.geometry.part import Part


def swept_edges(part: Part, sector_deg: float, spacing: float) -> np.ndarray:
    """Return points (k, 3) every `spacing` mm along the sharp edges and patch edges of a swept part.

    The circles of the meridian's corners and the rims of the holes, as `TaggedSurface.sharp_edges`.
    """
    if not goes_about_axis(part):
        return layered_edges(part, sector_deg, spacing)
    outline, column = part.meridian, column_of(part)
    block = bent_block(part, column)
    sector = radians(sector_deg)
    lines = []
    for r, z in {*outline.sharp_corners, *outline.patch_edges}:
        phi = np.linspace(0, sector, max(2, ceil(r * sector / spacing) + 1))
        lines.append(cartesian(np.column_stack([np.full_like(phi, r), phi, np.full_like(phi, z)])))
    if column is not None:
        rim = max(2, ceil(np.pi * column.hole_radius / spacing) + 1)
        turn = np.linspace(0, np.pi, rim)
        x = column.bolt_circle + column.hole_radius * np.cos(turn)
        y = column.hole_radius * np.sin(turn)
        away, turned = np.hypot(x, y), np.arctan2(y, x)
        copies = half_holes(part, sector_deg)
        wedge = sector / copies
        for k in range(copies):
            around = mirrored(turned, wedge, k)
            for z in (column.low, column.depth):
                lines.append(cartesian(np.column_stack([away, around, np.full_like(away, z)])))
    points = np.vstack(lines)
    if block is None:
        return points
    return np.vstack([points[~block.cuts(points)], block.rims(spacing)])
