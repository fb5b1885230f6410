"""Lift-off of a flexspline with bolt holes on tetrahedra: the holes drawn, the rim resting on its seat.

Nothing of the program's lift-off is used but the complementarity solver. One repeat of the part, from hole
to hole, is solved for each cyclic wave, u(φ + 2π/N) = exp(2πik/N)·u(φ). Pressure on the seat is spread over
hat functions of its corners, the gap is averaged with the same. With an even number N of holes everything
has period π, so even waves are enough. On two meshes of a part without holes, of sectors of 60° and 360°, K
was the same in nine digits.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi, radians

import numpy as np
from scipy.sparse import bmat, csr_matrix

from flexspline.fea.axisymmetric.lift_off import pushing
from flexspline.fea.axisymmetric.lobes import LOBE_HALF_WIDTH
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.direct import factorised
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.types import NMM_PER_NM, Elastic, TetMesh
from flexspline.geometry.part import Part

STEP = radians(7.5)
"""About the axis at most: a quarter of the lobe's half-width."""
PLACES = ((0.445948490915965, 0.223381589678011), (0.091576213509771, 0.109951743655322))
"""Barycentric coordinate and weight of three quadrature points each, exact to degree 4 (Dunavant 1985)."""


@dataclass(frozen=True)
class Rim:
    """K [N·m/rad] with the seat held, resting, and free."""

    held: float
    resting: float
    free: float

    @property
    def ratio(self) -> float:
        return self.resting / self.held


def rim_in_3d(part: Part, repeats: int, coarser: float) -> Rim:
    """A body of so many equal repeats, its first mesh `coarser` times as coarse."""
    half = swept_mesh(part, 180 / repeats, first_spec(part).scaled(coarser), Finer(STEP, even=True))
    assert half is not None
    assert repeats % 2 == 0
    model = Model.of(unfolded(half, 360 / repeats), Elastic.of(part.material))
    repeat = _Repeat(model, repeats)
    loads, torque = repeat.loads()
    turn, seat = 2 * pi / repeats, repeat.seat()
    area = np.asarray(abs(seat @ repeat.seat_joins(0)).sum(0)).ravel()
    work, works, free, compliance = 0.0, {}, {}, {}
    for k in range(0, repeats, 2):
        if (same := repeats - k) in compliance:  # the wave that goes the other way round
            work += works[same]
            free[k], compliance[k] = free[same].conj(), compliance[same].conj()
            continue
        joins = repeat.joins(k)
        load = joins.conj().T @ sum(
            np.exp(-1j * k * a * turn) * each.ravel() * (NMM_PER_NM / torque)
            for a, each in enumerate(loads)
        )
        push = (joins.conj().T @ (seat @ repeat.seat_joins(k))).toarray() / area
        u = _solved((joins.conj().T @ model.matrix @ joins).tocsr(), np.column_stack([load, push]))
        works[k] = float((load.conj() @ u[:, 0]).real) / repeats
        work += works[k]
        free[k], compliance[k] = push.conj().T @ u[:, 0], push.conj().T @ u[:, 1:]
    own, n = repeats // 2, len(area)  # repeats of a half turn, and places of each
    gap = np.zeros((own, n))
    matrix = np.zeros((own, n, own, n))
    for k in compliance:
        for a in range(own):
            gap[a] += (np.exp(1j * k * a * turn) * free[k]).real / repeats
            for b in range(own):
                part_of_it = (np.exp(1j * k * (a - b) * turn) * compliance[k]).real
                matrix[a, :, b] += part_of_it / own
    whole, u0 = matrix.reshape(own * n, own * n), gap.ravel()
    whole = (whole + whole.T) / 2

    def K(force: np.ndarray) -> float:
        return NMM_PER_NM**2 / (work + 2 * float(force @ u0)) / NMM_PER_NM

    return Rim(K(-np.linalg.solve(whole, u0)), K(pushing(whole, u0)), K(np.zeros_like(u0)))


@dataclass(frozen=True)
class _Repeat:
    """One repeat of the part: nodes of its end are those of its start, turned by a wave's phase."""

    model: Model
    repeats: int

    @property
    def mesh(self) -> TetMesh:
        return self.model.mesh

    def _twins(self) -> tuple[np.ndarray, np.ndarray]:
        def sorted_on(patch: str) -> np.ndarray:
            nodes = self.mesh.nodes_on(patch)
            x, y, z = self.mesh.nodes[nodes].T
            return nodes[np.lexsort((z.round(6), np.hypot(x, y).round(6)))]

        return sorted_on("symmetry_start"), sorted_on("symmetry_end")

    def _phase(self, k: int) -> complex:
        """Of one repeat over the one before; real without rounding where it is."""
        phase = np.exp(2j * pi * k / self.repeats)
        return complex(phase.real, phase.imag if abs(phase.imag) > 1e-12 else 0.0)

    def joins(self, k: int) -> csr_matrix:
        """Components of all nodes (rows) from those that are free."""
        start, end = self._twins()
        n = len(self.mesh.nodes)
        node, phase = np.arange(n), np.ones(n, complex)
        node[end], phase[end] = start, self._phase(k)
        columns = (3 * node[:, None] + np.arange(3)).ravel()
        all_of_it = csr_matrix((np.repeat(phase, 3), (np.arange(3 * n), columns)), (3 * n, 3 * n))
        loose = np.ones((n, 3), bool)
        loose[end] = loose[self.model.on("mount")] = False
        return all_of_it[:, np.flatnonzero(loose.ravel())]

    def seat_joins(self, k: int) -> csr_matrix:
        """The same of the hats on the seat; all nodes of the mesh are numbered, corners have hats."""
        start, end = self._twins()
        n = len(self.mesh.nodes)
        node, phase = np.arange(n), np.ones(n, complex)
        node[end], phase[end] = start, self._phase(k)
        corners = np.setdiff1d(np.unique(self.mesh.on("seat")[:, :3]), end)
        return csr_matrix((phase, (np.arange(n), node)), (n, n))[:, corners]

    def seat(self) -> csr_matrix:
        """Radial forces on all nodes of a unit pressure under each corner's hat."""
        n = len(self.mesh.nodes)
        found = csr_matrix((3 * n, n))
        for facets, bary, shape, _, area in _quadrature(self.mesh, "seat"):
            for corner in range(3):
                for own in range(6):
                    where = (3 * facets[:, own] + RADIAL, facets[:, corner])
                    found += csr_matrix((bary[corner] * shape[own] * area, where), found.shape)
        return found

    def loads(self) -> tuple[np.ndarray, float]:
        """Forces (N, n, 3) of a unit lobe traction on every repeat, and the torque of all."""
        found, torque = np.zeros((self.repeats, len(self.mesh.nodes), 3)), 0.0
        for facets, _, shape, at, area in _quadrature(self.mesh, "mesh"):
            for a in range(self.repeats):
                phi = np.arctan2(at[:, 1], at[:, 0]) + 2 * pi * a / self.repeats
                off = np.abs((phi + pi / 2) % pi - pi / 2)
                inside = off < LOBE_HALF_WIDTH
                pull = np.where(inside, np.cos(pi * off / (2 * LOBE_HALF_WIDTH)) ** 2, 0) * area
                torque += float((pull * np.hypot(at[:, 0], at[:, 1])).sum())
                for own in range(6):
                    np.add.at(found[a, :, TANGENTIAL], facets[:, own], pull * shape[own])
        return found, torque


def _quadrature(mesh: TetMesh, patch: str) -> Iterator[tuple[np.ndarray, ...]]:
    """Facets (f, 6), and of one point on each: barycentric (3,), shapes (6,), place (f, 3), area (f,)."""
    facets = mesh.on(patch)
    for a, weight in PLACES:
        for i in range(3):
            bary = np.full(3, a)
            bary[i] = 1 - 2 * a
            p, q, s = bary
            corner = bary * (2 * bary - 1)
            shape = np.array([*corner, 4 * p * q, 4 * q * s, 4 * s * p])
            by_p = np.array([4 * p - 1, 0, 0, 4 * q, 0, 4 * s])
            by_q = np.array([0, 4 * q - 1, 0, 4 * p, 4 * s, 0])
            by_s = np.array([0, 0, 4 * s - 1, 0, 4 * q, 4 * p])
            along = [
                np.einsum("a,fac->fc", by, mesh.nodes[facets]) for by in (by_q - by_p, by_s - by_p)
            ]
            area = weight / 2 * np.linalg.norm(np.cross(*along), axis=1)
            yield facets, bary, shape, np.einsum("a,fac->fc", shape, mesh.nodes[facets]), area


def _solved(matrix: csr_matrix, right: np.ndarray) -> np.ndarray:
    """Real, or complex and Hermitian as a real symmetric system of twice the size."""
    n = len(right)
    if not matrix.imag.data.any() and not right.imag.any():
        with factorised(matrix.real.tocsr()) as solve:
            return np.column_stack([solve(column.copy()) for column in right.real.T]) + 0j
    twice = bmat([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]]).tocsr()
    found = np.empty_like(right)
    with factorised(twice) as solve:
        for i, column in enumerate(right.T):
            u = solve(np.concatenate([column.real, column.imag]))
            found[:, i] = u[:n] + 1j * u[n:]
    return found
