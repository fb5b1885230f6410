"""The sparse stiffness of any harmonic, from weak forms that are assembled once.

Every block of it is a combination of the nine forms ∫ f(v) g(u) r dA over f, g ∈ {∂/∂r, ∂/∂z, 1/r}, u the
trial and v the test function: rows belong to v. Three of the nine are others transposed. All have one
sparsity pattern, so a harmonic costs some additions of their entries.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix
from skfem import BilinearForm

from flexspline.fea.axisymmetric.space import Space
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.own_assembly import NodePairs
from flexspline.fea.types import Elastic

RR = BilinearForm(lambda u, v, w: v.grad[0] * u.grad[0] * w.x[0])
RZ = BilinearForm(lambda u, v, w: v.grad[0] * u.grad[1] * w.x[0])
RO = BilinearForm(lambda u, v, w: v.grad[0] * u)
ZZ = BilinearForm(lambda u, v, w: v.grad[1] * u.grad[1] * w.x[0])
ZO = BilinearForm(lambda u, v, w: v.grad[1] * u)
OO = BilinearForm(lambda u, v, w: v * u / w.x[0])


@dataclass(frozen=True)
class Couplings:
    """The forms on a space, and any harmonic's stiffness from them."""

    space: Space
    material: Elastic

    def stiffness(self, n: int, components: tuple[int, ...]) -> csr_matrix:
        """Stiffness (3·count, 3·count) between components of harmonic n, per ∫cos² nφ dφ.

        Unknown 3·node + component; components that are not asked for are left empty.
        """
        made = self._torsion(n) if components == (TANGENTIAL,) else self._all(n)
        blocks = np.zeros((len(self._rr), 3, 3))
        for (a, b), entries in made.items():
            if a in components and b in components:
                blocks[:, a, b] = entries
                if a != b:
                    blocks[:, b, a] = entries[self._pairs.transposed]
        shape = 2 * (3 * self.space.count,)
        return bsr_matrix((blocks, *self._places), shape=shape).tocsr()

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
        zr, o_r, oz = rz[self._pairs.transposed], self._or, zo[self._pairs.transposed]
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
    def _places(self) -> tuple[np.ndarray, np.ndarray]:
        """Columns of the entries, and where each row starts."""
        rows, columns = np.divmod(self._pairs.number, self.space.count)
        return columns, np.searchsorted(rows, np.arange(self.space.count + 1))

    def _entries(self, form: BilinearForm) -> np.ndarray:
        return self._pairs.summed(form.elemental(self.space.basis).data)

    @cached_property
    def _rr(self) -> np.ndarray:
        return self._entries(RR)

    @cached_property
    def _rz(self) -> np.ndarray:
        return self._entries(RZ)

    @cached_property
    def _ro(self) -> np.ndarray:
        return self._entries(RO)

    @cached_property
    def _or(self) -> np.ndarray:
        return self._ro[self._pairs.transposed]

    @cached_property
    def _zz(self) -> np.ndarray:
        return self._entries(ZZ)

    @cached_property
    def _zo(self) -> np.ndarray:
        return self._entries(ZO)

    @cached_property
    def _oo(self) -> np.ndarray:
        return self._entries(OO)
