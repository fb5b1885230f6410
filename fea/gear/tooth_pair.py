"""Compliance of a pair of teeth along the normal of its flanks [mm/N].

Two straight-sided teeth loaded at the pitch point, in plane strain: the tooth itself, held at its root, by
finite elements; its root in an elastic half plane (Cornell, J. Mech. Des. 103 (1981) 447-459); and the
contact of the flanks (Yang and Sun, J. Mech. Transm. Autom. Des. 107 (1985) 529-535).
"""

from __future__ import annotations

from functools import lru_cache
from math import cos, pi, sin, tan

import numpy as np
from skfem import (
    Basis,
    ElementTriP2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshTri,
    condense,
    solve,
)
from skfem.models.elasticity import lame_parameters, linear_elasticity

from flexspline.fea.types import Elastic

ACROSS, UP = 8, 24
"""Elements through the tooth and along its height; twice as many change its compliance by 0.2 %."""
LOAD_SPREAD_SHARE = 0.15
"""Of lever, tip or thickness, the least: so far the load is spread about the pitch point. Half of it moves
the compliance by 0.3 %."""
PUSH = LinearForm(
    lambda v, w: -np.exp(-(((w.x[1] - w.lever) / w.spread) ** 2)) * (w.c * v[0] + w.s * v[1])
)
"""Direction of the force: normal to the flank on the side x > 0."""
TILT, SHIFT, SHEAR_SHARE = 16.67 / pi, 1.534, 2.4
"""Cornell's, of a tooth's root in an elastic half plane in plane strain (the paper above): its tilt under the
bending moment, its shift under the shear force, and what the force along the tooth adds to that."""


def tooth(
    lever: float,
    thickness: float,
    pressure_angle: float,
    tip: float,
    width: float,
    material: Elastic,
) -> float:
    """Of one tooth [mm/N].

    Parameters
    ----------
    lever, tip : from the root to the point of contact, and from there to the tip [mm].
    thickness : of the tooth there [mm]; towards the root it grows with both flanks.
    pressure_angle : of the flanks [rad].
    width : of the face [mm].
    """
    nu = material.poissons_ratio
    plane = material.youngs_modulus_MPa / (1 - nu * nu)
    slender = lever / (thickness + 2 * lever * tan(pressure_angle))
    root = (
        TILT * slender**2
        + 2 * (1 - nu - 2 * nu**2) / (1 - nu**2) * slender
        + SHIFT * (1 + tan(pressure_angle) ** 2 / (SHEAR_SHARE * (1 + nu)))
    )
    clamped_tooth = clamped(lever, thickness, pressure_angle, tip, material)
    return (clamped_tooth + cos(pressure_angle) ** 2 * root / plane) / width


@lru_cache
def clamped(
    lever: float, thickness: float, pressure_angle: float, tip: float, material: Elastic
) -> float:
    """Of a tooth held at its root, times its width [mm²/N]: its middle's way at the height of the load."""
    flat = MeshTri.init_tensor(np.linspace(-1, 1, ACROSS + 1), np.linspace(0, lever + tip, UP + 1))
    half = thickness / 2 + (lever - flat.p[1]) * tan(pressure_angle)
    # 1e-9: the nodes of an edge lie on it but for rounding
    mesh = MeshTri(np.stack([flat.p[0] * half, flat.p[1]]), flat.t).with_boundaries({
        "root": lambda x: x[1] < 1e-9 * lever, "flank": flat.facets_satisfying(lambda x: x[0] > 1 - 1e-9)
    })  # fmt: skip
    element = ElementVector(ElementTriP2())
    basis = Basis(mesh, element)
    elastic = lame_parameters(material.youngs_modulus_MPa, material.poissons_ratio)
    c, s = cos(pressure_angle), sin(pressure_angle)
    spread = LOAD_SPREAD_SHARE * min(lever, tip, thickness)

    flank = FacetBasis(mesh, element, facets="flank")
    load = PUSH.assemble(flank, lever=lever, spread=spread, c=c, s=s)
    rigid = basis.zeros()
    rigid[np.concatenate([basis.nodal_dofs[0], basis.facet_dofs[0]])] = -1.0  # 1 mm against x
    force = float(load @ rigid) / c
    matrix = linear_elasticity(*elastic).assemble(basis)
    moved = solve(*condense(matrix, load / force, D=basis.get_dofs("root")))
    middle = basis.probes(np.array([[0.0], [lever]])) @ moved
    return float(-(c * middle[0] + s * middle[1]))


def flank_contact(width: float, *materials: Elastic) -> float:
    """Of two flanks on each other [mm/N]: the sum of 2(1 − ν²)/(π E b), whatever the load."""
    soft = sum(1 / m.plane_strain_MPa for m in materials)
    return 2 * soft / (pi * width)
