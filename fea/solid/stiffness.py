"""Torsional stiffness by a sequence of finer meshes, with bounds from two estimates of the error.

Prescribed rotation makes every K_h an upper bound of K (minimum potential energy). The recovery
estimate e_h of K_h's error is too small where stresses are singular, by a factor c. A first mesh takes
the usual c; two meshes give their own: K_1 − c·e_1 = K_2 − c·e_2. So K ≈ K_h − c·e_h, and the bounds are
K_h − 2c·e_h and K_h.

Where the part without its bolt holes is solved (`fea.solid.superposition`), all this is of what the holes
change, and K_h of the mesh is far above the K that it gives.

Where a finer mesh fails, is too large or is out of time, the answer is that of the mesh before it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.deadline import NO_DEADLINE, Deadline, OutOfTimeError
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.refinement import refine
from flexspline.fea.scaled_estimate import ERROR_RATIOS, ScaledEstimate
from flexspline.fea.solid.alone import alone
from flexspline.fea.solid.load_cases import (
    BALANCE_LIMIT,
    Solved,
    SolvedCorrection,
    SolvedStiffness,
    torsion,
    torsion_and_correction,
)
from flexspline.fea.solid.mesh import ENVELOPES_PER_EDGE, MeshSpec
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.superposition import WholeTurned
from flexspline.fea.types import (
    NMM_PER_NM,
    Elastic,
    MeshLevel,
    Shortfall,
    Stiffness,
    TetMesh,
)
from flexspline.geometry.percent import percent

Mesher = Callable[[MeshSpec], TetMesh]
FinerByError = Callable[[TetMesh, np.ndarray, float], TetMesh | None]
"""A mesh made finer where its elements' errors (m,) are, by the bounds' half-width over the tolerance; None
where a specification tells the next one."""
MAX_LEVELS = 5
"""Four refinements: far from the singular edges the error falls to 1/36 (FAR_STEP to the 16th power), and
their edges go to as little as 1/256."""
ERROR_SCALES = (1.5, 3.1)
"""Range of c believed: 1.5 to 2.8 on cups, hats and shafts, swept and not, against two-sided bounds."""
ERROR_SCALES_BY_ERROR = (2.5, 4.2)
"""The same on meshes that follow the error: 4.0 and 4.2 with 31 000 and 62 000 elements of a shaft with three
wide holes, against 128 000; its first two meshes told 2.0, and the bounds from that missed K by 0.05 %."""
USUAL_ERROR_SCALE = 2.0
"""c before two meshes can tell, the middle of those measured: the bounds hold for c up to twice it."""
HOLES_ERROR_SCALE, HOLES_ERROR_SCALES = 3.5, (3.5, 6.5)
"""The same of what holes change: 1.5 to 3.2 by the first two meshes of 22 random cups, hats and shafts, 5.1
and 6.3 on two shafts. Two meshes may tell too little: of 13 holes 45 diameters deep they told 2.5, and the
third, with more elements about the holes, fell by four times as much. They are believed from the usual on."""
NEAR_STEP, FAR_STEP = (0.25, 0.6), 0.8
"""From mesh to mesh: the singular edges hold most of the error, which is proportional to the edge
length there, so that is refined by as much as is still missing, within this range. Around them and
far away the error falls with the fourth power of growth and length: both take the second factor."""
NEXT_TIME_RATIO = 2.0
"""Time of the next mesh and its solution over that of the last where the singular edges' step is the longest:
it has about twice the elements; a shorter step takes so much more. fTetWild took 12 s for 14 766 elements of
a cup, and was not done in 45 s with the shortest step."""
AIMED_SHARE = 0.9
"""Share of the tolerance that the next mesh aims at: it mostly gives more, since the usual factor of a first
mesh is a cautious one. With 0.7 and 0.95 as many of 49 random shafts met the tolerance."""
LEAST_LEFT = 0.1
"""Of K without holes: less is the small difference of two large numbers."""
OF_THE_HOLES = (
    "the part without holes on its meridian, and what the holes change by solid meshes (Bueckner's"
    " superposition); of that change,"
)
"""How K is found so; what says how large the error is follows."""


@dataclass(frozen=True)
class MeshSequence:
    """Which meshes of a part's sector there are, coarse to fine.

    Attributes
    ----------
    make, first : a mesh by its specification, and that of the first.
    by_error : the next mesh, by the errors of the last one's elements.
    most_elements : by the first mesh, the number beyond which a mesh is the last one.
    """

    make: Mesher
    first: MeshSpec
    by_error: FinerByError = lambda mesh, error, over: None
    most_elements: Callable[[TetMesh], float] = lambda first: inf


@dataclass(frozen=True)
class RefinedStiffness:
    """The stiffness, the finest mesh's solution for 1 rad, and all meshes, coarse to fine."""

    stiffness: Stiffness
    meshes: tuple[TetMesh, ...]
    solved: Solved


def solid_stiffness(
    meshes: MeshSequence,
    material: Elastic,
    driven: str,
    tolerance: float,
    symmetry: str,
    progress: Callable[[str], None],
    deadline: Deadline = NO_DEADLINE,
    wholes: Iterator[WholeTurned] | None = None,
) -> RefinedStiffness:
    """K of a part's sector, refined until half the bounds' distance is below `tolerance`·K.

    `wholes` : the part without its holes, solved better and better, one for each mesh: where only what holes
    change is asked of the meshes.

    Its `shortfall` says why where that was not reached: a finer mesh failed or would end after the deadline,
    the last has more elements than `meshes` allows, or MAX_LEVELS are solved.

    Raises
    ------
    SolidError, MemoryError : from mesher and solver, of the first mesh.
    """
    found = _SolidTorsion(meshes, material, driven, tolerance, progress, deadline, wholes)
    mesh = found.mesh(meshes.first)
    # what is meshed is solved, however late; `finer` then ends it
    late = deadline.elapsed() >= deadline.limit_s
    shortfall = refine(found, mesh, NO_DEADLINE if late else deadline, meshes.most_elements(mesh))
    if shortfall and len(found.meshes) < MAX_LEVELS:
        progress(f"K ± {percent(found.half)} stays, {shortfall}")
    answer = found.answer(symmetry, shortfall)
    return RefinedStiffness(answer, tuple(found.meshes), found.solved)


class _SolidTorsion:
    """The meshes so far, the finest one's solution for 1 rad, and how far off its K is."""

    def __init__(
        self, meshes: MeshSequence, material: Elastic, driven: str, tolerance: float,
        progress: Callable[[str], None], deadline: Deadline,
        wholes: Iterator[WholeTurned] | None,
    ) -> None:  # fmt: skip
        self._sequence, self._spec = meshes, meshes.first
        self._material, self._driven = material, driven
        self._tolerance, self._progress, self._deadline = tolerance, progress, deadline
        self._last_s = 0.0  # of the last mesh, made and solved
        self._wholes = wholes
        self._whole: WholeTurned | None = None
        self.estimate = (
            ScaledEstimate(USUAL_ERROR_SCALE, ERROR_SCALES)
            if wholes is None
            else ScaledEstimate(HOLES_ERROR_SCALE, HOLES_ERROR_SCALES)
        )
        self.meshes: list[TetMesh] = []

    def mesh(self, spec: MeshSpec) -> TetMesh:
        began_s = self._deadline.elapsed()
        mesh = self._sequence.make(spec)
        self._last_s = self._deadline.elapsed() - began_s
        return mesh

    def solve(self, mesh: TetMesh) -> None:
        with alone(mesh.elements):
            # a turn that is waited for, or another program, is no work
            began_s = self._deadline.working()
            model = Model.of(mesh, self._material)
            if self._wholes is None or not self._solve_holes(model, self._wholes):
                self._solve_all(model)
            self._last_s += self._deadline.working() - began_s
        self.meshes.append(mesh)
        self._progress(f"{mesh.elements} elements, K ± {percent(self.half)}")

    def _solve_all(self, model: Model) -> None:
        solved = torsion(model, self._driven)
        error = energy_error(model.mesh, solved.displacement, self._material)
        self.solved, self._errors = solved, error.error
        self.estimate.add(level_of(solved), error.relative)

    def _solve_holes(self, model: Model, wholes: Iterator[WholeTurned]) -> bool:
        """False where that fails, or cannot be: from then on meshes solve all of the field."""
        self._whole = whole = next(wholes, self._whole)
        assert whole is not None
        try:
            if self._added(torsion_and_correction(model, self._driven, whole), whole):
                return True
            self._progress("what the holes change says too little of K")
        except (MeshingError, MeshQualityError) as fault:
            self._progress(str(fault))
        self._wholes = None
        self.estimate = ScaledEstimate(USUAL_ERROR_SCALE, ERROR_SCALES)
        return False

    def _added(self, found: tuple[SolvedStiffness, SolvedCorrection], whole: WholeTurned) -> bool:
        """Whether K is known by it, and not above that of the whole field, which it never is."""
        (solved, correction), known = found, whole.solved.stiffness
        K = known.K_Nm_per_rad - correction.lost / NMM_PER_NM
        if LEAST_LEFT * known.K_Nm_per_rad > K:
            return False
        error = energy_error(correction.mesh, correction.displacement, self._material)
        estimate = error.error.sum() * 360 / correction.mesh.sector_deg / NMM_PER_NM
        doubt = known.width_Nm_per_rad / 2 + correction.doubt / NMM_PER_NM
        self.solved, self._errors = solved, error.error
        self.estimate.add(level_of(solved), float(estimate / K), K, doubt / K)
        return self.estimate.at_given_angle().lower <= solved.K_energy * (1 + BALANCE_LIMIT)

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
        made = self._sequence.by_error(mesh, self._errors, self.half / self._tolerance)
        if made is not None:  # made at once, and begun by its own size if there is time (`refine`)
            own = ERROR_SCALES_BY_ERROR if self._wholes is None else HOLES_ERROR_SCALES
            self.estimate.believed, self.estimate.falls = own, ERROR_RATIOS
            return made
        step = near_step(self._tolerance, self.half)
        left_s = self._deadline.limit_s - self._deadline.elapsed()
        if NEXT_TIME_RATIO * NEAR_STEP[1] / step * self._last_s >= left_s:
            raise OutOfTimeError(self._deadline.limit_s)
        self._spec = _finer(self._spec, step)
        return self.mesh(replace(self._spec, time_limit_s=min(self._spec.time_limit_s, left_s)))

    def answer(self, symmetry: str, shortfall: Shortfall) -> Stiffness:
        """The stiffness; its lower end is an estimate."""
        estimate, meshes = self.estimate, len(self.meshes)
        found = estimate.at_given_angle()
        how = f"from the last two of {meshes} meshes" if meshes > 1 else "the usual factor"
        recovery = (
            "recovery estimate of the energy error (Zienkiewicz-Zhu), scaled by"
            f" {estimate.scale:.2f}, {how}"
        )
        if self._wholes is None:
            method = f"{recovery}; K = finest mesh less the scaled estimate"
        else:
            method = f"{OF_THE_HOLES} {recovery}"
        return Stiffness(
            K_Nm_per_rad=found.K,
            lower_Nm_per_rad=found.lower,
            upper_Nm_per_rad=found.upper,
            guaranteed=False,  # the lower end is an estimate
            model="solid",
            symmetry=symmetry,
            method=method,
            levels=tuple(estimate.levels),
            error_scale=estimate.scale,
            shortfall=shortfall,
        )


def near_step(tolerance: float, half: float) -> float:
    """Next over last edge length at the singular edges, for bounds ± `half` where `tolerance` is wanted.

    Three digits: threads add in another order, and the rounding of `half` must not ask for another mesh.
    """
    return round(float(np.clip(AIMED_SHARE * tolerance / half, *NEAR_STEP)), 3)


def _finer(spec: MeshSpec, near_step: float) -> MeshSpec:
    g = spec.grading
    near = g.near * near_step
    envelope = min(spec.envelope, near / ENVELOPES_PER_EDGE)
    return replace(
        spec, grading=Grading(near, g.far * FAR_STEP, g.growth * FAR_STEP), envelope=envelope
    )


def level_of(solved: SolvedStiffness) -> MeshLevel:
    """What one mesh gave."""
    return MeshLevel(
        shortest_edge_mm=solved.mesh.shortest_edge_mm,
        elements=len(solved.mesh.cells),
        dofs=solved.dofs,
        K_Nm_per_rad=solved.K_energy,
        K_check_Nm_per_rad=solved.K_check,
        residual=solved.residual,
    )
