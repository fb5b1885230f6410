"""The sparse stiffness of any harmonic, from weak forms that are assembled once.

Every block of it is a combination of the nine forms ∫ f(v) g(u) r dA over f, g ∈ {∂/∂r, ∂/∂z, 1/r}, u the
trial and v the test function: rows belong to v. Three of the nine are others transposed. All have one
sparsity pattern, so a harmonic costs some additions of their entries.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix
from skfem import BilinearForm

from flexspline.fea.axisymmetric.space import Space
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.kept_entries import NodePairs, starts_of
from flexspline.fea.types import Elastic

RR = BilinearForm(lambda u, v, w: v.grad[0] * u.grad[0] * w.x[0])
RZ = BilinearForm(lambda u, v, w: v.grad[0] * u.grad[1] * w.x[0])
RO = BilinearForm(lambda u, v, w: v.grad[0] * u)
ZZ = BilinearForm(lambda u, v, w: v.grad[1] * u.grad[1] * w.x[0])
ZO = BilinearForm(lambda u, v, w: v.grad[1] * u)
OO = BilinearForm(lambda u, v, w: v * u / w.x[0])


@dataclass(frozen=True)
class BlockPlaces:
    """Where a CSR matrix has the entries of blocks of three by three unknowns, one for each pair of nodes.

    By scipy's block matrix a harmonic's stiffness takes 3.3 ms, so 1.9 (14 000 unknowns; its solve 10).

    Attributes
    ----------
    starts, columns : of the matrix.
    of_block : (3, 3, pairs) place of each entry of the blocks.
    """

    starts: np.ndarray
    columns: np.ndarray
    of_block: np.ndarray

    @classmethod
    def of(cls, rows: np.ndarray, columns: np.ndarray, count: int) -> BlockPlaces:
        """Find the places for pairs (row, column) of `count` nodes, ordered by rows, then by columns."""
        blocks = np.bincount(rows, minlength=count)
        before = np.cumsum(blocks) - blocks
        first = 9 * before[rows] + 3 * (np.arange(len(rows)) - before[rows])
        component = np.arange(3)
        of_block = first + 3 * blocks[rows] * component[:, None, None] + component[:, None]
        indices = np.empty(9 * len(rows), np.int32)
        indices[of_block] = 3 * columns + component[:, None]
        return cls(starts_of(np.repeat(3 * blocks, 3)), indices, of_block)


@dataclass(frozen=True)
class Couplings:
    """The forms on a space, and any harmonic's stiffness from them."""

    space: Space
    material: Elastic

    def stiffness(self, n: int, components: tuple[int, ...], around: float) -> csr_matrix:
        """Return the stiffness (3·count, 3·count) between components of harmonic n; `around` is ∫cos² nφ dφ.

        Unknown 3·node + component; entries of components that are not asked for are 0.
        """
        made = self._torsion(n) if components == (TANGENTIAL,) else self._all(n)
        places = self._places
        data = np.zeros(len(places.columns))
        for (a, b), entries in made.items():
            if a in components and b in components:
                scaled = around * entries
                data[places.of_block[a, b]] = scaled
                if a != b:
                    data[places.of_block[b, a]] = scaled[self._pairs.transposed]
        shape = 2 * (3 * self.space.count,)
        return csr_matrix((data, places.columns, places.starts), shape=shape)

    def _torsion(self, n: int) -> dict[tuple[int, int], np.ndarray]:
        lam, mu = self.material.lam, self.material.mu
        rr, ro, o_r, oo, zz = self._of_torsion
        return {
            (TANGENTIAL, TANGENTIAL): n * n * (lam + 2 * mu) * oo + mu * (rr - ro - o_r + oo + zz)
        }

    def _all(self, n: int) -> dict[tuple[int, int], np.ndarray]:
        lam, mu = self.material.lam, self.material.mu
        both = lam + 2 * mu
        rr, ro, o_r, oo, zz = self._of_torsion
        rz, zr, zo, oz = self._of_meridian
        return {
            (RADIAL, RADIAL): both * (rr + oo) + lam * (ro + o_r) + mu * (zz + n * n * oo),
            (AXIAL, AXIAL): both * zz + mu * (rr + n * n * oo),
            (RADIAL, AXIAL): lam * (rz + oz) + mu * zr,
            (RADIAL, TANGENTIAL): n * (lam * ro + both * oo - mu * (o_r - oo)),
            (TANGENTIAL, AXIAL): n * (lam * oz - mu * zo),
            **self._torsion(n),
        }

    @cached_property
    def _pairs(self) -> NodePairs:
        return NodePairs.of(self.space.dofs, self.space.count)

    @cached_property
    def _places(self) -> BlockPlaces:
        return BlockPlaces.of(*np.divmod(self._pairs.number, self.space.count), self.space.count)

    def _entries(self, form: BilinearForm) -> np.ndarray:
        return self._pairs.summed(form.elemental(self.space.basis).data)

    @cached_property
    def _of_torsion(self) -> tuple[np.ndarray, ...]:
        """RR, RO and its transpose, OO, ZZ: all that torsion needs."""
        rr, ro, oo, zz = map(self._entries, (RR, RO, OO, ZZ))
        return rr, ro, ro[self._pairs.transposed], oo, zz

    @cached_property
    def _of_meridian(self) -> tuple[np.ndarray, ...]:
        """RZ and ZO, each with its transpose."""
        rz, zo = map(self._entries, (RZ, ZO))
        return rz, rz[self._pairs.transposed], zo, zo[self._pairs.transposed]
