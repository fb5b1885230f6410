"""The mesh edges of a plan's lines, in the map (ln r, φ), and their bisection."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from flexspline.fea.axisymmetric.ruppert import lengths
from flexspline.fea.solid.plan_curves import Curve, pieces
from flexspline.geometry.above_zero import ABOVE_ZERO

ACUTE = 0.35
"""Share of the shortest line that ends at a crossing. All lines are cut at this distance from the crossing,
so that edges there are equal and halving one does not require halving the next without end."""
ACUTE_COSINE = 0.5
"""Cosine of 60°: below this angle, the halves of two edges lie in each other's circle."""
TANGENT = 1e-3
"""Share of an edge's range over which its direction at an end is computed. Judgement: a nearly straight
piece, far above rounding."""
HALVINGS = 40
"""Halvings of a range by bisection: 1e-12 of it is left."""
MERGED_DISTANCE = 1e-9
"""Points nearer than this in the map are one: rounding."""


def mapped(points: np.ndarray, sector: float) -> np.ndarray:
    """Return (ln r, φ) of points (x, y)."""
    r = np.hypot(points[:, 0], points[:, 1])
    phi = np.arctan2(points[:, 1], points[:, 0])
    phi = np.where(phi < sector / 2 - np.pi, phi + 2 * np.pi, phi)
    return np.column_stack([np.log(r), np.clip(phi, 0.0, sector)])


class PlanEdges:
    """Points in the map, and the lines' edges: two points, the curve, the parameters of both."""

    def __init__(self, curves: Sequence[Curve], sector: float) -> None:
        self.curves, self.sector = curves, sector
        points: list[np.ndarray] = []
        ends, owner, share = [], [], []
        for i, t in pieces(curves):
            first = sum(len(p) for p in points)
            points.append(mapped(curves[i].at(t), sector))
            along = first + np.arange(len(t))
            ends.append(np.column_stack([along[:-1], along[1:]]))
            owner.append(np.full(len(t) - 1, i))
            share.append(np.column_stack([t[:-1], t[1:]]))
        stacked = np.vstack(points)
        self.points, number = _merged(stacked)
        self.ends, self.owner, self.share = (
            number[np.vstack(ends)],
            np.concatenate(owner),
            np.vstack(share),
        )
        self._shorten_at_crossings()

    def lengths(self) -> np.ndarray:
        """Of the edges in the map."""
        return lengths(self.points, self.ends)

    def middles(self) -> np.ndarray:
        """Of the edges' lines (k, 2), in the map."""
        return self._at(self.owner, self.share.mean(axis=1))

    def _at(self, owner: np.ndarray, share: np.ndarray) -> np.ndarray:
        points = np.empty((len(share), 2))
        for i in np.unique(owner):
            mine = owner == i
            points[mine] = mapped(self.curves[i].at(share[mine]), self.sector)
        return points

    def split(self, mask: np.ndarray, at: np.ndarray | float = 0.5) -> None:
        """Cut edges (mask) at this share of their range."""
        if not mask.any():
            return
        share, owner, ends = self.share[mask], self.owner[mask], self.ends[mask]
        middle = share[:, 0] + np.broadcast_to(at, mask.shape)[mask] * (share[:, 1] - share[:, 0])
        points = self._at(owner, middle)
        new = len(self.points) + np.arange(len(middle))
        self.points = np.vstack([self.points, points])
        self.ends = np.vstack(
            [
                self.ends[~mask],
                np.column_stack([ends[:, 0], new]),
                np.column_stack([new, ends[:, 1]]),
            ]
        )
        self.owner = np.concatenate([self.owner[~mask], owner, owner])
        self.share = np.vstack(
            [
                self.share[~mask],
                np.column_stack([share[:, 0], middle]),
                np.column_stack([middle, share[:, 1]]),
            ]
        )

    def _shorten_at_crossings(self) -> None:
        """Makes edges equally long at each vertex where lines meet at less than 60°; first at one end of each
        edge, then at the other."""
        sharp = self._acute()
        if not sharp.any():
            return
        reach = np.full(len(self.points), np.inf)
        length = self.lengths()
        for side in (0, 1):
            np.minimum.at(reach, self.ends[:, side], ACUTE * length)
        for side in (0, 1):
            length = self.lengths()
            node = self.ends[:, side]
            mine = np.flatnonzero((node < len(sharp)) & sharp[np.minimum(node, len(sharp) - 1)])
            wanted = reach[node[mine]]
            # an edge of less than 1.5 times that would leave a piece of less than half of it
            mine, wanted = mine[length[mine] > wanted * 1.5], wanted[length[mine] > wanted * 1.5]
            low, high = np.zeros(len(mine)), np.ones(len(mine))
            for _ in range(HALVINGS):
                middle = (low + high) / 2
                s = self.share[mine]
                t = s[:, 0] + (middle if side == 0 else 1 - middle) * (s[:, 1] - s[:, 0])
                points = self._at(self.owner[mine], t)
                near = np.linalg.norm(points - self.points[self.ends[mine, side]], axis=1) < wanted
                low, high = np.where(near, middle, low), np.where(near, high, middle)
            at = np.full(len(self.ends), 0.5)
            at[mine] = high if side == 0 else 1 - high
            mask = np.zeros(len(self.ends), bool)
            mask[mine] = True
            self.split(mask, at)

    def _acute(self) -> np.ndarray:
        """Mask of points where two edges meet at less than 60°."""
        out = np.zeros(len(self.points), bool)
        eps = TANGENT
        node = np.concatenate([self.ends[:, 0], self.ends[:, 1]])
        directions = np.empty((len(node), 2))
        n = len(self.ends)
        for k, (o, (s, t)) in enumerate(zip(self.owner, self.share, strict=True)):
            c = self.curves[o]
            p = mapped(c.at(np.array([s, s + eps * (t - s), t - eps * (t - s), t])), self.sector)
            directions[k], directions[n + k] = p[1] - p[0], p[2] - p[3]
        directions /= np.maximum(np.linalg.norm(directions, axis=1), ABOVE_ZERO)[:, None]
        order = np.argsort(node, kind="stable")
        starts = np.flatnonzero(np.r_[True, np.diff(node[order]) > 0])
        for group in np.split(order, starts[1:]):
            d = directions[group]
            cosine = d @ d.T - 2 * np.eye(len(d))
            out[node[group[0]]] = cosine.max() > ACUTE_COSINE
        return out


def _merged(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct points, and which of them each is."""
    near = cKDTree(points).query_ball_point(points, MERGED_DISTANCE)
    first = np.array([min(group) for group in near])
    kept, number = np.unique(first, return_inverse=True)
    return points[kept], number
