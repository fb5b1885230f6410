"""A shaft as layers along the axis, each with one cross-section; all prisms use one common plan.

The plan has every line of every cross-section as mesh edges; a layer keeps the prisms inside its own. A
fillet is a layer whose height follows the arc.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, sqrt

import numpy as np

from flexspline.fea.solid.fillets import Fillet, fillets_of
from flexspline.fea.solid.plan import PlanMesh, triangulated
from flexspline.fea.solid.plan_curves import Arc, Curve, Line, hole_arcs
from flexspline.geometry.outline import SAME_mm, distinct
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Shaft

RING_STEP = np.radians(20)
"""Largest edge about the axis: parabolas of 20° lose 2e-5 of a circle's area."""
LAYER_CORE = 0.4
"""Share of the smallest radius of a line. Inside it, a plan that reaches the axis is a fan of triangles."""
LAYERS_PER_FAR = 1.15
"""Largest edge over the height of a layer, at least. Tetrahedra of higher layers would be cut into eight. On
six shafts, layers twice as high gave 1.0 to 2.4 times as many elements."""


@dataclass(frozen=True)
class Layers:
    """The plan's lines and the levels of a shaft's sector.

    `tubes`: z range, bore and outer radius of every segment [mm].
    """

    part: Part
    sector: float
    tubes: tuple[tuple[float, float, float, float], ...]
    fillets: tuple[Fillet, ...]

    @classmethod
    def of(cls, part: Part, sector_rad: float) -> Layers:
        """Find the layers of a shaft's sector."""
        assert isinstance(part.shape, Shaft)
        tubes, z = [], 0.0
        for i, s in enumerate(part.shape.segment):
            top = part.length if i == len(part.shape.segment) - 1 else z + s.length_mm
            tubes.append((z, top, s.inner_diameter_mm / 2, s.outer_diameter_mm / 2))
            z = top
        return cls(part, sector_rad, tuple(tubes), tuple(fillets_of(part.shape)))

    @property
    def radii(self) -> list[float]:
        """Radii of all rings [mm], rising; the first is the bore's, or the core's."""
        all_radii = {r for *_, bore, outer in self.tubes for r in (bore, outer)}
        all_radii |= {r for f in self.fillets for r in (f.middle, f.far)}
        rising = distinct(all_radii)
        if rising[0] > 0:
            return rising
        least = rising[1]
        if self.part.bolts is not None:
            least = min(least, self.part.bolts.radius - self.part.bolts.hole_radius)
        if self.part.keyway is not None:
            least = min(least, self.part.keyway.floor)
        return [LAYER_CORE * least, *rising[1:]]

    @property
    def solid(self) -> bool:
        """Whether material reaches the axis somewhere."""
        return any(bore == 0 for *_, bore, _ in self.tubes)

    def levels(self, far: float) -> list[float]:
        """Return z [mm] of all cross-sections' ends, and levels between them as close as `far` asks."""
        grip = self.part.shape.grip_length_mm if isinstance(self.part.shape, Shaft) else 0.0
        ends = {0.0, self.part.hole_depth, self.part.length - grip, *(t[1] for t in self.tubes)}
        ends |= {z for f in self.fillets for z in f.span}
        if self.part.keyway is not None:
            ends.add(self.part.keyway.start)
        levels = [0.0]
        whole = {f.span for f in self.fillets}
        for a, b in pairwise(distinct(ends)):
            arc = any(low < b - SAME_mm and a + SAME_mm < high for low, high in whole)
            count = 1 if arc else ceil(LAYERS_PER_FAR * (b - a) / far)
            levels += [a + (b - a) * k / count for k in range(1, count)] + [b]
        return levels

    def curves(self) -> list[Curve]:
        """Lines of the plan."""
        radii, sector = self.radii, self.sector
        ends = [(radii[0], radii[-1], a) for a in (0.0, sector)]
        curves: list[Curve] = [
            Line((a * np.cos(t), a * np.sin(t)), (b * np.cos(t), b * np.sin(t))) for a, b, t in ends
        ]
        curves += [Arc((0.0, 0.0), r, 0.0, sector, RING_STEP / sector) for r in radii]
        if self.part.bolts is not None:
            curves += hole_arcs(self.part.bolts, sector)
        slot = self.part.keyway
        if slot is not None:
            outer = max(o for _, top, _, o in self.tubes if top > slot.start + SAME_mm)
            half, floor = slot.half_width, slot.floor
            curves.append(Line((floor, 0.0), (floor, half)))
            curves.append(Line((floor, half), (sqrt(outer**2 - half**2), half)))
        return curves

    def plan(self, smallest_mm: float) -> PlanMesh:
        """Return the plan's triangles, with a fan about the axis where material reaches it.

        Raises
        ------
        MeshingError
        """
        made = triangulated(self.curves(), self.sector, smallest_mm)
        if not self.solid:
            return made
        rim = np.flatnonzero(made.points[:, 0] < self.radii[0] + SAME_mm)
        rim = rim[np.argsort(made.points[rim, 1])]
        axis = np.full(len(rim) - 1, len(made.points))
        fan = np.column_stack([axis, rim[:-1], rim[1:]])
        # φ of a point on the axis is any
        return PlanMesh(np.vstack([made.points, (0.0, 0.0)]), np.vstack([made.triangles, fan]))

    def within(self, plan: PlanMesh, low: float, high: float) -> np.ndarray:
        """Return the mask (m,) of the plan's triangles in the layer from `low` to `high` [mm].

        Corners' mean coordinates decide: a triangle of a line's chord and a point beyond lies beyond.
        """
        corner = plan.points[plan.triangles]
        r, z = corner[:, :, 0].mean(axis=1), (low + high) / 2
        _, _, bore, outer = next(t for t in self.tubes if z < t[1])
        for f in self.fillets:
            if f.span[0] < z < f.span[1]:
                outer = f.far
        x = corner[:, :, 0] * np.cos(corner[:, :, 1])
        y = corner[:, :, 0] * np.sin(corner[:, :, 1])
        inside = (r > bore) & (r < outer)
        bolts, slot = self.part.bolts, self.part.keyway
        if bolts is not None and z < self.part.hole_depth:
            for a, b in bolts.centres:
                away = np.hypot(x - a, y - b).mean(axis=1)
                inside &= away > bolts.hole_radius + SAME_mm
        if slot is not None and z > slot.start:
            inside &= (x.mean(axis=1) < slot.floor) | (y.mean(axis=1) > slot.half_width)
        return inside

    def prisms(self, smallest_mm: float, far: float) -> tuple[np.ndarray, np.ndarray]:
        """Return nodes (n, 3) as (r, φ, z) and prisms (m, 6); nodes within are still in the fillets' corners.

        Raises
        ------
        MeshingError
        """
        plan, z = self.plan(smallest_mm), np.array(self.levels(far))
        n, k = len(plan.points), len(z)
        number = np.arange(n * k).reshape(n, k)
        nodes = [np.column_stack([np.repeat(plan.points, k, axis=0), np.tile(z, n)])]
        prisms, count = [], n * k
        for j in range(k - 1):
            kept = plan.triangles[self.within(plan, z[j], z[j + 1])]
            low, high = number[:, j].copy(), number[:, j + 1].copy()
            for f in self.fillets:
                if f.span[0] - SAME_mm < z[j] < f.span[1] - SAME_mm:
                    on = np.flatnonzero(
                        (plan.points[:, 0] > f.r + SAME_mm) & (plan.points[:, 0] < f.far + SAME_mm)
                    )
                    arc, foot = (high, low) if f.up > 0 else (low, high)
                    end = plan.points[on, 0] > f.far - SAME_mm
                    arc[on] = np.where(end, foot[on], count + np.arange(len(on)))
                    r = plan.points[on, 0]
                    nodes.append(np.column_stack([plan.points[on], f.height(r)]))
                    count += len(on)
            prisms.append(np.hstack([low[kept], high[kept]]))
        return np.vstack(nodes), np.vstack(prisms)
