"""dK/dp of a body of revolution under torque, from one solution: the adjoint way.

K is the least energy over all fields with the given rotation, so its derivative with respect to the shape
is that of the energy with the field held (the field is its own adjoint). The mesh follows the outline,
nodal rotations ψ = u_θ/r stay, and the energy's difference over a small step is dK. Source: Haug, Choi,
Komkov, Design Sensitivity Analysis of Structural Systems (1986), ch. 3, for compliance.

Where a dimension gives the outline new corners (a bore that becomes a step) no mesh can follow. There the
same derivative is taken over the free surface: a layer of thickness t there adds its energy, dK = ∫ Gγ² t dA.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import spsolve

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.harmonics import TANGENTIAL, Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.lobes import LOBE_BULK
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.recovery import recovered
from flexspline.fea.axisymmetric.torsion import MOST_TRIANGLES, bulk
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.refinement import refine
from flexspline.fea.shortfall import ToleranceError
from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import SAME, Meridian

LAYER_POINTS = 16
"""On each edge: a layer may end within it."""
TWIST = Harmonic(0, torsion=True)


@dataclass(frozen=True)
class Twist:
    """A solved torsion problem, ready to be moved.

    `rotation` (count,): ψ [rad] at the P2 nodes, 0 where r = 0; `K_Nm_per_rad` from above.
    """

    mesh: MeridianMesh
    material: Elastic
    rotation: np.ndarray
    K_Nm_per_rad: float


def twist(outline: Meridian, material: Elastic, driven: str, tolerance: float) -> Twist:
    """Refined until the recovery estimate of K's relative error is below `tolerance`.

    Raises
    ------
    MeshingError, HarmonicError, ToleranceError
    """
    found = _Twisted(material, driven, tolerance)
    if why := refine(found, triangulate(outline), most_elements=MOST_TRIANGLES):
        raise ToleranceError(f"the energy is off by {found.error:.2g}", why)
    r = found.model.space.places[:, 0]
    turned = found.solved.values.reshape(-1, 3)[:, TANGENTIAL]
    rotation = np.divide(turned, r, out=np.zeros_like(turned), where=r > 0)
    return Twist(found.model.mesh, material, rotation, found.solved.twice_energy / NMM_PER_NM)


class _Twisted:
    """The finest mesh's solution, and its estimated relative error of the energy."""

    def __init__(self, material: Elastic, driven: str, tolerance: float) -> None:
        self._material, self._driven, self._tolerance = material, driven, tolerance

    def solve(self, mesh: MeridianMesh) -> None:
        model = HarmonicModel(mesh, self._material)
        on = model.on(self._driven)
        fixed = [Fixed(on, TANGENTIAL, model.space.places[on, 0]), *model.held("mount")]
        solved = model.solve(TWIST, fixed, np.zeros(3 * model.space.count))
        found = recovered(model, TWIST, solved.values)
        self.model, self.solved, self._found = model, solved, found

    @property
    def error(self) -> float:
        return float(self._found.error.sum() / self._found.energy.sum())

    @property
    def met(self) -> bool:
        return self.error < self._tolerance

    def finer(self, mesh: MeridianMesh) -> MeridianMesh:
        return refined(mesh, bulk(self._found.error, LOBE_BULK))


def moved_stiffness(found: Twist, outline: Meridian) -> float:
    """Twice the energy per rad² [N·m/rad] of the held field on another outline, a small step away.

    Raises
    ------
    HeldSurfaceError : the outline has new corners, and a surface that is held or turned moves.
    """
    if len(outline.segments) != len(found.mesh.outline.segments):
        return found.K_Nm_per_rad + layer_stiffness(found, outline)
    model = HarmonicModel(_moved(found.mesh, outline), found.material)
    values = np.zeros((model.space.count, 3))
    values[:, TANGENTIAL] = found.rotation * model.space.places[:, 0]
    u = values.ravel()
    return float(u @ (model.stiffness(TWIST) @ u)) / NMM_PER_NM


class HeldSurfaceError(ComputationError):
    """No slope over the free surface: a patch moves by `by_mm` where the outline gets new corners."""

    def __init__(self, patch: str, by_mm: float) -> None:
        self.patch, self.by_mm = patch, by_mm
        super().__init__(f"the outline gets new corners and its {patch} moves")


def layer_stiffness(found: Twist, outline: Meridian) -> float:
    """What the thin layers between the solved and another outline add to K [N·m/rad], to first order.

    On a free surface only the strain along it is left, γ = r ∂ψ/∂s; dA = 2πr ds.

    Raises
    ------
    HeldSurfaceError : a patch moves; its share is no matter of the energy alone.
    """
    mesh = found.mesh
    space = HarmonicModel(mesh, found.material).space
    ends = space.places[space.rim[:, :2]]
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    outward = np.column_stack([along[:, 1], -along[:, 0]]) / length[:, None]
    added = 0.0
    for t in (np.arange(LAYER_POINTS) + 0.5) / LAYER_POINTS:
        at = ends[:, 0] + t * along
        exact = _nearest(mesh.outline, at)  # the mesh's edges are chords of its arcs
        thickness = ((_nearest(outline, exact) - exact) * outward).sum(axis=1)
        _check_patches(mesh, thickness)
        slopes = np.array([4 * t - 3, 4 * t - 1, 4 - 8 * t])  # of the edge's shape functions
        strain = at[:, 0] * (found.rotation[space.rim] @ slopes) / length
        shear = found.material.mu * strain**2
        added += float((shear * thickness * 2 * np.pi * at[:, 0] * length).sum()) / LAYER_POINTS
    return added / NMM_PER_NM


def _nearest(outline: Meridian, at: np.ndarray) -> np.ndarray:
    """The outline's nearest points to points (n, 2)."""
    found = np.stack([s.nearest(at) for s in outline.segments])
    closest = np.linalg.norm(found - at, axis=2).argmin(axis=0)
    return found[closest, np.arange(len(at))]


def _check_patches(mesh: MeridianMesh, thickness: np.ndarray) -> None:
    for index, segment in enumerate(mesh.outline.segments):
        moves = np.abs(thickness[mesh.edge_segment == index])
        if segment.patch and moves.size and moves.max() > SAME:
            raise HeldSurfaceError(segment.patch, float(moves.max()))


def _moved(mesh: MeridianMesh, outline: Meridian) -> MeridianMesh:
    """Boundary vertices keep their place along their segment; inner ones follow their neighbours."""
    shift = np.zeros_like(mesh.points)
    for index, (old, new) in enumerate(zip(mesh.outline.segments, outline.segments, strict=True)):
        nodes = np.unique(mesh.edges[mesh.edge_segment == index])
        at = _along(old.at(np.linspace(0, 1, 2)), old.centre, old.sweep, mesh.points[nodes])
        shift[nodes] = new.at(at) - old.at(at)
    rim = np.unique(mesh.edges)
    inner = np.setdiff1d(np.arange(len(shift)), rim)
    if len(inner):
        sides = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        both = np.concatenate([sides, sides[:, ::-1]])
        links = coo_matrix((np.ones(len(both)), both.T), shape=2 * (len(shift),)).tocsr()
        laplace = (diags(np.asarray(links.sum(axis=1)).ravel()) - links).tocsr()
        right = -laplace[inner][:, rim] @ shift[rim]
        shift[inner] = spsolve(laplace[inner][:, inner].tocsc(), right).reshape(-1, 2)
    return MeridianMesh(outline, mesh.points + shift, mesh.triangles, mesh.edges, mesh.edge_segment)


def _along(
    ends: np.ndarray, centre: tuple[float, float] | None, sweep: float, points: np.ndarray
) -> np.ndarray:
    """Parameter in [0, 1] of points on a line or an arc."""
    if centre is None:
        d = ends[1] - ends[0]
        return (points - ends[0]) @ d / (d @ d)
    begin, off = ends[0] - centre, points - np.array(centre)
    angle = np.arctan2(off[:, 1], off[:, 0]) - np.arctan2(begin[1], begin[0])
    return ((angle + np.pi) % (2 * np.pi) - np.pi) / sweep
