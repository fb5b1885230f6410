"""One cyclic wave of a part with n repeats, solved on half a repeat.

The load is even or odd at angle 0, so of a wave u = a + i b the one field is antisymmetric there and the
other symmetric, and at the other plane of half a repeat the same holds for exp(−iγ) u, γ = π p/n. With w =
exp(−iγ) u on that plane, u elsewhere, the two fields have the supports of a torsion and of an ellipse, and

    K_w = D* K D,    D = exp(iγ) on the plane, 1 elsewhere,

couples them at its entries between the plane and the rest: a real matrix of twice the unknowns of half a
repeat. Waves of p = 0 and p = n/2 are real: one field, at the second plane of the same or of the other
symmetry (docs/theory.md, "Waves on half a repeat").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix

from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.solid.memory import SolverKind
from flexspline.fea.solid.model import Model, Supports
from flexspline.fea.solid.solver import Case, Solution, solve
from flexspline.fea.solid.twolevel import corner_interpolation
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.solid.waves import CyclicWave
from flexspline.fea.types import TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

HALF_DEG = 180.0
"""[deg] Half of the circle. Half a repeat of a part with n repeats is one n-th of it."""


def repeats_of(mesh: TetMesh) -> int:
    """Return the number of repeats n of the part of which the mesh is half a repeat; 1 for a half or all."""
    return max(1, round(HALF_DEG / mesh.sector_deg))


def larger_deg(mesh: TetMesh) -> float:
    """Return the sector [deg] that stands for the part under two lobes: a quarter if n is even, else half."""
    return max(mesh.sector_deg, HALF_DEG if repeats_of(mesh) % 2 else HALF_DEG / 2)


def half_repeat(mesh: TetMesh) -> TetMesh:
    """Return the mesh, or that of the part's half where n is odd and the part has an axis.

    On half a repeat a wave of order 1 moves the axis sideways, which would couple its two fields there.
    """
    on_axis = (np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1]) == 0).any()
    odd = repeats_of(mesh) % 2 == 1
    return unfolded(mesh, HALF_DEG) if on_axis and odd and mesh.sector_deg < HALF_DEG else mesh


@dataclass(frozen=True)
class SolvedWave:
    """A wave on half a repeat.

    Attributes
    ----------
    values : (n, 3) mm along the nodes' axes, complex. stored, work : twice the strain energy, and the work
        of its load, of the wave and its conjugate on the whole part [N·mm].
    """

    wave: CyclicWave
    values: np.ndarray
    stored: float
    work: float
    residual: float
    free_count: int
    solver: SolverKind


class WaveSupports:
    """Prescribed components of a wave; a later value replaces an earlier one.

    `antisymmetric`: under a reflection at angle 0 the load behaves as torsion, else as the ellipse.
    """

    def __init__(self, model: Model, wave: CyclicWave, antisymmetric: bool) -> None:
        self._model, self._wave = model, wave
        self._parts = [Supports(model) for _ in range(wave.times)]
        if wave.is_real:
            self._parts[0].symmetry(antisymmetric, (SYMMETRY_START,))
            self._parts[0].symmetry(antisymmetric ^ (wave.number > 0), (SYMMETRY_END,))
        else:
            self._parts[0].symmetry(antisymmetric)
            self._parts[1].symmetry(not antisymmetric)
        if wave.number:
            self._hold_axis()

    def _hold_axis(self) -> None:
        """Only orders 0 and 1 move it, and no wave of order 1 comes here with an axis (`half_repeat`)."""
        axis = np.flatnonzero(self._model.frames.radius == 0)
        for component in (RADIAL, TANGENTIAL, AXIAL):
            self.set(axis, component)

    def set(self, nodes: np.ndarray, component: int, value: np.ndarray | float = 0.0) -> None:
        """Prescribe `value` [mm] of the wave; it is complex where the wave is."""
        turned = self._turned(np.broadcast_to(value, nodes.shape), nodes)
        for part, values in zip(self._parts, (turned.real, turned.imag), strict=False):
            part.set(nodes, component, values)

    def hold(self, patch: str) -> None:
        for part in self._parts:
            part.hold(patch)

    def _turned(
        self, values: np.ndarray, nodes: np.ndarray | slice, back: bool = False
    ) -> np.ndarray:
        """w of u at nodes (k,), or u of w."""
        if self._wave.is_real:
            return values
        phase = self._phase[nodes]
        return values * (phase if back else phase.conjugate()).reshape(-1, *[1] * (values.ndim - 1))

    @property
    def _phase(self) -> np.ndarray:
        """D (n,)."""
        phases = np.ones(len(self._model.mesh.nodes), complex)
        phases[self._model.on(SYMMETRY_END)] = np.exp(1j * self._wave.phase)
        return phases

    def solve(self, load: np.ndarray) -> SolvedWave:
        """Solve under `load` (n, 3) N, the wave's share of the nodal forces on half a repeat.

        Raises
        ------
        SolveError : as `solver.solve`.
        """
        if self._wave.is_real:
            matrix, forces = self._model.matrix, load.real.ravel()
            solution = self._parts[0].solve(forces)
            values = solution.unknowns.reshape(-1, 3)
        else:
            matrix, forces, solution, values = self._solve_pair(load)
        u, whole = solution.unknowns, self._wave.times * self._model.copies
        return SolvedWave(
            self._wave, values, float(u @ (matrix @ u)) * whole, float(u @ forces) * whole,
            solution.residual, solution.free_count, solution.solver,
        )  # fmt: skip

    def _solve_pair(self, load: np.ndarray) -> tuple[csr_matrix, np.ndarray, Solution, np.ndarray]:
        """Matrix and forces of both fields, the solution, and the wave's values (n, 3)."""
        model, every = self._model, slice(None)
        phase = np.repeat(self._phase, 3)
        corners = 3 * (int(model.mesh.cells[:, :4].max()) + 1)
        matrix = _real_form(model.matrix, phase, phase, corners)
        places = _places(len(phase), corners)
        forces, value = np.zeros((2, matrix.shape[0]))
        mask = np.zeros(matrix.shape[0], bool)
        turned = self._turned(load, every).ravel()
        for place, part, force in zip(places, self._parts, (turned.real, turned.imag), strict=True):
            forces[place], mask[place], value[place] = force, part.mask.ravel(), part.value.ravel()
        fixed = np.flatnonzero(mask)

        def interpolation() -> csr_matrix:
            of_corners = corner_interpolation(model.mesh, model.frames)
            return _real_form(of_corners, phase, phase[:corners], corners)

        solution = solve(
            matrix, Case(forces, value[fixed]), fixed, interpolation, model.solve_by,
            slow=model.is_flat,
        )  # fmt: skip
        x, y = solution.unknowns[places].reshape(2, -1, 3)
        return matrix, forces, solution, self._turned(x + 1j * y, every, back=True)


def _places(unknowns: int, first: int) -> np.ndarray:
    """Numbers (2, unknowns) of two fields' unknowns in one vector: the `first` of each come first."""
    number = np.arange(unknowns, dtype=np.int32)
    later = number >= first
    return np.stack(
        [number + later * first, number + np.where(later, unknowns, first)], dtype=np.int32
    )


def _real_form(matrix: csr_matrix, rows: np.ndarray, columns: np.ndarray, first: int) -> csr_matrix:
    """D* K D of phases D of rows and columns, as a real matrix of two fields, in the order of `_places`."""
    starts, column = matrix.indptr, matrix.indices
    turned = np.repeat(rows.imag != 0, np.diff(starts)) != (columns.imag != 0)[column]
    mixed = np.flatnonzero(turned)  # between the plane and the rest
    r, c = np.searchsorted(starts, mixed, side="right") - 1, column[mixed]
    value = matrix.data[mixed] * (rows[r].conjugate() * columns[c])
    real = matrix.data.copy()
    real[mixed] = value.real
    (x, y), (u, v) = _places(len(columns), first), _places(len(rows), first)
    shape, half = (2 * len(rows), 2 * len(columns)), starts[first]
    both = csr_matrix(
        (
            np.concatenate([real[:half], real[:half], real[half:], real[half:]]),
            np.concatenate([x[column[:half]], y[column[:half]], x[column[half:]], y[column[half:]]]),
            np.concatenate([starts[:first], starts[: first + 1] + half,
                            starts[first + 1 :] + half, starts[first + 1 :] + starts[-1]]),
        ),
        shape=shape,
    )  # fmt: skip
    coupling = coo_matrix(
        (
            np.concatenate([-value.imag, value.imag]),
            (np.concatenate([u[r], v[r]]), np.concatenate([y[c], x[c]])),
        ),
        shape=shape,
    )
    return both + coupling.tocsr()
