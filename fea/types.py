"""Results of the fea package: meshes, stiffnesses and solved fields, all immutable."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from flexspline.geometry.material import ElasticMaterial

if TYPE_CHECKING:
    from flexspline.fea.curved_mesh import CurvedMesh

NMM_PER_NM = 1000.0
"""N·mm in one N·m: inside lengths are mm, stiffnesses are told in N·m/rad."""


@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elasticity, MPa."""

    youngs_modulus_MPa: float
    poissons_ratio: float

    @classmethod
    def of(cls, material: ElasticMaterial) -> Elastic:
        return cls(material.youngs_modulus_MPa, material.poissons_ratio)

    @property
    def mu(self) -> float:
        """Shear modulus G [MPa]."""
        return self.youngs_modulus_MPa / (2 * (1 + self.poissons_ratio))

    @property
    def plane_strain_MPa(self) -> float:
        """E/(1 − ν²), of plates and of contact."""
        return self.youngs_modulus_MPa / (1 - self.poissons_ratio**2)

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

    @cached_property
    def curved(self) -> CurvedMesh:
        """The mesh as scikit-fem has it, numbered once."""
        from flexspline.fea.curved_mesh import CurvedMesh

        return CurvedMesh.of(self)

    def on(self, patch: str) -> np.ndarray:
        """Facets (j, 6) of a patch."""
        if patch not in self.patches:
            return np.empty((0, 6), dtype=self.facets.dtype)
        return self.facets[self.facet_patch == self.patches.index(patch)]

    def nodes_on(self, patch: str) -> np.ndarray:
        """Sorted node indices of a patch, edges included."""
        return np.unique(self.on(patch))

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.cells)

    @property
    def shortest_edge_mm(self) -> float:
        """Shortest edge between corner nodes."""
        return shortest_edge_mm(self.nodes, self.cells[:, :4])


@dataclass(frozen=True)
class Shortfall:
    """Why a figure falls short of what was asked for; false where it does not.

    Attributes
    ----------
    words : plain ones; "" where nothing is short.
    of_the_machine : whether more time or memory would have gone further: another machine, or an idle one.
    """

    words: str = ""
    of_the_machine: bool = False

    def __bool__(self) -> bool:
        return bool(self.words)

    def __str__(self) -> str:
        return self.words


MET = Shortfall()
"""Of a figure that is as good as was asked for."""


@dataclass(frozen=True)
class StressPeak:
    """The largest von Mises stress away from sharp edges and patch edges, and where it is.

    Attributes
    ----------
    excluded : plain words: which places were left out and why.
    exclusion_mm : the distance from those edges up to which nothing counts.
    at_excluded_border : whether the stress goes on rising into the excluded zone. The figure then hangs on
        `exclusion_mm`, says nothing of the part alone, and is compared with no limit.
    mises_at_twice_MPa : the largest at twice that distance; None where no point is that far.
    """

    mises_MPa: float
    at_mm: tuple[float, float, float]
    excluded: str
    exclusion_mm: float
    at_excluded_border: bool
    mises_at_twice_MPa: float | None
    shortfall: Shortfall = MET
    """Why the refinement ended before its tolerance was met."""
    stands_for: str = ""
    """Why this peak, of another body, is the part's; "" where the part itself was solved."""
    left_out: str = ""
    """What the part has and the body solved has not; "" of nothing. The part's stress is higher there."""

    def times(self, factor: float) -> StressPeak:
        """Return the peak under `factor` times the load."""
        twice = self.mises_at_twice_MPa
        return replace(
            self,
            mises_MPa=self.mises_MPa * factor,
            mises_at_twice_MPa=None if twice is None else twice * factor,
        )


@dataclass(frozen=True)
class SolidField:
    """One solved load case on one mesh.

    Attributes
    ----------
    displacement : (n, 3) mm at the mesh's nodes.
    mises : (n,) MPa, averaged at the nodes.
    left_out : what the part has and the mesh has not, "" of nothing.
    """

    mesh: TetMesh
    load_case: str
    displacement: np.ndarray
    mises: np.ndarray
    peak: StressPeak
    left_out: str = ""


@dataclass(frozen=True)
class MeshLevel:
    """One mesh of a refinement sequence and its K.

    Attributes
    ----------
    shortest_edge_mm : between corner nodes.
    K_Nm_per_rad : from the strain energy.
    K_check_Nm_per_rad : the same K from the reaction torque, or from the work of the loads; None
        where nobody computed it.
    residual : relative residual of the worst solve; None where nobody computed it.
    """

    shortest_edge_mm: float
    elements: int
    dofs: int
    K_Nm_per_rad: float
    K_check_Nm_per_rad: float | None = None
    residual: float | None = None

    def times(self, factor: float) -> MeshLevel:
        """Return the level for a Young's modulus `factor` times as large."""
        check = self.K_check_Nm_per_rad
        return replace(
            self,
            K_Nm_per_rad=self.K_Nm_per_rad * factor,
            K_check_Nm_per_rad=None if check is None else check * factor,
        )


StiffnessModel = Literal["solid", "axisymmetric"]
"""By which a stiffness was solved."""


@dataclass(frozen=True)
class Stiffness:
    """A torsional stiffness with its error bounds, N·m/rad.

    Attributes
    ----------
    guaranteed : whether both ends are theorems about the part that K is given for; else they are
        estimates.
    method : how the bounds were obtained, in plain words.
    error_scale : true error over estimated error, as found from the meshes; 1 where nothing is
        estimated.
    shortfall : why the refinement ended before its tolerance was met.
    proven_Nm_per_rad : bounds that are theorems, where those given are narrower estimates; else None.
    harmonics : shares of 1/K that the load's harmonics 0, 2, 4, … about the axis have, of a body of
        revolution under a load that varies about it; else ().
    """

    K_Nm_per_rad: float
    lower_Nm_per_rad: float
    upper_Nm_per_rad: float
    guaranteed: bool
    model: StiffnessModel
    symmetry: str
    method: str
    levels: tuple[MeshLevel, ...]
    error_scale: float = 1.0
    shortfall: Shortfall = MET
    proven_Nm_per_rad: tuple[float, float] | None = None
    harmonics: tuple[float, ...] = ()

    @property
    def bounds_Nm_per_rad(self) -> tuple[float, float]:
        """Lower and upper bound."""
        return self.lower_Nm_per_rad, self.upper_Nm_per_rad

    @property
    def width_Nm_per_rad(self) -> float:
        """Distance of the bounds."""
        return self.upper_Nm_per_rad - self.lower_Nm_per_rad

    @property
    def half_width(self) -> float:
        """Half the distance of the bounds over K."""
        return self.width_Nm_per_rad / (2 * self.K_Nm_per_rad)

    def times(self, factor: float) -> Stiffness:
        """Return the stiffness of the same body with a Young's modulus `factor` times as large."""
        proven = self.proven_Nm_per_rad
        return replace(
            self,
            K_Nm_per_rad=self.K_Nm_per_rad * factor,
            proven_Nm_per_rad=proven and (proven[0] * factor, proven[1] * factor),
            lower_Nm_per_rad=self.lower_Nm_per_rad * factor,
            upper_Nm_per_rad=self.upper_Nm_per_rad * factor,
            levels=tuple(level.times(factor) for level in self.levels),
        )


def shortest_edge_mm(points: np.ndarray, cells: np.ndarray) -> float:
    """Return the shortest edge of simplices; `cells` (m, k) number the corners among `points` [mm]."""
    first, second = np.triu_indices(cells.shape[1], 1)
    return float(np.linalg.norm(points[cells[:, first]] - points[cells[:, second]], axis=2).min())
