"""Quadratic bricks (C3D20) of bodies of revolution over half a turn, for solve.py.

A part is made of blocks of its meridian, each with so many bricks along r and z; angles in rad from the wave
generator's major axis, from −π/2 to π/2. Node numbers begin at 0 here and at 1 in the deck.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

INSIDE, OUTSIDE = "S3", "S5"
"""CalculiX' names of a brick's faces towards the axis and away from it."""


@dataclass(frozen=True)
class Block:
    """Corners (4, 2): r, z [mm] of inner low, inner high, outer high, outer low; bricks along r and z."""

    name: str
    corners: tuple[tuple[float, float], ...]
    across: int
    along: int

    def at(self, u: float, v: float) -> tuple[float, float]:
        """r, z at shares u of the way outwards and v of the way up."""
        a, b, c, d = np.array(self.corners)
        r, z = (1 - u) * ((1 - v) * a + v * b) + u * ((1 - v) * d + v * c)
        return round(float(r), 9), round(float(z), 9)


class Part:
    """Bricks of a body of revolution.

    `xyz` (n, 3) mm, `polar` (n, 3) r, φ, z; `cells` (m, 20) in CalculiX' order; `around` bricks in half a
    turn; `plane` (n,) of the 2·around + 1 in which corners and middles lie.
    """

    def __init__(self, blocks: list[Block], around: int):
        self.around = around
        self._numbers: dict[tuple[float, float, int], int] = {}
        self._cells: list[list[int]] = []
        self.faces: dict[tuple[str, str], list[tuple[int, str, list[int]]]] = {}
        for block in blocks:
            self._fill(block)
        keys = np.array(list(self._numbers))
        angle = np.pi * (keys[:, 2] / (2 * around) - 0.5)
        self.polar = np.column_stack([keys[:, 0], angle, keys[:, 1]])
        self.plane = keys[:, 2].astype(int)
        self.xyz = np.column_stack(
            [keys[:, 0] * np.cos(angle), keys[:, 0] * np.sin(angle), keys[:, 1]]
        )
        self.cells = np.array(self._cells)

    def _number(self, place: tuple[float, float], plane: int) -> int:
        return self._numbers.setdefault((*place, plane), len(self._numbers))

    def _fill(self, block: Block) -> None:
        for plane in range(0, 2 * self.around, 2):
            for i in range(block.across):
                for j in range(block.along):
                    # clockwise in (r, z), so that the next plane lies on the right side
                    corner = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
                    middle = [(i, j + 0.5), (i + 0.5, j + 1), (i + 1, j + 0.5), (i + 0.5, j)]
                    c, m = ([block.at(a / block.across, b / block.along) for a, b in part]
                            for part in (corner, middle))  # fmt: skip
                    cell = [self._number(p, plane) for p in c] + [
                        self._number(p, plane + 2) for p in c
                    ]
                    cell += [self._number(p, plane) for p in m] + [
                        self._number(p, plane + 2) for p in m
                    ]
                    cell += [self._number(p, plane + 1) for p in c]
                    self._cells.append(cell)
                    sides = []
                    if i == 0:
                        sides.append((INSIDE, (0, 1)))
                    if i == block.across - 1:
                        sides.append((OUTSIDE, (3, 2)))
                    for side, (low, high) in sides:
                        half = 8 if side == INSIDE else 10
                        face = [cell[low], cell[high], cell[4 + high], cell[4 + low], cell[half],
                                cell[16 + high], cell[half + 4], cell[16 + low]]  # fmt: skip
                        held = self.faces.setdefault((block.name, side), [])
                        held.append((len(self._cells) - 1, side, face))

    def weights(
        self, block: str, side: str, angle: float, low: float, high: float
    ) -> dict[int, float]:
        """Mean over z from low to high [mm] at an angle [rad]: what each node's displacement counts."""
        found: dict[int, float] = {}
        for _, _, face in self.faces[block, side]:
            begin, end = self.polar[face[0], 1], self.polar[face[2], 1]
            bottom, top = self.polar[face[0], 2], self.polar[face[1], 2]
            if not begin <= angle < end or min(top, high) <= max(bottom, low):
                continue
            xi = 2 * (angle - begin) / (end - begin) - 1
            x, w = np.polynomial.legendre.leggauss(3)
            a, b = max(bottom, low), min(top, high)
            for z, weight in zip(
                (a + b) / 2 + x * (b - a) / 2, w * (b - a) / 2 / (high - low), strict=True
            ):
                shape = serendipity(xi, 2 * (z - bottom) / (top - bottom) - 1)
                for node, value in zip(face, shape, strict=True):
                    found[node] = found.get(node, 0.0) + weight * value
        return found


def serendipity(x: float, y: float) -> np.ndarray:
    """The eight shape functions of a face, x round the axis, y up: corners, then middles."""
    corners = [(-1, -1), (-1, 1), (1, 1), (1, -1)]
    four = [(1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4 for a, b in corners]
    return np.array([*four, (1 - x) * (1 - y * y) / 2, (1 - x * x) * (1 + y) / 2,
                     (1 + x) * (1 - y * y) / 2, (1 - x * x) * (1 - y) / 2])  # fmt: skip


def cup(f, fine: int) -> list[Block]:
    """Of a cup without fillets, its ring at the rim; `fine` 1, 2, …: bricks are so many times smaller."""
    bore, boss = f.bore_diameter_mm / 2, f.boss_diameter_mm / 2
    inner, wall, ring = f.inner_radius, f.wall_radius, f.ring_radius
    floor, land, shoulder = f.diaphragm_thickness_mm, f.boss_thickness_mm, f.shoulder_start

    def straight(
        name: str, r0: float, r1: float, z0: float, z1: float, across: int, along: int
    ) -> Block:
        return Block(name, ((r0, z0), (r0, z1), (r1, z1), (r1, z0)), across, along)

    t = fine
    slope = ((inner, shoulder), (inner, f.ring_start), (ring, f.ring_start), (wall, shoulder))
    return [
        straight("land", bore, boss, 0, floor, 2 * fine, t),
        straight("boss", bore, boss, floor, land, 2 * fine, fine),
        straight("floor", boss, inner, 0, floor, 6 * fine, t),
        straight("corner", inner, wall, 0, floor, t, t),
        straight("tube", inner, wall, floor, shoulder, t, 8 * fine),
        Block("shoulder", slope, t, 1),
        straight("ring", inner, ring, f.ring_start, f.ring_end, t, 6 * fine),
    ]


def hoop(f, thickness: float, fine: int) -> list[Block]:
    """A ring inside the seat, as wide."""
    low, high, inner = f.ring_start, f.ring_end, f.inner_radius
    corners = ((inner - thickness, low), (inner - thickness, high), (inner, high), (inner, low))
    return [Block("hoop", corners, fine, 6 * fine)]
