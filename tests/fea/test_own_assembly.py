"""What is the program's own says what scikit-fem says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hand_made_tube import tube
from skfem import Basis, BilinearForm, ElementTetP2, ElementTriP2, Mesh, MeshTet, MeshTri
from skfem.mapping import MappingIsoparametric

from flexspline.fea.own_assembly import (
    CurvedTriangles,
    KeptMapping,
    NodePairs,
    ScalarBasis,
    Tetrahedra,
    Triangles,
    triangles_of,
)
from flexspline.fea.solid.elements import tet_rule
from flexspline.fea.solid.space import SolidSpace


def shuffled(mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Points and elements of a mesh, its corners numbered and turned at random."""
    rng = np.random.default_rng(0)
    place = rng.permutation(mesh.p.shape[1])
    t = rng.permuted(place[mesh.t], axis=0).astype(np.int32)
    points = np.empty_like(mesh.p)
    points[:, place] = mesh.p
    return points, t


@pytest.mark.parametrize("named", ["edges", "facets", "t2e", "t2f", "f2e", "f2t"])
def test_numbers_of_tetrahedra(named: str) -> None:
    points, t = shuffled(MeshTet().refined(2))
    own, theirs = (kind(points, t, sort_t=False) for kind in (Tetrahedra, MeshTet))
    assert np.array_equal(getattr(own, named), getattr(theirs, named))


@pytest.mark.parametrize("named", ["facets", "t2f", "f2t"])
def test_numbers_of_triangles(named: str) -> None:
    points, t = shuffled(MeshTri().refined(3))
    own, theirs = (kind(points, t, sort_t=False) for kind in (Triangles, MeshTri))
    assert np.array_equal(getattr(own, named), getattr(theirs, named))


def test_a_field_seen_on_a_basis_of_one_component() -> None:
    mesh = MeshTri(*shuffled(MeshTri().refined(2)))
    field = np.random.default_rng(1).standard_normal(Basis(mesh, ElementTriP2()).N)
    ours, theirs = (kind(mesh, ElementTriP2()).interpolate(field) for kind in (ScalarBasis, Basis))
    assert np.array_equal(ours.value, theirs.value)
    assert np.array_equal(ours.grad, theirs.grad)


def test_corner_numbers_too_large_for_one_integer() -> None:
    """A facet of three corners of up to 2³¹ would take 93 bits."""
    t = np.array([[0, 1], [1, 2], [2, 3], [2**31 - 1, 2**31 - 2]])
    sides = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    for own, theirs in zip(
        Tetrahedra.build_entities(t, sides), Mesh.build_entities(t, sides), strict=True
    ):
        assert np.array_equal(own, theirs)


def test_a_copy_with_boundaries_is_the_same_kind() -> None:
    mesh = Tetrahedra(*shuffled(MeshTet().refined(1)), sort_t=False)
    assert isinstance(mesh.with_boundaries({"some": np.array([0])}), Tetrahedra)


@pytest.mark.parametrize("elements", [None, np.array([5, 2])])
def test_slopes_and_their_inverse_are_those_of_scikit_fem(elements: np.ndarray | None) -> None:
    curved, points = SolidSpace.of(tube(30.0, 2)).curved, tet_rule()[0].T
    ours = KeptMapping(curved, ElementTetP2(), ElementTriP2())
    theirs = MappingIsoparametric(curved, ElementTetP2(), ElementTriP2())
    for what in ("DF", "invDF", "detDF"):
        found, known = (getattr(m, what)(points, elements) for m in (ours, theirs))
        np.testing.assert_allclose(found, known, rtol=1e-12, atol=1e-12 * np.abs(known).max())


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
        ScalarBasis(CurvedTriangles.from_mesh(MeshTri().refined(2)), ElementTriP2()),
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


def test_a_point_is_found_in_the_triangle_that_scikit_fem_finds() -> None:
    """And in none where scikit-fem raises an error: the L has no corner at (1, 1)."""
    mesh = MeshTri.init_lshaped().refined(3)
    points = np.random.default_rng(3).uniform(-1, 1, (2, 300))
    inside = ~(points > 0).all(axis=0)
    found = triangles_of(mesh, points)
    assert np.array_equal(found[inside], mesh.element_finder()(*points[:, inside]))
    assert (found[~inside] == -1).all()
    assert (~inside).any()
