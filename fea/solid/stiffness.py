"""Torsional stiffness by a sequence of finer meshes, with bounds from two estimates of the error.

Prescribed rotation makes every K_h an upper bound of K (minimum potential energy). The recovery
estimate e_h of K_h's error is too small where stresses are singular, by a factor c. A first mesh takes
the usual c; two meshes give their own: K_1 − c·e_1 = K_2 − c·e_2. So K ≈ K_h − c·e_h, and the bounds are
K_h − 2c·e_h and K_h.

Where a finer mesh fails, is too large or is out of time, the answer is that of the mesh before it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from flexspline.fea.shortfall import last_mesh, next_mesh_failed
from flexspline.fea.solid.cases import Model, Solved, torsion
from flexspline.fea.solid.mesh import ENVELOPES_PER_EDGE, MeshSpec
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.types import Elastic, MeshLevel, Stiffness, TetMesh
from flexspline.geometry.errors import ComputationError

Mesher = Callable[[MeshSpec], TetMesh]
MAX_LEVELS = 5
EFFICIENCY = (1.5, 3.1)
"""Range of c believed: 1.5 to 2.8 on cups, hats and shafts, swept and not, against two-sided bounds."""
USUAL_EFFICIENCY = 2.0
"""c before two meshes can tell, the middle of those measured: the bounds hold for c up to twice it."""
NEAR_STEP, FAR_STEP = (0.25, 0.6), 0.8
"""From mesh to mesh: the singular edges hold most of the error, which is proportional to the edge
length there, so that is refined by as much as is still missing, within this range. Around them and
far away the error falls with the fourth power of growth and length: both take the second factor."""
AIM = 0.7
"""Share of the tolerance that the next mesh aims at."""


@dataclass(frozen=True)
class SolidStiffness:
    """The stiffness, the finest mesh's solution for 1 rad, and all meshes, coarse to fine."""

    stiffness: Stiffness
    meshes: tuple[TetMesh, ...]
    model: Model
    solved: Solved


def solid_stiffness(
    mesher: Mesher,
    first: MeshSpec,
    material: Elastic,
    driven: str,
    tolerance: float,
    symmetry: str,
    progress: Callable[[str], None],
) -> SolidStiffness:
    """K of a part's sector, refined until half the bounds' distance is below `tolerance`·K.

    Its `shortfall` says why where that was not reached: a finer mesh failed, or MAX_LEVELS are solved.

    Raises
    ------
    SolidError, MemoryError : from mesher and solver, of the first mesh.
    """
    spec = first
    levels: list[MeshLevel] = []
    errors: list[float] = []
    meshes: list[TetMesh] = []
    half, shortfall = np.inf, last_mesh(MAX_LEVELS)
    for _ in range(MAX_LEVELS):
        try:
            mesh = mesher(spec)
            finer = Model.of(mesh, material)
            turned = torsion(finer, driven)
            estimate = energy_error(mesh, turned.displacement, material).relative * turned.K_energy
        except (ComputationError, MemoryError) as fault:
            if not levels:
                raise
            shortfall = next_mesh_failed(fault)
            progress(f"K ± {half:.2%} stays, {shortfall}")
            break
        model, solved = finer, turned
        meshes.append(mesh)
        levels.append(level_of(solved))
        errors.append(estimate)
        c = efficiency(levels, errors) if len(levels) > 1 else USUAL_EFFICIENCY
        half = c * estimate / (solved.K_energy - c * estimate)  # of the K that is reported
        progress(f"{len(mesh.cells)} elements, K ± {half:.2%}")
        if half <= tolerance:
            shortfall = ""
            break
        spec = _finer(spec, near_step(tolerance, half))
    answer = _stiffness(levels, errors[-1], c, symmetry, shortfall)
    return SolidStiffness(answer, tuple(meshes), model, solved)


def near_step(tolerance: float, half: float) -> float:
    """Next over last edge length at the singular edges, for bounds ± `half` where `tolerance` is wanted.

    Three digits: threads add in another order, and the rounding of `half` must not ask for another mesh.
    """
    return round(float(np.clip(AIM * tolerance / half, *NEAR_STEP)), 3)


def _finer(spec: MeshSpec, near_step: float) -> MeshSpec:
    g = spec.grading
    near = g.near * near_step
    envelope = min(spec.envelope, near / ENVELOPES_PER_EDGE)
    return replace(
        spec, grading=Grading(near, g.far * FAR_STEP, g.growth * FAR_STEP), envelope=envelope
    )


def efficiency(levels: list[MeshLevel], errors: list[float]) -> float:
    """c of the last two meshes, kept within EFFICIENCY."""
    gained = levels[-2].K_Nm_per_rad - levels[-1].K_Nm_per_rad
    estimated = errors[-2] - errors[-1]
    c = gained / estimated if estimated > 0 else EFFICIENCY[1]
    return float(np.clip(c, *EFFICIENCY))


def level_of(solved: Solved) -> MeshLevel:
    """What one mesh gave."""
    return MeshLevel(
        shortest_edge_mm=solved.mesh.shortest_edge_mm,
        elements=len(solved.mesh.cells),
        dofs=solved.dofs,
        K_Nm_per_rad=solved.K_energy,
        K_check_Nm_per_rad=solved.K_reaction,
        residual=solved.residual,
    )


def _stiffness(
    levels: list[MeshLevel], error: float, c: float, symmetry: str, shortfall: str
) -> Stiffness:
    upper = levels[-1].K_Nm_per_rad
    return Stiffness(
        K_Nm_per_rad=upper - c * error,
        lower_Nm_per_rad=upper - 2 * c * error,
        upper_Nm_per_rad=upper,
        guaranteed=False,  # the lower end is an estimate
        model="solid",
        symmetry=symmetry,
        method=(
            f"recovery estimate of the energy error (Zienkiewicz-Zhu), scaled by {c:.2f}, "
            + (
                f"from the last two of {len(levels)} meshes"
                if len(levels) > 1
                else "the usual factor"
            )
            + "; K = finest mesh less the scaled estimate"
        ),
        levels=tuple(levels),
        error_scale=c,
        shortfall=shortfall,
    )
