"""Faster replacements for some scikit-fem functions, with the same results.

Tests compare each function with scikit-fem. The time that each one saves is in docs/decisions.md ("What is
the program's own").
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skfem import Basis, Mesh, MeshTet, MeshTet2, MeshTri, MeshTri2
from skfem.mapping import MappingIsoparametric

LARGEST = np.iinfo(np.int64).max
NEAREST = (8, 64)
"""Triangles with the nearest centres in which a point is searched first, then all triangles. Judgement."""
CANDIDATES = 1_000_000
"""Pairs of point and triangle at once: 100 MB."""
TOUCH = 1e-9
"""How far, in shares of its height, a point may lie beyond its triangle's side: rounding."""


class _Numbered:
    """`Mesh.build_entities` sorts columns of corner numbers as records, for each mesh, copy and basis."""

    @staticmethod
    def build_entities(t: np.ndarray, indices: Any, sort: bool = True) -> tuple[Any, Any]:
        """Columns of corners, each once and rising, and the number (k, m) of each element's own.

        `t` (c, m) holds the elements' corners, `indices` says which of them make an element's k entities.
        Unsorted entities, and meshes of too many corners for one integer, are scikit-fem's own.
        """
        if indices is None or not sort or not t.size:
            return Mesh.build_entities(t, indices, sort)
        base, corners = int(t.max()) + 1, len(indices[0])
        if base**corners > LARGEST or any(len(index) != corners for index in indices):
            return Mesh.build_entities(t, indices, sort)
        columns = np.sort(np.hstack([t[index] for index in indices]), axis=0)
        key = columns[0].astype(np.int64)
        for row in columns[1:]:
            key = key * base + row
        keys, of = np.unique(key, return_inverse=True)
        entities = np.empty((corners, len(keys)), t.dtype)
        for row in reversed(range(corners)):
            keys, entities[row] = np.divmod(keys, base)
        return entities, of.reshape(len(indices), t.shape[1])


class Tetrahedra(_Numbered, MeshTet):  # type: ignore[misc]
    """scikit-fem's MeshTet."""


class CurvedTetrahedra(_Numbered, MeshTet2):  # type: ignore[misc]
    """scikit-fem's MeshTet2."""


class Triangles(_Numbered, MeshTri):  # type: ignore[misc]
    """scikit-fem's MeshTri."""


class CurvedTriangles(_Numbered, MeshTri2):  # type: ignore[misc]
    """scikit-fem's MeshTri2."""


class ScalarBasis(Basis):  # type: ignore[misc]
    """A basis of one component; scikit-fem sorts its numbers for every field that it looks at."""

    def split(self, x: np.ndarray) -> list[tuple[np.ndarray, Any]]:
        """A field (N,) and its basis, this one."""
        return [(x, self)]


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
        slopes = np.matmul(local.reshape(-1, k), places)  # of each coordinate
        return slopes.reshape(d, d, -1, m).swapaxes(2, 3)

    def invDF(self, X: np.ndarray, tind: Any = None) -> np.ndarray:
        """∂ξ/∂x (d, d, m, q) at points X (d, q) of the elements `tind`."""
        kept = getattr(self, "_kept", None)
        if kept is None or kept[0] is not X or kept[1] is not tind:
            kept = self._kept = X, tind, _by_point(super().invDF(X, tind))
        return kept[2]


def _by_point(values: np.ndarray) -> np.ndarray:
    """The same (..., m, q), with the values of all elements at a point side by side."""
    return np.ascontiguousarray(values.swapaxes(-1, -2)).swapaxes(-1, -2)


@dataclass(frozen=True)
class NodePairs:
    """Pairs of nodes that share an element: the entries of a form's matrix, those too that happen to be 0.

    Attributes
    ----------
    number : (p,) row·n + column, rising.
    place : (k, k, m) to which of them each element's entry is added: trial function, test function,
        element, as in scikit-fem's element matrices.
    """

    number: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, cells: np.ndarray, n: int) -> NodePairs:
        """Find the pairs of elements (m, k) on n nodes."""
        of = cells.T.astype(np.int64)  # n² of 46 341 nodes is beyond 32 bits
        return cls(*np.unique(of[None] * n + of[:, None], return_inverse=True))

    def summed(self, entries: np.ndarray, elements: Any = slice(None)) -> np.ndarray:
        """Sums (p,) of the entries that a form has on all or some elements, `form.elemental(basis).data`."""
        return np.bincount(self.place[..., elements].ravel(), entries, len(self.number))

    @cached_property
    def transposed(self) -> np.ndarray:
        """Return the places (p,) of the transposed matrix's entries."""
        places = np.empty(len(self.number), int)
        places[self.place] = self.place.swapaxes(0, 1)
        return places


def triangles_of(mesh: Any, points: np.ndarray) -> np.ndarray:
    """Return the triangle (k,) of scikit-fem's mesh that holds each point (2, k); −1: none.

    Its own finder looks at all triangles for all points where five are not enough for one of them: 2.6 s for
    9 000 points in 9 000 triangles, 0.1 s here.
    """
    from scipy.spatial import cKDTree

    corner = mesh.p[:, mesh.t]
    tree = cKDTree(corner.mean(axis=1).T)
    triangle, left = np.full(points.shape[1], -1), np.arange(points.shape[1])
    for count in (*NEAREST, mesh.nelements):
        for mine in np.array_split(left, 1 + len(left) * count // CANDIDATES):
            _, near = tree.query(points[:, mine].T, min(count, mesh.nelements))
            near = near.reshape(len(mine), -1)
            first, second = (corner[:, i, near] - corner[:, 0, near] for i in (1, 2))
            offset = points[:, mine, None] - corner[:, 0, near]
            area = first[0] * second[1] - first[1] * second[0]
            x = (offset[0] * second[1] - offset[1] * second[0]) / area
            y = (first[0] * offset[1] - first[1] * offset[0]) / area
            inside = np.minimum(np.minimum(x, y), 1 - x - y)
            best = inside.argmax(axis=1)[:, None]
            within = np.take_along_axis(inside, best, 1)[:, 0] > -TOUCH
            triangle[mine[within]] = np.take_along_axis(near, best, 1)[within, 0]
        left = np.flatnonzero(triangle < 0)
        if not len(left):
            break
    return triangle
