"""The two scalar problems of torsion (Michell 1899), which give the lower and the upper bound.

Primal. With ψ = u_θ/r, every ψ that is 0 on `mount` and 1 on the driven patch gives

    K ≤ 2πG ∫ r³ |∇ψ|² dA.

Dual. Every stress function φ (τ_zθ = φ,r/r², τ_rθ = -φ,z/r²) that is constant on each piece of free
boundary is in equilibrium with the torque T = 2π·(sum of its jumps across the driven pieces) and
gives, by the principle of minimum complementary energy,

    K ≥ T² / (2π/G ∫ |∇φ|²/r³ dA).

Both are computed for G = 1 and any numbers for ψ and φ will do, so neither the solver's rounding
nor the mesh can break them; only the integrals must not be on the wrong side:

- r³|∇ψ|² is a polynomial of degree 5 on a straight triangle, integrated exactly.
- 1/r³ is replaced by a polynomial that is nowhere smaller. With ω(r) = (r-a)(r-c)²(r-b), where a
  and b are the triangle's least and largest radius and c their mean, p(r) = (1 - ω(r)/ω(0))/r is a
  cubic, and p ≥ 1/r as ω ≤ 0 between a and b. p³|∇φ|² has degree 11 and is integrated exactly. The
  relative excess of p over 1/r is below ((b-a)/a)⁴/64.
- On triangles that touch the axis φ is 0 altogether: that is admissible (the torque within them is
  given away), and needs no integral.

The domain of ψ contains the exact meridian and that of φ is contained in it
(`MeridianMesh.containing`, `contained`). Restricting ψ can only lower its energy; φ continues as a
constant beyond its free edge. So both statements hold for the body with true fillet arcs.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.sparse import csr_matrix
from skfem import BilinearForm, Functional, condense
from skfem.helpers import dot, grad

from flexspline.fea.axisymmetric.factors import relative_residual, solved
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.patches import Boundary
from flexspline.fea.axisymmetric.space import Space, moved, straight

WEIGHTED_LAPLACE = BilinearForm(lambda u, v, w: w.weight * dot(grad(u), grad(v)))
WEIGHTED_ENERGY = Functional(lambda w: w.weight * dot(grad(w.field), grad(w.field)))
CROSS_PRODUCT = Functional(lambda w: w.psi.grad[1] * w.phi.grad[0] - w.psi.grad[0] * w.phi.grad[1])
PRIMAL_DEGREE = 5
"""Of quadrature: r³|∇ψ|², with ψ of degree 2."""
DUAL_DEGREE = 11
"""Of quadrature: p³|∇φ|², with p(r) ≥ 1/r of degree 3."""


@dataclass(frozen=True)
class Turn:
    """ψ [rad] at the P2 numbers (count,) of a space, for a turn of 1 rad."""

    space: Space
    psi: np.ndarray


@dataclass(frozen=True)
class Bracket:
    """One mesh's bounds for G = 1.

    Attributes
    ----------
    lower, upper : of K/G [mm³].
    reaction : torque on the driven patch per angle and G, of the upper bound's solution [mm³].
    share : (m,) each triangle's part of upper - lower [mm³].
    unknowns : of the larger of the two systems.
    residual : relative residual of the worse of the two solves.
    turn : the upper bound's solution.
    """

    lower: float
    upper: float
    reaction: float
    share: np.ndarray
    unknowns: int
    residual: float
    turn: Turn


def touching_axis(mesh: MeridianMesh) -> np.ndarray:
    """Return the mask (m,) of triangles with a corner on r = 0."""
    return mesh.on_axis()[mesh.triangles].any(axis=1)


def across_from_axis(mesh: MeridianMesh, boundary: Boundary) -> np.ndarray:
    """Return the mask (m,) of triangles from the axis to another free piece, which are too large for φ."""
    other = (boundary.piece >= 0) & (boundary.piece != boundary.axis)
    reached = np.zeros(len(mesh.points), bool)
    reached[mesh.edges[other[mesh.edge_segment]]] = True
    return touching_axis(mesh) & reached[mesh.triangles].any(axis=1)


def bracket(mesh: MeridianMesh, boundary: Boundary) -> Bracket:
    """Solve both problems on one mesh, and return its bounds for G = 1."""
    roles = {"held": boundary.held, "driven": boundary.driven}
    pieces = {_piece(k): np.flatnonzero(boundary.piece == k) for k in range(boundary.pieces)}
    outer = straight(mesh, mesh.containing(), PRIMAL_DEGREE, roles | pieces)
    inner = moved(outer, mesh.contained(), DUAL_DEGREE)
    inverse_cubed = inverse_radius_bound(inner) ** 3
    psi, reaction, primal_residual = _primal(outer)
    phi, dual_residual = _dual(inner, inverse_cubed, mesh, boundary)
    stretch = WEIGHTED_ENERGY.elemental(outer.basis, field=psi, weight=outer.r**3)
    within, around = (inner.basis.interpolate(field) for field in (psi, phi))
    stress = WEIGHTED_ENERGY.elemental(inner.basis, field=around, weight=inverse_cubed)
    torque = 2 * pi * float(_piece_constants(inner, boundary, phi) @ boundary.jump)
    upper = 2 * pi * float(stretch.sum())
    lower = torque**2 / (2 * pi * float(stress.sum()))
    # the gap is the energy of the constitutive misfit r³∇ψ - s rot φ (Prager and Synge 1947)
    s = lower / torque
    cross = CROSS_PRODUCT.elemental(inner.basis, psi=within, phi=around)
    misfit = stretch + s**2 * stress - 2 * s * cross
    # where fillets are cut differently for the two problems, the energy between them counts too
    sliver = np.abs(outer.weights.sum(axis=1) / inner.weights.sum(axis=1) - 1)
    share = 2 * pi * (np.maximum(misfit, 0.0) + stretch * sliver)
    residual = max(primal_residual, dual_residual)
    turn = Turn(outer, psi)
    return Bracket(lower, upper, reaction, share, int(inner.count), residual, turn)


def _piece(number: int) -> str:
    """Name of a piece of free boundary."""
    return f"free {number}"


def inverse_radius_bound(space: Space) -> np.ndarray:
    """Return p(r) ≥ 1/r at the quadrature points (m, q); 0 on triangles that touch the axis."""
    corner = space.places[space.dofs[:, :3], 0]
    a, b = corner.min(axis=1)[:, None], corner.max(axis=1)[:, None]
    c, r = (a + b) / 2, space.r
    away = a > 1e-9 * b  # else on the axis, but for rounding
    at_zero = np.where(away, a * b * c**2, 1.0)
    return np.where(away, (1 - (r - a) * (r - b) * (r - c) ** 2 / at_zero) / r, 0.0)


def _primal(space: Space) -> tuple[np.ndarray, float, float]:
    """ψ, the reaction torque on the driven patch for G = 1 and angle 1 [mm³], the residual."""
    psi = np.zeros(space.count)
    driven = space.on("driven")
    psi[driven] = 1.0
    free = np.setdiff1d(np.arange(space.count), np.union1d(driven, space.on("held")))
    matrix = WEIGHTED_LAPLACE.assemble(space.basis, weight=space.r**3)
    inside, load = condense(matrix, x=psi, I=free, expand=False)
    psi[free] = solved(inside, load)
    reaction = 2 * pi * float((matrix @ psi)[driven].sum())
    return psi, reaction, relative_residual(inside, psi[free], load)


def _dual(
    space: Space, weight: np.ndarray, mesh: MeridianMesh, boundary: Boundary
) -> tuple[np.ndarray, float]:
    """φ = P x with one unknown x for each free piece (`_tied`), and the residual."""
    tied = _tied(space, mesh, boundary)
    matrix = tied.T @ WEIGHTED_LAPLACE.assemble(space.basis, weight=weight) @ tied
    jumps = np.zeros(space.count)
    for piece in range(boundary.pieces):
        jumps[space.on(_piece(piece))[0]] += boundary.jump[piece]
    load = tied.T @ jumps
    reduced = solved(matrix, load)
    return tied @ reduced, relative_residual(matrix, reduced, load)


def _tied(space: Space, mesh: MeridianMesh, boundary: Boundary) -> csr_matrix:
    """P (count, unknowns): one unknown per free piece, none where φ is 0 (one piece, and the axis)."""
    number = np.zeros(space.count, int)
    ground = max(boundary.axis, 0)
    zero = np.zeros(space.count, bool)
    if boundary.axis >= 0:
        zero[space.dofs[touching_axis(mesh)]] = True
    piece_of = np.full(space.count, -1)
    for piece in range(boundary.pieces):
        piece_of[space.on(_piece(piece))] = piece
    zero |= piece_of == ground
    untied = ~zero & (piece_of < 0)
    number[untied] = np.arange(untied.sum())
    others = [p for p in range(boundary.pieces) if p != ground]
    for k, piece in enumerate(others):
        number[piece_of == piece] = untied.sum() + k
    rows = np.flatnonzero(~zero)
    shape = space.count, int(untied.sum()) + len(others)
    return csr_matrix((np.ones(len(rows)), (rows, number[rows])), shape=shape)


def _piece_constants(space: Space, boundary: Boundary, phi: np.ndarray) -> np.ndarray:
    return np.array([phi[space.on(_piece(p))[0]] for p in range(boundary.pieces)])
