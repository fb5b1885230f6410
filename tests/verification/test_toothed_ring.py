"""The tooth cell where the answer is known: thick rings, and a rim cut by radial slits.

Timoshenko and Goodier, Theory of Elasticity, 3rd ed., art. 28 (Lamé) and 29 (pure bending of a
curved bar, Golovin). Slits: the Airy function over a stretched rim and the conjugate of its warping
obey the equations and the conditions of slow flow across and along thin blades s apart, whose
effective wall lies beyond the blades' edges by a share of s: ln 2/π along them (Bechert and
Bartenwerfer, J. Fluid Mech. 206, 1989, 105-129), 0.0886 across (quoted of Luchini, Manzo and Pozzi, J.
Fluid Mech. 228, 1991, 87-109, which was not at hand: `across_blades` derives it).
"""

from __future__ import annotations

from collections.abc import Callable
from math import exp, inf, log, log1p, pi, tanh

import numpy as np
import pytest
from scipy.integrate import quad

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.toothed_ring.cell import CellModel
from flexspline.fea.toothed_ring.equivalent import EquivalentRing, equivalent_ring
from flexspline.geometry.tooth import ToothCell

INNER, OUTER, NU = 5.0, 10.0, 0.3
TIMOSHENKO = "Timoshenko and Goodier, Theory of Elasticity, art. "


def thick_ring(rounds: int) -> CellModel:
    """A plain ring with b/a = 2 in a cell of 0.3 rad."""
    cell = ToothCell(INNER, 0.3, ((OUTER, 0.3),))
    mesh = triangulate(cell.outline)
    for _ in range(rounds):
        mesh = refined(mesh, np.ones(len(mesh.triangles), bool))
    return CellModel(cell, mesh)


def golovin() -> float:
    """M/(E' δ/θ) = N/(8(b² − a²)) with N = (b² − a²)² − 4a²b² ln²(b/a)."""
    a2, b2 = INNER**2, OUTER**2
    return ((b2 - a2) ** 2 - 4 * a2 * b2 * log(OUTER / INNER) ** 2) / (8 * (b2 - a2))


def lame() -> float:
    """p/(E' u) inside a cylinder in plane strain, E' = E/(1 − ν²)."""
    a2, b2 = INNER**2, OUTER**2
    strain = (1 + NU) * ((1 - 2 * NU) * a2 + b2) / (b2 - a2)
    return (1 - NU**2) / (strain * INNER)


def test_thick_ring_against_closed_forms(record) -> None:
    found = thick_ring(4)
    bending, membrane, torsion = found.bending(NU), found.membrane(NU), found.torsion()
    record("Curved bar in pure bending, b/a = 2", TIMOSHENKO + "29", golovin(), bending, "mm³")
    record("Cylinder under pressure, b/a = 2", TIMOSHENKO + "28", lame(), membrane, "1/mm")
    J = pi / 2 * (OUTER**4 - INNER**4)
    record("Torsion constant of a tube, b/a = 2", "π(b⁴ − a⁴)/2", J, torsion, "mm⁴")
    # fourth order, 16 elements across: each is below 1e-6
    assert bending == pytest.approx(golovin(), rel=1e-6)
    assert membrane == pytest.approx(lame(), rel=1e-6)
    # no warping, and r³ is integrated exactly
    assert torsion == pytest.approx(J, rel=1e-12)


def test_thick_ring_energy_falls_with_the_fourth_power() -> None:
    for exact, solve in ((golovin(), CellModel.bending), (lame(), CellModel.membrane)):
        errors = [solve(thick_ring(rounds), NU) / exact - 1 for rounds in (1, 2, 3)]
        assert min(errors) > 0
        # 16 in the limit; 12 leaves room for coarse first meshes
        assert errors[1] > 12 * errors[2]


def slit_rim() -> tuple[EquivalentRing, float]:
    """2000 slits from a rim of 1 mm outwards, 4 spacings long; and their spacing [mm].

    What the rim does between two slits fades over a spacing as e^(-π) at the slowest: 3e-6 at their ends.
    """
    root, half_pitch = 20.0, pi / 2000
    spacing = 2 * half_pitch * root
    cell = ToothCell(root - 1, half_pitch, ((root + 4 * spacing, half_pitch), (root, half_pitch)))
    return equivalent_ring(cell, NU), spacing


def edge_factor(log_kernel: Callable[[float], float]) -> float:
    """−(ln G₊)′ at 0 [spacings], of a kernel G(k) = G₊G₋ with G(0) = 1, G → c/k, given ln G.

    The factor of ln G + ½ ln(1 + k²/16), which stays bounded, is Cauchy's integral (Noble, The Wiener-Hopf
    Technique, 1958, 1.3); (1 + k²/16)^(-1/2) has the factor (1 + s/4)^(-1/2), s = −ik.
    """

    def integrand(k: float) -> float:
        return (log_kernel(k) + 0.5 * log1p(k * k / 16)) / k**2

    near = quad(integrand, 1e-4, 1)[0] + quad(integrand, 1, 30)[0]
    return 1 / 8 - (near + quad(integrand, 30, inf)[0]) / pi


def along_blades() -> float:
    """Flow w along blades at x = 0, y < 0, spacing 1: w,x = −k tanh(k/2) w there, ½k² G."""
    return edge_factor(lambda k: log(tanh(k / 2) / (k / 2)))


def across_blades() -> float:
    """Flow ψ across them: ψ,x = 0 on x = 0 and ½, so ψ,xxx = −4k³ sinh²(k/2)/(sinh k + k) ψ, −½k⁴ G.

    ψ = 0 on the blade and ψ,xxx = 0 ahead of it; ψ ~ y²/2 + h y far ahead, h the depth.
    """

    def log_kernel(k: float) -> float:
        e = exp(-k)  # hyperbolic functions over eᵏ: they overflow
        return log(2 * (1 - e) ** 2 / (k * ((1 - e * e) / 2 + k * e)))

    return edge_factor(log_kernel)


def test_depth_of_blades_is_what_the_sources_say() -> None:
    # the integrals leave out k < 1e-4: 1e-4 · integrand(0) / π, below 1e-5
    assert along_blades() == pytest.approx(log(2) / pi, abs=1e-5)
    # a figure of three digits
    assert across_blades() == pytest.approx(0.0886, abs=5e-5)


@pytest.mark.long
def test_slit_rim_against_flow_over_blades(record) -> None:
    ring, spacing = slit_rim()
    beyond = [(t - 1) / spacing for t in (ring.bending_mm, ring.membrane_mm, ring.torsion_mm)]
    along, across = log(2) / pi, across_blades()
    case, where = "Rim cut by radial slits: effective depth beyond their roots, ", "spacings"
    record(case + "torsion", "Bechert and Bartenwerfer 1989", along, beyond[2], where)
    record(
        case + "hoop tension",
        "Wiener-Hopf; Luchini, Manzo and Pozzi 1991",
        across,
        beyond[1],
        where,
    )
    # the rim is 1 mm: 1e-4 of it at most are 0.002 spacings; curvature adds 0.3 %, spacing/R
    assert beyond[2] == pytest.approx(along, abs=0.002 + 0.003 * along)
    assert beyond[1] == pytest.approx(across, abs=0.002)
    # bent, the fibres near the slits are stretched almost alike: spacing/thickness is 6 %
    assert beyond[0] == pytest.approx(across, rel=0.06)
