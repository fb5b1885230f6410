"""scikit-fem's map of curved elements, with what it would compute again for every basis function kept."""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem.mapping import MappingIsoparametric


class KeptMapping(MappingIsoparametric):  # type: ignore[misc]
    """The isoparametric map that finds all slopes ∂x/∂ξ at once, and keeps them and their inverse.

    A basis of ten functions asks for the inverse ten times, and scikit-fem finds each slope by itself: of
    stresses that was a third of the time. What it gives, and so the basis, lies in memory element by element
    at each point: forms are summed over points, which takes a third of the time so.
    """

    def J(self, i: int, j: int, X: np.ndarray, tind: Any = None) -> np.ndarray:
        """∂x_i/∂ξ_j (m, q) at points X (d, q) of the elements `tind`."""
        kept = getattr(self, "_slopes", None)
        if kept is None or kept[0] is not X or kept[1] is not tind:
            kept = self._slopes = X, tind, self._all_slopes(X, tind)
        return kept[2][i, j]

    def _all_slopes(self, X: np.ndarray, tind: Any) -> np.ndarray:
        nodes = self.mesh.dofs.element_dofs
        places = self.mesh.doflocs[:, nodes if tind is None else nodes[:, tind]]
        d, k, m = places.shape
        local = np.stack([self.elem.lbasis(X, number)[1] for number in range(k)], axis=2)
        found = np.matmul(local.reshape(-1, k), places)  # of each coordinate
        return found.reshape(d, d, -1, m).swapaxes(2, 3)

    def invDF(self, X: np.ndarray, tind: Any = None) -> np.ndarray:
        """∂ξ/∂x (d, d, m, q) at points X (d, q) of the elements `tind`."""
        kept = getattr(self, "_kept", None)
        if kept is None or kept[0] is not X or kept[1] is not tind:
            kept = self._kept = X, tind, _by_point(super().invDF(X, tind))
        return kept[2]


def _by_point(values: np.ndarray) -> np.ndarray:
    """The same (..., m, q), with the values of all elements at a point side by side."""
    return np.ascontiguousarray(values.swapaxes(-1, -2)).swapaxes(-1, -2)
