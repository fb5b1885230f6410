"""K_b when the torque enters at the two lobes, on finer and finer solid meshes.

Without the seat's support the rim ovalises, and a mesh made for torsion cannot follow. Two things matter
(docs/decisions.md): steps about the axis that are short against √(R t), and a meridian that is fine where
this load bends it, which the harmonics of the part without holes tell at little cost.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf, sqrt

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.lobes import solve_lobes
from flexspline.fea.axisymmetric.marking import bulk
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.deadline import Deadline
from flexspline.fea.refinement import refine
from flexspline.fea.scaled_estimate import ScaledEstimate
from flexspline.fea.solid.alone import alone
from flexspline.fea.solid.column import INTERFACE
from flexspline.fea.solid.cyclic import half_repeat, larger_deg
from flexspline.fea.solid.lobe_field import LobeSolver
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS, Finer
from flexspline.fea.types import Elastic, Stiffness, TetMesh
from flexspline.geometry.percent import percent

LOBE_STEP = 0.37
"""Step about the axis over √(t/R) [rad], for 0.5 %: 3.0° on a wall of a fiftieth of the radius. The error of
quadratic elements goes with the fourth power of the step. With 0.40, and 0.3 of the tolerance on the
meridian, two of six first meshes of random parts missed their tolerance by 2 and 14 %, and a second one took
15 and 11 s of the processor."""
MERIDIAN_SHARE = 0.25
"""The harmonics' estimate of the meridian's error may take this share of the tolerance. With the usual scale
of 2 this is half of the tolerance, and the steps take about a quarter."""
SOLID_BULK = 0.4
"""Share of that error in the triangles that each round refines. Judgement: small shares take more rounds but
refine fewer triangles needlessly."""
TAIL = 1e-3
"""Harmonics that add less than this share of the energy do not count in the choice of triangles to refine.
Judgement."""
STEP_TOLERANCE = 0.005
"""Tolerance of K to which LOBE_STEP belongs. The error of parabolas goes with the fourth power of the
step."""
NEXT_STEP, NEXT_SHARE = 0.7, 0.4
"""Factors of the step and of the share from mesh to mesh, if the first one misses the tolerance. 0.7⁴ is a
quarter. Judgement."""


def finer_mesh(
    wall_mm: float, radius_mm: float, material: Elastic, tolerance: float, number: int
) -> Finer:
    """Requirements of the case without support on its mesh number 0, 1, …."""
    step = (
        LOBE_STEP
        * sqrt(wall_mm / radius_mm)
        * (tolerance / STEP_TOLERANCE) ** 0.25
        * NEXT_STEP**number
    )
    wanted = MERIDIAN_SHARE * tolerance * NEXT_SHARE**number

    def adapted(mesh: MeridianMesh) -> MeridianMesh:
        meridian = _FreeRim(material, wanted)
        refine(meridian, mesh, most_elements=MOST_ELEMENTS)
        return meridian.mesh

    return Finer(step, adapted=adapted, even=True)


class _FreeRim:
    """The finest meridian mesh on which the harmonics of a rim without support were solved."""

    def __init__(self, material: Elastic, wanted: float) -> None:
        self._material, self._wanted = material, wanted

    def solve(self, mesh: MeridianMesh) -> None:
        model = HarmonicModel(mesh, self._material)
        self._solution = solve_lobes(model, False, TAIL, held=("mount", INTERFACE))
        self.mesh = mesh

    @property
    def met(self) -> bool:
        return self._solution.estimate < self._wanted

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        return refined(mesh, bulk(self._solution.error, SOLID_BULK))


def lobe_stiffness(
    meshes: Iterator[tuple[TetMesh, float]],
    field: LobeSolver,
    tolerance: float,
    symmetry: str,
    progress: Callable[[str], None],
    limit_s: float = inf,
) -> Stiffness:
    """Return K_b = T²/(2·strain energy) with its bounds; refine until they meet `tolerance`.

    The meshes are of half a repeat of the part, the levels those of its quarter or half, as `symmetry` says.
    A given load stores too little energy on a mesh, so K_h is an upper bound here too. The recovery
    estimate times a scale is taken off it: the one that comes with the first mesh, then what the last
    two say (see `fea.solid.stiffness`). Where a mesh after the first fails, or would end `limit_s` seconds
    after that was made, or there are no more, `shortfall` says so.

    Raises
    ------
    ComputationError, MemoryError : of the first mesh.
    """
    mesh, usual = next(meshes)
    estimate = ScaledEstimate(usual, field.scales.believed)
    rest = (mesh for mesh, _ in meshes)
    lobes = _SolidLobes(rest, field, tolerance, symmetry, progress, estimate)
    shortfall = refine(lobes, mesh, Deadline(limit_s))
    estimate = lobes.estimate
    method = field.method(
        "recovery estimate of the energy error under the lobes (Zienkiewicz-Zhu), scaled by"
        f" {estimate.scale:.2f}"
    )
    return estimate.stiffness(estimate.at_given_torque(), "solid", symmetry, method, shortfall)


@dataclass
class _SolidLobes:
    """The case on one mesh after the other, the rest after the first; what they gave is in `estimate`."""

    meshes: Iterator[TetMesh]
    field: LobeSolver
    tolerance: float
    symmetry: str
    progress: Callable[[str], None]
    estimate: ScaledEstimate

    def solve(self, mesh: TetMesh) -> None:
        with alone(round(mesh.elements * larger_deg(mesh) / mesh.sector_deg)):
            model = Model.of(half_repeat(mesh), self.field.material)
            result = self.field.solve(model)
        self.estimate = self.estimate.with_mesh(result)
        self.progress(
            f"{result.level.elements} elements, {self.symmetry} of the part, K ± {percent(self.half)}"
        )

    @property
    def half(self) -> float:
        """Half the bounds' distance over K."""
        return self.estimate.at_given_torque().half

    @property
    def met(self) -> bool:
        return self.half <= self.tolerance

    def finer(self, mesh: TetMesh) -> TetMesh | None:
        return next(self.meshes, None)
