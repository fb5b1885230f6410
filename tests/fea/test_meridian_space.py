"""What the meridian's spaces compute beside scikit-fem is what scikit-fem computes."""

from __future__ import annotations

import numpy as np
from skfem import Basis, BilinearForm, ElementTriP2, MeshTri
from skfem.helpers import dot, grad

from flexspline.fea.axisymmetric.space import weighted_laplace


def test_the_weighted_laplace_is_scikit_fem_s_form() -> None:
    mesh = MeshTri.init_tensor(np.array([1.0, 1.3, 2.0]), np.array([0.0, 0.4, 0.9, 1.0]))
    basis = Basis(mesh, ElementTriP2(), intorder=5)
    weight = np.asarray(basis.global_coordinates())[0] ** 3
    form = BilinearForm(lambda u, v, w: w.weight * dot(grad(u), grad(v)))
    expected = form.assemble(basis, weight=weight)
    off = abs(weighted_laplace(basis, weight) - expected)
    assert off.max() < 1e-13 * abs(expected).max()  # rounding
