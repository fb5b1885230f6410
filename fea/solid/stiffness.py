"""Torsional stiffness by a sequence of finer meshes, with bounds from two estimates of the error.

Prescribed rotation makes every K_h an upper bound of K (minimum potential energy). The recovery
estimate e_h of K_h's error is too small where stresses are singular, by a factor c. A first mesh takes
the usual c; two meshes give their own: K_1 − c·e_1 = K_2 − c·e_2. So K ≈ K_h − c·e_h, and the bounds are
K_h − 2c·e_h and K_h.

Where the part without holes and keyway is solved (`fea.solid.superposition`), all this is of what these
change, and K_h is what that leaves of K without them.

Where a finer mesh fails, is too large or is out of time, the answer is that of the mesh before it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from flexspline.fea.deadline import NO_DEADLINE, Deadline, OutOfTimeError
from flexspline.fea.refinement import refine
from flexspline.fea.scaled_estimate import ERROR_RATIOS, ScaledEstimate
from flexspline.fea.solid.alone import alone
from flexspline.fea.solid.mesh import ENVELOPES_PER_EDGE, MeshSpec
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.solved import SolvedStiffness
from flexspline.fea.solid.torsion_field import CorrectionError, FullTorsion, TorsionSolver
from flexspline.fea.types import Shortfall, Stiffness, TetMesh
from flexspline.geometry.percent import percent

Mesher = Callable[[MeshSpec], TetMesh]
FinerByError = Callable[[TetMesh, np.ndarray], TetMesh | None]
"""A mesh made finer where its elements' errors (m,) are; None where a specification tells the next one."""
MAX_LEVELS = 5
"""Most meshes: four refinements. Far from the singular edges the error falls to 1/36 (FAR_STEP to the 16th
power); at them the edges shrink to 1/256 at least."""
MESH_LIMIT = 2e-3
"""Relative doubt of K by the whole field. This K is an upper bound for the mesh, not for the part: straight
edges of the surface can take 1e-3 of the material (`mesh_checks.SIZE_TOLERANCE`) at places where it counts
twice."""
NEAR_STEP, FAR_STEP = (0.25, 0.6), 0.8
"""From mesh to mesh: the singular edges hold most of the error, which is proportional to the edge
length there, so that is refined by as much as is still missing, within this range. Around them and
far away the error falls with the fourth power of growth and length: both take the second factor."""
MILDER_STEPS = (0.4, NEAR_STEP[1])
"""Steps that are tried if there is no time for the wanted one. Without them a shaft meshed by fTetWild (0.1 %
asked) stayed at ± 1.8 % of its first mesh after 5 of 30 s; ± 0.8 % was possible."""
NEXT_TIME_RATIO = 2.0
"""Time of the next mesh and its solution over that of the last where the singular edges' step is the longest:
it has about twice the elements; a shorter step takes so much more. fTetWild took 12 s for 14 766 elements of
a cup, and was not done in 45 s with the shortest step."""
AIMED_SHARE = 0.9
"""Share of the tolerance that the next mesh aims at. Mostly it does better, since the usual factor of a first
mesh is cautious. With 0.7 and with 0.95 as many of 49 random shafts met the tolerance."""


@dataclass(frozen=True)
class MeshSequence:
    """The meshes of a part's sector, coarse to fine.

    Attributes
    ----------
    make, first : a mesh by its specification, and that of the first.
    by_error : the next mesh, by the errors of the last one's elements.
    most_elements : by the first mesh, the number beyond which a mesh is the last one.
    """

    make: Mesher
    first: MeshSpec
    by_error: FinerByError = lambda mesh, error: None
    most_elements: Callable[[TetMesh], float] = lambda first: inf


@dataclass(frozen=True)
class RefinedStiffness:
    """The stiffness, and all meshes, coarse to fine.

    `turned`, `change` : the finest mesh's field and what the cuts change of it, if solved (`TurnedMesh`).
    """

    stiffness: Stiffness
    meshes: tuple[TetMesh, ...]
    turned: SolvedStiffness | None
    change: np.ndarray | None


def solid_stiffness(
    meshes: MeshSequence,
    field: TorsionSolver,
    tolerance: float,
    symmetry: str,
    progress: Callable[[str], None],
    deadline: Deadline = NO_DEADLINE,
) -> RefinedStiffness:
    """Return K of a part's sector, refined until half the bounds' distance is below `tolerance`·K.

    Where a correction fails, this mesh and those after it solve all of the field. `shortfall` says why the
    tolerance was not reached: a finer mesh failed or would end after the deadline, the last has more elements
    than `meshes` allows, or MAX_LEVELS are solved.

    Raises
    ------
    SolidError, MemoryError : from mesher and solver, of the first mesh.
    """
    torsion = _SolidTorsion(meshes, field, tolerance, progress, deadline)
    mesh = torsion.mesh(meshes.first)
    # a mesh that exists is solved, however late; `finer` then ends the loop
    late = deadline.elapsed() >= deadline.limit_s
    shortfall = refine(torsion, mesh, NO_DEADLINE if late else deadline, meshes.most_elements(mesh))
    if shortfall and len(torsion.meshes) < MAX_LEVELS:
        progress(f"K ± {percent(torsion.half)} stays, {shortfall}")
    answer = torsion.answer(symmetry, shortfall)
    return RefinedStiffness(answer, tuple(torsion.meshes), torsion.turned, torsion.change)


class _SolidTorsion:
    """The meshes so far, the finest one's solution for 1 rad, and how far off its K is."""

    def __init__(
        self,
        meshes: MeshSequence,
        field: TorsionSolver,
        tolerance: float,
        progress: Callable[[str], None],
        deadline: Deadline,
    ) -> None:
        self._sequence, self._spec = meshes, meshes.first
        self._tolerance, self._progress, self._deadline = tolerance, progress, deadline
        self._last_s = 0.0  # of the last mesh, made and solved
        self._field = field
        self.meshes: list[TetMesh] = []

    def mesh(self, spec: MeshSpec) -> TetMesh:
        began_s = self._deadline.elapsed()
        mesh = self._sequence.make(spec)
        self._last_s = self._deadline.elapsed() - began_s
        return mesh

    def solve(self, mesh: TetMesh) -> None:
        if not self.meshes:
            self.estimate = _of(self._field, mesh)
        with alone(mesh.elements):
            # time spent waiting for a turn or for another program does not count
            began_s = self._deadline.working()
            self._add(Model.of(mesh, self._field.material))
            self._last_s += self._deadline.working() - began_s
        self.meshes.append(mesh)
        self._progress(f"{mesh.elements} elements, K ± {percent(self.half)}")

    def _add(self, model: Model) -> None:
        """If this raises, the results of the meshes before stay."""
        try:
            result = self._field.solve(model)
            estimate = self.estimate.with_mesh(result)
            largest = result.turned.K_energy * (1 + MESH_LIMIT) if result.turned else inf
            if estimate.at_given_angle().lower > largest:
                raise CorrectionError("the correction leaves more of K than all of the field")
        except CorrectionError as fault:
            self._progress(str(fault))
            full = FullTorsion(self._field.material, self._field.driven)
            result = full.solve(model)
            estimate = _of(full, model.mesh).with_mesh(result)
            self._field = full
        self.estimate, self._errors = estimate, result.errors
        self.turned, self.change = result.turned, result.change

    @property
    def half(self) -> float:
        """Half the bounds' distance over the K that is reported."""
        return self.estimate.at_given_angle().half

    @property
    def met(self) -> bool:
        return self.half <= self._tolerance

    def finer(self, mesh: TetMesh) -> TetMesh | None:
        if len(self.meshes) == MAX_LEVELS:
            return None
        made = self._sequence.by_error(mesh, self._errors)
        if made is not None:  # made at once, and begun by its own size if there is time (`refine`)
            believed = self._field.scales.by_error
            self.estimate = replace(self.estimate, believed=believed, falls=ERROR_RATIOS)
            return made
        left_s = self._deadline.limit_s - self._deadline.elapsed()
        wanted = near_step(self._tolerance, self.half)
        # the wanted one, else what there is time for
        steps = [wanted, *(step for step in MILDER_STEPS if step > wanted)]
        longest_s = NEXT_TIME_RATIO * NEAR_STEP[1] * self._last_s
        step = next((step for step in steps if longest_s / step < left_s), None)
        if step is None:
            raise OutOfTimeError(self._deadline.limit_s)
        self._spec = _finer(self._spec, step)
        return self.mesh(replace(self._spec, time_limit_s=min(self._spec.time_limit_s, left_s)))

    def answer(self, symmetry: str, shortfall: Shortfall) -> Stiffness:
        """The stiffness."""
        estimate, meshes = self.estimate, len(self.estimate.meshes)
        how = f"from the last two of {meshes} meshes" if meshes > 1 else "the usual factor"
        error = (
            "recovery estimate of the energy error (Zienkiewicz-Zhu), scaled by"
            f" {estimate.scale:.2f}, {how}"
        )
        return estimate.stiffness(
            estimate.at_given_angle(), "solid", symmetry, self._field.method(error), shortfall
        )


def _of(field: TorsionSolver, first: TetMesh) -> ScaledEstimate:
    """An estimate without a mesh; `first` is the mesh to come."""
    return ScaledEstimate(field.scales.before_two(first), field.scales.believed)


def near_step(tolerance: float, half: float) -> float:
    """Return the next over the last singular edge length, for bounds ± `half` where `tolerance` is wanted.

    Rounded to three digits: threads add in varying order, and the rounding of `half` must not change the
    mesh.
    """
    return round(float(np.clip(AIMED_SHARE * tolerance / half, *NEAR_STEP)), 3)


def _finer(spec: MeshSpec, near_step: float) -> MeshSpec:
    g = spec.grading
    near = g.near * near_step
    envelope = min(spec.envelope, near / ENVELOPES_PER_EDGE)
    return replace(
        spec, grading=Grading(near, g.far * FAR_STEP, g.growth * FAR_STEP), envelope=envelope
    )
