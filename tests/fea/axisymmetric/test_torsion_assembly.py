"""What the torsion of a body of revolution sums by itself is scikit-fem's, to rounding."""

from __future__ import annotations

import numpy as np
from example_files import EXAMPLES
from skfem import BilinearForm, Functional
from skfem.helpers import dot, grad

from flexspline.fea.axisymmetric.space import straight
from flexspline.fea.axisymmetric.torsion_fields import cross_products, weighted_laplace
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.geometry.load import load_design

MESH = triangulate(load_design(EXAMPLES / "xb1-40.toml").part("flexspline").meridian)
SPACE = straight(MESH, MESH.points, 5, {})
FIELDS = np.random.default_rng(2).normal(size=(2, SPACE.count))


def test_the_weighted_laplace_of_each_triangle() -> None:
    form = BilinearForm(lambda u, v, w: w.weight * dot(grad(u), grad(v)))
    theirs = form.elemental(SPACE.basis, weight=SPACE.r**3).tolocal()
    ours = weighted_laplace(SPACE, SPACE.r**3)
    assert ours.shape == theirs.shape
    # rounding of sums over seven points
    np.testing.assert_allclose(ours, theirs, atol=1e-12 * np.abs(theirs).max())


def test_the_cross_product_of_two_fields_on_each_triangle() -> None:
    form = Functional(lambda w: w.psi.grad[1] * w.phi.grad[0] - w.psi.grad[0] * w.phi.grad[1])
    psi, phi = (SPACE.basis.interpolate(field) for field in FIELDS)
    theirs = form.elemental(SPACE.basis, psi=psi, phi=phi)
    ours = cross_products(SPACE, *FIELDS)
    np.testing.assert_allclose(ours, theirs, atol=1e-12 * np.abs(theirs).max())  # rounding
