"""The plain ring with the same stiffness as a toothed ring."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined_while
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.refinement import refine
from flexspline.fea.toothed_ring import plain
from flexspline.fea.toothed_ring.cell import CellModel, ToothedRingError
from flexspline.geometry.tooth import ToothCell

SMALLEST_CHANGE = 1e-4
"""Relative change of every thickness over a refinement at which the mesh is fine enough."""
GRADING = 3.3
"""At the root's notch edges shrink with this power of the others: the energy that a corner of 250°
loses falls with the edge there to the power 1.2, quadratic elements elsewhere with the fourth."""
LARGEST_CHANGE = 1e-3
"""Largest relative change that is accepted if the next mesh would be too large. It happens with thin rims
under wide teeth, where every corner counts. A tenth of a percent of the thickness is below any tolerance of
manufacture."""
MOST_TRIANGLES = 100_000
"""Some 15 s of one core; the next mesh has four times as many and takes as many minutes."""


@dataclass(frozen=True)
class EquivalentRing:
    """Thicknesses of plain rings on the same inner surface [mm].

    Attributes
    ----------
    rim_mm : under the tooth roots, as designed.
    bending_mm : as stiff against a change of curvature; what a plain model should use.
    membrane_mm : as stiff against growing all round.
    torsion_mm : as stiff against torsion about the axis.
    change : largest relative change of the three over the last refinement, at most `LARGEST_CHANGE`.
        All come from above and
        each refinement changes them by a small part of the one before, so it exceeds the error.
    elements : triangles of the finest mesh.
    """

    rim_mm: float
    bending_mm: float
    membrane_mm: float
    torsion_mm: float
    change: float
    elements: int

    @property
    def difference_pct(self) -> float:
        """Bending thickness over rim thickness, less one [%]."""
        return 100 * (self.bending_mm / self.rim_mm - 1)


def equivalent_ring(cell: ToothCell, poissons_ratio: float) -> EquivalentRing:
    """Solve a tooth cell on finer and finer meshes, and compare with plain rings.

    Plane strain; Young's modulus plays no part, Poisson's ratio only in the membrane thickness.

    Raises
    ------
    MeshingError, ToothedRingError
    """
    rings = _Rings(cell, poissons_ratio)
    refine(rings, rings.first_mesh())
    if not rings.change < LARGEST_CHANGE:
        raise ToothedRingError(
            f"the equivalent ring still changes by {rings.change:.1e} on {rings.elements} "
            f"triangles, wanted {LARGEST_CHANGE:.0e}: ring_thickness_mm may be too small a part of "
            'module_mm; teeth = "none" works'
        )
    bending, membrane, torsion = rings.thicknesses.tolist()
    rim = cell.root - cell.inner
    return EquivalentRing(rim, bending, membrane, torsion, rings.change, rings.elements)


class _Rings:
    """The three thicknesses by the finest mesh so far, and how much the last refinement changed them."""

    def __init__(self, cell: ToothCell, poissons_ratio: float) -> None:
        self._cell, self._nu = cell, poissons_ratio
        self._share = 1.0
        self.thicknesses, self.change, self.elements = np.full(3, np.inf), np.inf, 0

    def first_mesh(self) -> MeridianMesh:
        """No edge longer than the tooth's half pitch."""
        return self._sized(triangulate(self._cell.outline))

    def solve(self, mesh: MeridianMesh) -> None:
        thicknesses = np.array(_thicknesses(CellModel(self._cell, mesh), self._nu))
        self.change = float((self.thicknesses / thicknesses - 1).max())
        self.thicknesses, self.elements = thicknesses, mesh.elements

    @property
    def met(self) -> bool:
        return self.change < SMALLEST_CHANGE

    def finer(self, mesh: MeridianMesh) -> MeridianMesh | None:
        self._share /= 2
        finer = self._sized(mesh)
        return finer if finer.elements <= MOST_TRIANGLES else None

    def _sized(self, mesh: MeridianMesh) -> MeridianMesh:
        width = self._cell.unroll * self._cell.half_pitch
        return _finer(mesh, self._cell, self._share * width, self._share**GRADING * width)


def _thicknesses(model: CellModel, nu: float) -> tuple[float, float, float]:
    """For bending, membrane and torsion [mm]."""
    inner = model.cell.inner
    return (
        plain.thickness(plain.bending, inner, model.bending(nu)),
        plain.thickness(lambda a, b: plain.membrane(a, b, nu), inner, model.membrane(nu)),
        plain.thickness(plain.torsion, inner, model.torsion()),
    )


def _finer(mesh: MeridianMesh, cell: ToothCell, size: float, at_notch: float) -> MeridianMesh:
    """No edge longer than `size`, nor than `at_notch` on triangles that touch the root's notch."""
    notch = np.linalg.norm(mesh.points - np.array(cell.root_corner), axis=1).argmin()

    def too_long(mesh: MeridianMesh) -> np.ndarray:
        touching = (mesh.triangles == notch).any(axis=1)
        return np.asarray(mesh.longest_edges() > np.where(touching, at_notch, size))

    return refined_while(mesh, too_long)
