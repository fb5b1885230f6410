"""The sparse stiffness of any harmonic from sums that are assembled once.

Every block of it is a combination of the nine sums ∫ f_i g_j r dA over f, g ∈ {∂N/∂r, ∂N/∂z, N/r}, so a
harmonic costs some additions and one rearrangement of numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix

from flexspline.fea.axisymmetric.points import VALUE, Term
from flexspline.fea.axisymmetric.space import Space
from flexspline.fea.types import Elastic

RADIAL, TANGENTIAL, AXIAL = 0, 1, 2


@dataclass(frozen=True)
class Pattern:
    """Which nodes meet, by columns, and where triangles' entries are added.

    Attributes
    ----------
    rows, columns : (e,) the entries' nodes, column by column, rows rising.
    place : (m·36,) the entry of each pair of a triangle's nodes.
    twin : (e,) the entry on the other side of the diagonal.
    """

    rows: np.ndarray
    columns: np.ndarray
    place: np.ndarray
    twin: np.ndarray

    def summed(self, matrices: np.ndarray) -> np.ndarray:
        """Entries (e,) from element matrices (m, 36)."""
        return np.bincount(self.place, matrices.ravel(), len(self.rows))


def pattern_of(dofs: np.ndarray, count: int) -> Pattern:
    """Of triangles' numbers (m, 6) below `count`."""
    keys = (dofs[:, None, :] * count + dofs[:, :, None]).ravel()
    order = np.argsort(keys)
    risen = keys[order]
    new = np.concatenate([[True], risen[1:] != risen[:-1]])
    place = np.empty(len(keys), int)
    place[order] = np.cumsum(new) - 1
    twin = np.empty(int(new.sum()), int)
    twin[place] = place.reshape(-1, 6, 6).transpose(0, 2, 1).ravel()
    columns, rows = (x.astype(np.int32) for x in np.divmod(risen[new], count))
    return Pattern(rows, columns, place, twin)


@dataclass(frozen=True)
class Layout:
    """How blocks become one sparse matrix in which a node's components stand side by side.

    Attributes
    ----------
    take : (k,) index into the blocks (components, components, e) of each entry of the matrix.
    rows, columns : (k,) its unknowns, 3·node + component.
    first : (3·count + 1,) where each column begins.
    """

    take: np.ndarray
    rows: np.ndarray
    columns: np.ndarray
    first: np.ndarray

    def among(self, free: np.ndarray) -> Layout:
        """Of free unknowns (mask) only, numbered anew."""
        kept = np.flatnonzero(free[self.rows] & free[self.columns])
        number = (np.cumsum(free) - 1).astype(np.int32)
        columns = number[self.columns[kept]]
        first = _starts(columns, int(free.sum()))
        return Layout(self.take[kept], number[self.rows[kept]], columns, first)

    def matrix(self, blocks: np.ndarray) -> csc_matrix:
        """The matrix of some blocks."""
        shape = 2 * (len(self.first) - 1,)
        return csc_matrix((blocks.ravel()[self.take], self.rows, self.first), shape=shape)


def layout_of(pattern: Pattern, components: tuple[int, ...], count: int) -> Layout:
    """Of the entries between some components of `count` nodes."""
    c, e = len(components), len(pattern.rows)
    starts = _starts(pattern.columns, count)
    first, per_column = starts[pattern.columns], np.diff(starts)[pattern.columns]
    entry, of = np.arange(e, dtype=np.int32), np.arange(c, dtype=np.int32)
    # entry (i, a; j, b) comes after c² entries for each one before column j, then by b, i, a
    within = c * per_column[:, None] * of + (c * (entry - first))[:, None]
    position = (c * c * first)[:, None, None] + within[..., None] + of
    take, rows, columns = (np.empty(e * c * c, np.int32) for _ in range(3))
    names = np.array(components, np.int32)
    take[position] = entry[:, None, None] + e * (c * of + of[:, None])
    rows[position] = 3 * pattern.rows[:, None, None] + names
    columns[position] = 3 * pattern.columns[:, None, None] + names[:, None]
    return Layout(take, rows, columns, _starts(columns, 3 * count))


def _starts(columns: np.ndarray, count: int) -> np.ndarray:
    """Where each of `count` columns begins among entries ordered by column, and the end."""
    per_column = np.bincount(columns, minlength=count)
    return np.concatenate([[0], np.cumsum(per_column)]).astype(np.int32)


@dataclass(frozen=True)
class Couplings:
    """The sums over a space, and the blocks of any harmonic's stiffness from them."""

    space: Space
    material: Elastic

    @cached_property
    def pattern(self) -> Pattern:
        """Of the space's nodes."""
        return pattern_of(self.space.dofs, self.space.count)

    def blocks(self, n: int, components: tuple[int, ...]) -> np.ndarray:
        """Entries (c, c, e) between components of harmonic n, per ∫cos² nφ dφ."""
        made = self._torsion(n) if components == (TANGENTIAL,) else self._all(n)
        twin = self.pattern.twin
        return np.array(
            [
                [made[a, b] if (a, b) in made else made[b, a][twin] for b in components]
                for a in components
            ]
        )

    def _torsion(self, n: int) -> dict[tuple[int, int], np.ndarray]:
        lam, mu = self.material.lam, self.material.mu
        return {
            (TANGENTIAL, TANGENTIAL): n * n * (lam + 2 * mu) * self._oo
            + mu * (self._rr - self._ro - self._or + self._oo + self._zz)
        }

    def _all(self, n: int) -> dict[tuple[int, int], np.ndarray]:
        lam, mu = self.material.lam, self.material.mu
        both = lam + 2 * mu
        rr, rz, ro, zz, zo, oo = self._rr, self._rz, self._ro, self._zz, self._zo, self._oo
        zr, o_r, oz = (x[self.pattern.twin] for x in (rz, ro, zo))
        return {
            (RADIAL, RADIAL): both * (rr + oo) + lam * (ro + o_r) + mu * (zz + n * n * oo),
            (AXIAL, AXIAL): both * zz + mu * (rr + n * n * oo),
            (RADIAL, AXIAL): lam * (rz + oz) + mu * zr,
            (RADIAL, TANGENTIAL): n * (lam * ro + both * oo - mu * (o_r - oo)),
            (TANGENTIAL, AXIAL): n * (lam * oz - mu * zo),
            **self._torsion(n),
        }

    def _sum(self, first: tuple[Term, ...], second: tuple[Term, ...]) -> np.ndarray:
        s = self.space
        return self.pattern.summed(s.points.integral(s.weights * s.r, first, second))

    @cached_property
    def _r(self) -> tuple[Term, ...]:
        return self.space.points.derivative(0)

    @cached_property
    def _z(self) -> tuple[Term, ...]:
        return self.space.points.derivative(1)

    @cached_property
    def _o(self) -> tuple[Term, ...]:
        return ((VALUE, 1 / self.space.r),)

    @cached_property
    def _rr(self) -> np.ndarray:
        return self._sum(self._r, self._r)

    @cached_property
    def _rz(self) -> np.ndarray:
        return self._sum(self._r, self._z)

    @cached_property
    def _ro(self) -> np.ndarray:
        return self._sum(self._r, self._o)

    @cached_property
    def _or(self) -> np.ndarray:
        return self._ro[self.pattern.twin]

    @cached_property
    def _zz(self) -> np.ndarray:
        return self._sum(self._z, self._z)

    @cached_property
    def _zo(self) -> np.ndarray:
        return self._sum(self._z, self._o)

    @cached_property
    def _oo(self) -> np.ndarray:
        return self._sum(self._o, self._o)
