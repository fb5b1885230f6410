"""Load cases of a solid model: supports, prescribed motion, loads, and the resulting stiffness."""

from __future__ import annotations

from math import pi

import numpy as np
from skfem import Functional, LinearForm

from flexspline.fea.axisymmetric.field_at_points import FieldAtPoints
from flexspline.fea.axisymmetric.lobes import LOBE_HALF_WIDTH
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.errors import SolveError
from flexspline.fea.lobe_torque import LOBE_TORQUE_NMM, stiffness_of_work
from flexspline.fea.solid.cyclic import SolvedWave, WaveSupports, larger_deg, repeats_of
from flexspline.fea.solid.harmonic_walls import harmonic_walls
from flexspline.fea.solid.model import Model, Supports
from flexspline.fea.solid.solved import Solved, SolvedCorrection, SolvedStiffness
from flexspline.fea.solid.solver import Solution
from flexspline.fea.solid.superposition import (
    TurnedWalls,
    Walls,
    WholeTurned,
    WholeUnderLobes,
    lobed_walls,
    turned_walls,
)
from flexspline.fea.solid.unfold import Parity, unfolding
from flexspline.fea.solid.waves import CyclicWave, waves
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.part import Part

BALANCE_LIMIT = 1e-6
"""Largest relative difference of K by energy and K by reaction. Measured: 1e-12 to 1e-9."""
HELD_LIMIT = 1e-3
"""The same for the held face's torque after an iteration. Its error goes with the square root of the error's
energy, which leaves 3e-4."""
LOBE_DEGREE = 8
"""Degree of the quadrature. Compared with degree 12, the torque on the example's ring is off by 2e-9 with
degree 4 and by 1e-11 with degree 6."""
LEFT_OUT = 100.0
"""Assumed upper limit of a(v, v) over E of a wave. All waves of four random parts: 0.8 to 2.3."""
FORCES = LinearForm(lambda v, w: w.traction * v, dtype=complex)
TORQUE_OF_TRACTION = Functional(lambda w: w.traction * np.hypot(w.x[0], w.x[1]))
"""Torque about z of a tangential traction."""


def torsion(model: Model, driven: str) -> SolvedStiffness:
    """Hold `mount` and turn every point of `driven` rigidly about z by 1 rad; K comes from both routes.

    Raises
    ------
    SolveError : residual, or energy and reaction disagree beyond the limits.
    """
    supports = _turned(model, driven)
    return _balanced(model, driven, supports.solve(np.zeros(model.matrix.shape[0])))


def torsion_and_correction(
    model: Model, driven: str, whole: WholeTurned
) -> tuple[SolvedStiffness, SolvedCorrection]:
    """Return `torsion`, and the change by the cuts in the body without them, by the same factors.

    Raises
    ------
    SolveError : as `torsion`. MeshingError, MeshQualityError : as `turned_walls` and `Walls.of`.
    """
    walls, before = _walls_of(model, whole)
    forces = model.frames.to_cylindrical(walls.forces).ravel()
    turned, corrected = _turned(model, driven).solve_also_at_rest(np.zeros_like(forces), forces)
    return _balanced(model, driven, turned), _correction(model, walls, before, corrected)


def torsion_correction(model: Model, driven: str, whole: WholeTurned) -> SolvedCorrection:
    """Return the change by the cuts alone; errors are those of `torsion_and_correction`."""
    walls, before = _walls_of(model, whole)
    forces = model.frames.to_cylindrical(walls.forces).ravel()
    return _correction(model, walls, before, _turned(model, driven).solve_at_rest(forces))


def torsion_change(
    model: Model, driven: str, part: Part, without_cuts: FieldAtPoints
) -> np.ndarray:
    """Return what the cuts change of the displacement (n, 3) [mm], Cartesian, at the turn of that field.

    Raises
    ------
    SolveError. MeshingError, MeshQualityError : as `harmonic_walls` and `Walls.of`.
    """
    _, forces = harmonic_walls(Walls.of(model.mesh, part), without_cuts, repeats_of(model.mesh))
    load = model.frames.to_cylindrical(forces).ravel()
    return model.frames.to_cartesian(
        _turned(model, driven).solve_at_rest(load).unknowns.reshape(-1, 3)
    )


def _walls_of(model: Model, whole: WholeTurned) -> tuple[TurnedWalls, TurnedWalls]:
    """Forces on the walls by the fine and by the coarse solution of the body without cuts."""
    on = Walls.of(model.mesh, whole.part)
    fine, coarse = (turned_walls(on, s, model.material) for s in (whole.solved, whole.coarser))
    return fine, coarse


def _correction(
    model: Model, walls: TurnedWalls, before: TurnedWalls, corrected: Solution
) -> SolvedCorrection:
    v = corrected.unknowns
    lost = walls.energy + float(v @ (model.matrix @ v)) * model.copies
    displacement = model.frames.to_cartesian(v.reshape(-1, 3))
    work, before_s = (
        float(np.sum(w.forces * displacement)) * model.copies for w in (walls, before)
    )
    doubt = abs(walls.energy - before.energy + 2 * (work - before_s))
    return SolvedCorrection(
        model.mesh, displacement, lost, walls.energy + work, doubt,
        corrected.free_count, corrected.residual,
    )  # fmt: skip


def _turned(model: Model, driven: str) -> Supports:
    supports = Supports(model)
    supports.symmetry(antisymmetric=True)
    nodes = model.on(driven)
    for component in (RADIAL, AXIAL):
        supports.set(nodes, component)
    supports.set(nodes, TANGENTIAL, model.frames.radius[nodes])
    supports.hold("mount")
    return supports


def _balanced(model: Model, driven: str, solution: Solution) -> SolvedStiffness:
    nodes = model.on(driven)
    twice_energy = solution.unknowns @ (model.matrix @ solution.unknowns)
    torque = solution.reactions[3 * nodes + TANGENTIAL] @ model.frames.radius[nodes]
    held = model.on("mount")
    opposite = solution.reactions[3 * held + TANGENTIAL] @ model.frames.radius[held]
    held_limit = HELD_LIMIT if solution.solver == "iterative" else BALANCE_LIMIT
    for other, limit in ((twice_energy, BALANCE_LIMIT), (-opposite, held_limit)):
        if abs(other / torque - 1) > limit:
            raise SolveError(
                f"torques do not balance: driven {torque:.9g}, held {-opposite:.9g},"
                f" from energy {twice_energy:.9g} N·mm"
            )
    scale = model.copies / NMM_PER_NM
    return SolvedStiffness(
        model.mesh, model.frames.to_cartesian(solution.unknowns.reshape(-1, 3)), solution.residual,
        solution.free_count, solution.solver, float(twice_energy * scale), float(torque * scale),
    )  # fmt: skip


def lobes(model: Model, supported: bool) -> SolvedStiffness:
    """Let the torque enter at the two lobes; `supported`: the seat may not move radially.

    The model is half a repeat of the part, as `cyclic.half_repeat`. The field is that of its quarter or half
    for a torque of 1 N·m on the whole part; K = T²/(2·strain energy).
    """
    loads, torque = _lobe_loads(model)
    solved_waves = []
    for wave, load in loads.items():
        supports = _under_lobes(model, wave, supported)
        solved_waves.append(supports.solve(load * (LOBE_TORQUE_NMM / torque)))
    stored, work = sum(w.stored for w in solved_waves), sum(w.work for w in solved_waves)
    solved = _of_waves(model, solved_waves, "antisymmetric")
    return SolvedStiffness(
        **vars(solved), K_energy=stiffness_of_work(stored), K_check=stiffness_of_work(work)
    )


def lobe_correction(
    model: Model, supported: bool, whole: WholeUnderLobes, least: float = 0.0
) -> SolvedCorrection:
    """Return the change by the holes under the lobes' whole torque; model and mesh are those of `lobes`.

    Waves are not solved if their v together stores less than `least` [N·mm]. The most that they may store,
    LEFT_OUT times their E, is added to the doubt.

    Raises
    ------
    SolveError. MeshingError, MeshQualityError : as `lobed_walls` and `Walls.of`.
    """
    repeats, solved_waves, lost, moved, left_out = repeats_of(model.mesh), [], 0.0, 0.0, 0.0
    on = Walls.of(model.mesh, whole.part)
    both = (
        lobed_walls(on, repeats, solved, model.material) for solved in (whole.solved, whole.coarser)
    )
    # zip ends with the solution of fewer harmonics, hence fewer waves
    pairs = sorted(zip(*both, strict=False), key=lambda pair: pair[0].energy)
    while len(pairs) > 1 and left_out + LEFT_OUT * pairs[0][0].energy < least:
        walls, _ = pairs.pop(0)
        lost += walls.energy
        left_out += LEFT_OUT * walls.energy
    for walls, before in pairs:
        supports = _under_lobes(model, walls.wave, supported)
        solved_waves.append(supports.solve(model.frames.to_cylindrical(walls.forces)))
        lost += walls.energy + solved_waves[-1].stored
        v = model.frames.to_cartesian(solved_waves[-1].values)
        work = float(np.sum((walls.forces - before.forces).conjugate() * v).real)
        moved += walls.energy - before.energy + 2 * work * walls.wave.times * model.copies
    solved = _of_waves(model, solved_waves, "antisymmetric")
    by_work = lost + sum(w.work - w.stored for w in solved_waves)
    return SolvedCorrection(
        solved.mesh, solved.displacement, lost, by_work, abs(moved) + left_out,
        solved.dofs, solved.residual,
    )  # fmt: skip


def _under_lobes(model: Model, wave: CyclicWave, supported: bool) -> WaveSupports:
    supports = WaveSupports(model, wave, antisymmetric=True)
    if supported:
        supports.set(model.on("seat"), RADIAL)
    supports.hold("mount")
    return supports


def _lobe_loads(model: Model) -> tuple[dict[CyclicWave, np.ndarray], float]:
    """Nodal forces (n, 3) of a unit lobe traction [MPa] by wave, complex; its torque on the part [N·mm]."""
    basis = model.space.facet_basis("mesh", LOBE_DEGREE)
    x, y, _ = np.asarray(basis.global_coordinates())
    phi = np.arctan2(y, x)
    repeats = repeats_of(model.mesh)
    loads = {}
    for wave in waves(range(0, 2 * repeats, 2), repeats):
        loads[wave] = np.zeros((len(model.mesh.nodes), 3), complex)
        forces = FORCES.assemble(basis, traction=wave.of(_lobe_traction, phi))
        loads[wave][model.space.node, TANGENTIAL] = forces
    mean = CyclicWave(0, repeats).of(_lobe_traction, phi)
    return loads, float(TORQUE_OF_TRACTION.assemble(basis, traction=mean)) * model.copies


def _lobe_traction(phi: np.ndarray) -> np.ndarray:
    """Of unit height at both ends of the major axis; `phi` [rad] is any angle."""
    off = np.abs((phi + pi / 2) % pi - pi / 2)  # from the nearer end of the major axis
    return np.where(off < LOBE_HALF_WIDTH, np.cos(pi * off / (2 * LOBE_HALF_WIDTH)) ** 2, 0.0)


def ellipse(model: Model, w0_mm: float) -> Solved:
    """Hold `mount` and give `seat` the radial displacement w0·cos 2φ; its other components are free.

    The model is half a repeat, the field the quarter's or half's, as of `lobes`.
    """
    nodes = model.on("seat")
    phi = np.arctan2(model.mesh.nodes[nodes, 1], model.mesh.nodes[nodes, 0])
    (wave,) = waves((2,), repeats_of(model.mesh))
    shape = wave.of(lambda angle: w0_mm * np.cos(2 * angle), phi)
    solved = _on_seat(model, wave, shape, np.zeros((len(model.mesh.nodes), 3)))
    return _of_waves(model, [solved], "symmetric")


def ellipse_correction(model: Model, part: Part, without_holes: FieldAtPoints) -> Solved:
    """Return what the bolt holes change of `ellipse`, on the same mesh, from the field without them.

    Raises
    ------
    SolveError. MeshingError, MeshQualityError : as `harmonic_walls` and `Walls.of`.
    """
    walls = Walls.of(model.mesh, part)
    wave, forces = harmonic_walls(walls, without_holes, repeats_of(model.mesh))
    solved = _on_seat(model, wave, 0.0, model.frames.to_cylindrical(forces))
    return _of_waves(model, [solved], "symmetric")


def _on_seat(
    model: Model, wave: CyclicWave, radial_mm: np.ndarray | float, load: np.ndarray
) -> SolvedWave:
    supports = WaveSupports(model, wave, antisymmetric=False)
    supports.set(model.on("seat"), RADIAL, radial_mm)
    supports.hold("mount")
    return supports.solve(load)


def _of_waves(model: Model, solved_waves: list[SolvedWave], parity: Parity) -> Solved:
    """Waves of half a repeat, unfolded to a quarter of the part, or to a half if n is odd."""
    whole = unfolding(model.mesh, larger_deg(model.mesh))
    u = np.zeros((whole.copies, len(model.mesh.nodes), 3))
    for copy, values in enumerate(u):
        for w in solved_waves:
            values += model.frames.to_cartesian(w.wave.on_copy(w.values, copy))
    return Solved(
        whole.mesh, whole.vectors(u, parity),
        max(w.residual for w in solved_waves), sum(w.free_count for w in solved_waves),
        solved_waves[0].solver,
    )  # fmt: skip
