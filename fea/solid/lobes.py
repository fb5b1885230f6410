"""K_b when the torque enters at the two lobes, on finer and finer solid meshes.

Which meshes: without the seat's support the rim ovalises, which a mesh made for torsion cannot follow. Two
things matter (docs/decisions.md): steps about the axis that are short against √(R t), and a meridian that
is fine where this load bends it, which the harmonics of the part without holes tell at little cost.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import sqrt

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.lobes import solve_lobes
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.torsion import bulk
from flexspline.fea.shortfall import last_mesh, next_mesh_failed
from flexspline.fea.solid.cases import Model, lobes
from flexspline.fea.solid.column import INTERFACE
from flexspline.fea.solid.stiffness import efficiency, level_of
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS, Finer
from flexspline.fea.types import Elastic, MeshLevel, Stiffness, TetMesh
from flexspline.geometry.errors import ComputationError

STEP = 0.40
"""Of √(t/R), about the axis, for 0.5 %: 3.3° on a wall of a fiftieth of the radius. The error of quadratic
elements goes with the step's fourth power."""
MERIDIAN_SHARE = 0.3
"""Of the tolerance: what the harmonics' estimate of the meridian's error may be. The usual scale of 2 makes
0.6 of the tolerance of it; the steps take about half as much."""
BULK = 0.4
"""Share of that error whose triangles are refined each round: more rounds, fewer triangles too many."""
TAIL = 1e-3
"""Of the energy: harmonics beyond play no part in where the mesh is refined."""
NEXT_STEP, NEXT_SHARE = 0.7, 0.4
"""From mesh to mesh, where the first one did not do."""


def finer_mesh(
    wall_mm: float, radius_mm: float, material: Elastic, tolerance: float, number: int
) -> Finer:
    """What the mesh of that number (0, 1, …) of the case without support asks for."""
    step = STEP * sqrt(wall_mm / radius_mm) * (tolerance / 0.005) ** 0.25 * NEXT_STEP**number
    wanted = MERIDIAN_SHARE * tolerance * NEXT_SHARE**number

    def adapted(mesh: MeridianMesh) -> MeridianMesh:
        while True:
            model = HarmonicModel(mesh, material)
            found = solve_lobes(model, False, TAIL, held=("mount", INTERFACE))
            if found.estimate < wanted or len(mesh.triangles) > MOST_ELEMENTS:
                return mesh
            mesh = refined(mesh, bulk(found.error, BULK))

    return Finer(step, adapted=adapted, even=True)


def lobe_stiffness(
    meshes: Iterator[tuple[TetMesh, float]],
    material: Elastic,
    supported: bool,
    tolerance: float,
    symmetry: str,
    progress: Callable[[str], None],
) -> Stiffness:
    """K_b = T²/(2·strain energy) with its bounds, on one mesh after the other until they meet `tolerance`.

    A given load stores too little energy on a mesh, so K_h is an upper bound here too. The recovery
    estimate times a scale is taken off it: the one that comes with the first mesh, then what the last
    two say (see `fea.solid.stiffness`). Where a mesh after the first fails, or there are no more,
    `shortfall` says so.

    Raises
    ------
    ComputationError, MemoryError : of the first mesh.
    """
    levels: list[MeshLevel] = []
    errors: list[float] = []
    shortfall = ""
    while True:
        try:
            given = next(meshes, None)
            if given is None:
                shortfall = last_mesh(len(levels))
                break
            mesh, usual = given
            solved = lobes(Model.of(mesh, material), supported)
            relative = energy_error(mesh, solved.displacement, material).relative
        except (ComputationError, MemoryError) as fault:
            if not levels:
                raise
            shortfall = next_mesh_failed(fault)
            break
        levels.append(level_of(solved))
        errors.append(relative * solved.K_energy)
        scale = efficiency(levels, errors) if len(levels) > 1 else usual
        error = scale * relative
        progress(f"{len(mesh.cells)} elements, {symmetry} of the part, K ± {error:.2%}")
        if error <= tolerance:
            break
    upper = levels[-1].K_Nm_per_rad
    return Stiffness(
        K_Nm_per_rad=upper / (1 + error),
        lower_Nm_per_rad=upper / (1 + 2 * error),
        upper_Nm_per_rad=upper,
        guaranteed=False,  # the lower end is an estimate
        model="solid",
        symmetry=symmetry,
        method=(
            f"recovery estimate of the energy error under the lobes (Zienkiewicz-Zhu), scaled by {scale:.2f}"
        ),
        levels=tuple(levels),
        error_scale=scale,
        shortfall=shortfall,
    )
