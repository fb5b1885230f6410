"""Points of the reference triangle seen from six-node triangles: derivatives, integrals.

Everything is a product of a small table of the reference triangle with numbers per triangle, so that
thousands of triangles are a few matrix products.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

XI, ETA, VALUE = 0, 1, 2
"""∂N/∂ξ, ∂N/∂η and N itself: the functions that tables hold."""
Term = tuple[int, np.ndarray]
"""One of those functions and its coefficient at every point, (m, q) or (m, 1)."""


@dataclass(frozen=True)
class Reference:
    """P2 shape functions at q points of the reference triangle.

    Attributes
    ----------
    functions : (3, 6, q) their slopes in ξ and η, and their values.
    products : (3, 3, q, 36) all products of two of them.
    """

    functions: np.ndarray
    products: np.ndarray


def reference(at: np.ndarray) -> Reference:
    """Shape functions at points (2, q): corners, then the middles of 01, 12, 02."""
    from skfem import ElementTriP2

    parts = [ElementTriP2().lbasis(at, i) for i in range(6)]
    q = at.shape[1]
    functions = np.array([[*(np.broadcast_to(c, q) for c in g), v] for v, g in parts])
    functions = np.ascontiguousarray(functions.transpose(1, 0, 2))
    products = np.einsum("fiq,gjq->fgqij", functions, functions)
    return Reference(functions, products.reshape(3, 3, q, 36))


@lru_cache
def quadrature(degree: int) -> tuple[Reference, np.ndarray]:
    """Points exact to a polynomial degree, and their weights (q,)."""
    from skfem import ElementTriP2
    from skfem.quadrature import get_quadrature

    at, weights = get_quadrature(ElementTriP2, degree)
    return reference(at), weights


@dataclass(frozen=True)
class Points:
    """The same q points in each of m triangles; on straight ones the map is constant (q = 1 there).

    Attributes
    ----------
    reference : the shape functions at them.
    inverse : (2, 2, m, q or 1) ∂(ξ, η)/∂(r, z) [1/mm].
    jacobian : (m, q or 1) ∂(r, z)/∂(ξ, η) [mm²]; its sign is that of the corners' order.
    rz : (2, m, q) where they are [mm].
    """

    reference: Reference
    inverse: np.ndarray
    jacobian: np.ndarray
    rz: np.ndarray

    def at(self, local: np.ndarray) -> np.ndarray:
        """Values (..., m, q) of fields given by their numbers (..., m, 6)."""
        return local @ self.reference.functions[VALUE]

    def gradient(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """∂/∂r and ∂/∂z, each (..., m, q), of fields given by their numbers (..., m, 6)."""
        xi, eta = (local @ self.reference.functions[f] for f in (XI, ETA))
        by_r, by_z = (self.inverse[XI, d] * xi + self.inverse[ETA, d] * eta for d in (0, 1))
        return by_r, by_z

    def derivative(self, direction: int) -> tuple[Term, Term]:
        """∂N/∂r (0) or ∂N/∂z (1) for `integral`."""
        return (XI, self.inverse[XI, direction]), (ETA, self.inverse[ETA, direction])

    def integral(
        self, weight: np.ndarray, first: Sequence[Term], second: Sequence[Term]
    ) -> np.ndarray:
        """Σ_q weight·first_i·second_j of each triangle, (m, 36) with j the faster; weight (m, q)."""
        pairs = [(f, g, a * b) for f, a in first for g, b in second]
        coefficients = np.concatenate([weight * c for _, _, c in pairs], axis=1)
        return coefficients @ np.concatenate([self.reference.products[f, g] for f, g, _ in pairs])

    def dirichlet(self, weight: np.ndarray) -> np.ndarray:
        """Σ_q weight ∇N_i·∇N_j of each triangle, (m, 36); weight (m, q)."""
        pairs = [(XI, XI), (XI, ETA), (ETA, XI), (ETA, ETA)]
        metric = [(self.inverse[f] * self.inverse[g]).sum(axis=0) for f, g in pairs]
        coefficients = np.concatenate([weight * c for c in metric], axis=1)
        return coefficients @ np.concatenate([self.reference.products[f, g] for f, g in pairs])


def mapped(nodes: np.ndarray, seen: Reference) -> Points:
    """Points of curved triangles with six nodes (2, m, 6) [mm]."""
    xi, eta = (nodes @ seen.functions[f] for f in (XI, ETA))
    return _points(seen, xi, eta, nodes @ seen.functions[VALUE])


def straight(nodes: np.ndarray, seen: Reference) -> Points:
    """Points of straight triangles, their nodes (2, m, 6) [mm]; the middles are halfway."""
    a, b, c = (nodes[..., i : i + 1] for i in range(3))
    return _points(seen, b - a, c - a, nodes @ seen.functions[VALUE])


def _points(seen: Reference, xi: np.ndarray, eta: np.ndarray, rz: np.ndarray) -> Points:
    """With ∂(r, z)/∂ξ and ∂(r, z)/∂η, each (2, m, q or 1)."""
    det = xi[0] * eta[1] - eta[0] * xi[1]
    inverse = np.array([[eta[1], -eta[0]], [-xi[1], xi[0]]]) / det
    return Points(seen, inverse, det, rz)
