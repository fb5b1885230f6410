"""The entries of forms on one sparsity pattern are those that scikit-fem assembles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementTetP2, ElementTriP2, MeshTet, MeshTri, MeshTri2

from flexspline.fea.kept_entries import NodePairs


def test_pairs_of_more_nodes_than_fit_in_32_bits_when_squared() -> None:
    n = 50_000
    pairs = NodePairs.of(np.array([[0, 1, n - 1], [n - 2, 5, n - 1]], np.int32), n)
    rows, columns = np.divmod(pairs.number, n)
    assert (np.diff(pairs.number) > 0).all()
    assert set(zip(rows.tolist(), columns.tolist(), strict=True)) == {
        (a, b) for cell in ((0, 1, n - 1), (n - 2, 5, n - 1)) for a in cell for b in cell
    }


@pytest.mark.parametrize(
    "basis",
    [
        Basis(MeshTet().refined(1), ElementTetP2()),
        Basis(MeshTri().refined(2), ElementTriP2()),
        Basis(MeshTri2.from_mesh(MeshTri().refined(2)), ElementTriP2()),
    ],
    ids=["tetrahedra", "triangles", "curved triangles"],
)
def test_sums_are_those_of_an_assembled_form(basis: Any) -> None:
    form = BilinearForm(lambda u, v, w: u.grad[0] * v.grad[1])
    cells = basis.element_dofs.T
    pairs = NodePairs.of(cells, basis.N)
    entries = pairs.summed(form.elemental(basis).data, np.arange(len(cells)))
    for found, known in (
        (entries, form.assemble(basis)),
        (entries[pairs.transposed], form.assemble(basis).T),
    ):
        full = np.zeros((basis.N, basis.N))
        full[np.divmod(pairs.number, basis.N)] = found
        np.testing.assert_allclose(full, known.toarray(), atol=1e-14)
