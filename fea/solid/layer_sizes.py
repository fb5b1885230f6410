"""Volume and patch areas of a shaft with holes and a keyway, by integrals over its cross-sections."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from flexspline.fea.solid.layers import Layers
from flexspline.geometry.outline import SAME_mm

GAUSS_POINTS = 64
"""Gauss's, between radii at which a line begins or ends: square roots there leave 1e-6 of the integral."""


def open_angle(layers: Layers, r: np.ndarray, z: float) -> np.ndarray:
    """Return the angle [rad] that no hole or slot takes from circles of radii `r` (n,) [mm] at z."""
    part, sector = layers.part, layers.sector
    taken: list[tuple[np.ndarray, np.ndarray]] = []
    if part.bolts is not None and z < part.hole_depth:
        rc, rh = part.bolts.radius, part.bolts.hole_radius
        half = np.arccos(np.clip((r**2 + rc**2 - rh**2) / (2 * r * rc), -1, 1))
        for x, y in part.bolts.centres:
            angle = float(np.arctan2(y, x))
            taken.append((angle - half, angle + half))
    slot = part.keyway
    if slot is not None and z > slot.start:
        side = np.arcsin(np.clip(slot.half_width / r, -1, 1))
        floor = np.arccos(np.clip(slot.floor / r, -1, 1))
        half = np.minimum(side, floor)
        taken.append((-half, half))
    return sector - _measure([(np.clip(a, 0, sector), np.clip(b, 0, sector)) for a, b in taken], r)


def _measure(spans: list[tuple[np.ndarray, np.ndarray]], like: np.ndarray) -> np.ndarray:
    """Of the union of intervals, each (n,)."""
    if not spans:
        return np.zeros_like(like)
    low, high = (np.array(side) for side in zip(*spans, strict=True))
    order = low.argsort(axis=0)
    low, high = np.take_along_axis(low, order, 0), np.take_along_axis(high, order, 0)
    reached, total = low[0], np.zeros_like(like)
    for a, b in zip(low, high, strict=True):
        total += np.maximum(0.0, b - np.maximum(a, reached))
        reached = np.maximum(reached, b)
    return total


def _radii(layers: Layers, low: float, high: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Gauss's points and weights between two radii, in pieces in which the open angle is smooth."""
    part = layers.part
    breaks = {low, high}
    if part.bolts is not None:
        rc, rh = part.bolts.radius, part.bolts.hole_radius
        breaks |= {rc - rh, rc + rh}
    if part.keyway is not None:
        breaks |= {part.keyway.floor, float(np.hypot(part.keyway.floor, part.keyway.half_width))}
    x, w = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    for a, b in pairwise(sorted(c for c in breaks if low <= c <= high)):
        yield (a + b) / 2 + (b - a) / 2 * x, (b - a) / 2 * w


def face_area(layers: Layers, bore: float, outer: float, z: float) -> float:
    """Return the area of the cross-section between two radii at height z [mm²]."""
    return sum(
        float((w * r * open_angle(layers, r, z)).sum()) for r, w in _radii(layers, bore, outer)
    )


def volume(layers: Layers) -> float:
    """Return the volume of the sector [mm³]."""
    total = 0.0
    for low, high, bore, outer in layers.tubes:
        for a, b in _heights(layers, low, high):
            total += (b - a) * face_area(layers, bore, outer, (a + b) / 2)
    for f in layers.fillets:
        for a, b in _heights(layers, *f.span):
            for r, w in _radii(layers, f.r, f.far):
                along = np.abs(np.clip(f.height(r), a, b) - np.clip(f.z, a, b))
                total += float((w * r * open_angle(layers, r, (a + b) / 2) * along).sum())
    return total


def wall_area(layers: Layers, r: float, low: float, high: float) -> float:
    """Return the area of a cylinder about the axis between two heights [mm²]."""
    at = np.array([r])
    return sum(
        r * (b - a) * float(open_angle(layers, at, (a + b) / 2)[0])
        for a, b in _heights(layers, low, high)
    )


def _heights(layers: Layers, low: float, high: float) -> Iterator[tuple[float, float]]:
    """A range of z [mm] in pieces in which the open angle is constant."""
    breaks = {low, high}
    if layers.part.bolts is not None:
        breaks.add(layers.part.hole_depth)
    if layers.part.keyway is not None:
        breaks.add(layers.part.keyway.start)
    inside = sorted(z for z in breaks if low <= z <= high)
    return ((a, b) for a, b in pairwise(inside) if b > a + SAME_mm)
