"""What the fea room hands on: meshes, stiffnesses and solved fields, all frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from geometry.design import Material

NMM_PER_NM = 1000.0


@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elasticity, MPa."""

    youngs_modulus_MPa: float
    poissons_ratio: float

    @classmethod
    def of(cls, material: Material) -> Elastic:
        return cls(material.youngs_modulus_GPa * 1e3, material.poissons_ratio)

    @property
    def mu(self) -> float:
        """Shear modulus G [MPa]."""
        return self.youngs_modulus_MPa / (2 * (1 + self.poissons_ratio))

    @property
    def lam(self) -> float:
        """Lamé's first parameter [MPa]."""
        nu = self.poissons_ratio
        return self.youngs_modulus_MPa * nu / ((1 + nu) * (1 - 2 * nu))


@dataclass(frozen=True)
class TetMesh:
    """Quadratic tetrahedra of a part's sector.

    Attributes
    ----------
    nodes : (n, 3) mm; corner nodes first.
    cells : (m, 10) node indices in VTK's quadratic tetrahedron order
        (corners 0 to 3, then the middles of edges 01, 12, 20, 03, 13, 23).
    facets : (k, 6) boundary facets, outward (corners 0 to 2, then the middles of 01, 12, 20).
    facet_patch : (k,) index into `patches` of each facet.
    patches : patch names, the empty name for the unnamed rest of the surface.
    sector_deg : the sector about z that is meshed, from angle 0.
    """

    nodes: np.ndarray
    cells: np.ndarray
    facets: np.ndarray
    facet_patch: np.ndarray
    patches: tuple[str, ...]
    sector_deg: float

    def on(self, patch: str) -> np.ndarray:
        """Facets (j, 6) of a patch."""
        if patch not in self.patches:
            return np.empty((0, 6), dtype=self.facets.dtype)
        return self.facets[self.facet_patch == self.patches.index(patch)]

    def nodes_on(self, patch: str) -> np.ndarray:
        """Sorted node indices of a patch, edges included."""
        return np.unique(self.on(patch))


@dataclass(frozen=True)
class StressPeak:
    """The largest von Mises stress away from sharp edges and patch edges, and where it is."""

    mises_MPa: float
    at_mm: tuple[float, float, float]
    excluded: str
    """Plain words: which places were left out and why."""


@dataclass(frozen=True)
class SolidField:
    """One solved load case on one mesh.

    Attributes
    ----------
    displacement : (n, 3) mm at the mesh's nodes.
    mises : (n,) MPa, averaged at the nodes.
    """

    mesh: TetMesh
    load_case: str
    displacement: np.ndarray
    mises: np.ndarray
    peak: StressPeak


@dataclass(frozen=True)
class MeshLevel:
    """One mesh of a refinement sequence and what it gave."""

    edge_length_mm: float
    elements: int
    dofs: int
    K_Nm_per_rad: float
    K_reaction_Nm_per_rad: float
    residual: float


@dataclass(frozen=True)
class Stiffness:
    """A torsional stiffness with its error bounds, N·m/rad."""

    K_Nm_per_rad: float
    lower_Nm_per_rad: float
    upper_Nm_per_rad: float
    model: Literal["solid", "axisymmetric"]
    symmetry: str
    method: str
    """Plain words: how the bounds were obtained."""
    levels: tuple[MeshLevel, ...]
    error_scale: float = 1.0
    """True error over estimated error, as found from the meshes; 1 where the bounds are theorems."""
