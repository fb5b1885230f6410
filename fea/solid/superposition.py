"""The change of a part's field caused by bolt holes and a keyway, solved alone.

The part without these cuts is a body of revolution, solved on its meridian: its field is u₀. The part's own
field is u₀ + v: v is 0 where the part is held or turned, and its tractions take those of u₀ off the walls of
the cuts (Bueckner's superposition, Trans. ASME 80 (1958) 1225-1230, there of cracks). With E, twice the
energy that u₀ has in the material of the cuts, twice the energy of the part turned by 1 rad, and the work of
a given load, are

    K = K₀ − E − a(v, v),    W = W₀ + E + a(v, v).

A finite element field v_h stores less than v, by a(v − v_h, v − v_h): what it gives is above K. The errors
far from the cuts, most of those of a solid model, are not in it. docs/theory.md has the proof.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from skfem import ElementTriP2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from flexspline.fea.axisymmetric.bisection import Box
from flexspline.fea.axisymmetric.lobes import SolvedLobes, lobe_harmonic
from flexspline.fea.axisymmetric.places import Places
from flexspline.fea.axisymmetric.recovery import (
    R_THETA,
    RR,
    RZ,
    THETA_THETA,
    THETA_Z,
    ZZ,
    Parts,
    stress_of,
)
from flexspline.fea.axisymmetric.torsion import SolvedTorsion
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.waves import CyclicWave, waves
from flexspline.fea.types import Elastic, Stiffness, TetMesh
from flexspline.geometry.part import Part
from flexspline.geometry.shaft_shape import Slot
from flexspline.geometry.surfaces import ON_SURFACE_MM, Swept, part_surfaces

WALL_DEGREE = 8
"""Degree of the quadrature on the walls. K of six hats and shafts by degrees 6 and 12 differs by 2e-6."""
IN_CUT = 1e-3
"""How far beyond a cut a facet of its wall may lie by rounding, as a share of the hole's radius or half the
keyway's width."""


@dataclass(frozen=True)
class Walls:
    """Points (k, q) on the walls of the cuts that a mesh's sector has.

    Attributes
    ----------
    facets : (k, 6) the mesh's. of_slot : (k,) which are of a keyway. shapes : (6, q) of a facet's nodes.
    r, phi, z : of the points [mm, rad].
    area : (3, k, q) outward normal times weight, along r, φ, z [mm²].
    axes : (3, 3, k, q) the directions of r, φ, z, each Cartesian.
    """

    mesh: TetMesh
    facets: np.ndarray
    of_slot: np.ndarray
    shapes: np.ndarray
    r: np.ndarray
    phi: np.ndarray
    z: np.ndarray
    area: np.ndarray
    axes: np.ndarray

    @classmethod
    def of(cls, mesh: TetMesh, part: Part) -> Walls:
        """Find the walls of a mesh of a part's sector.

        Raises
        ------
        MeshQualityError : it has none.
        """
        facets = wall_facets(mesh, part)
        if not len(facets):
            raise MeshQualityError("no facet of the mesh lies on a wall of holes or keyway")
        points, weights = get_quadrature(RefTri, WALL_DEGREE)
        element = ElementTriP2()
        basis = [element.lbasis(points, i) for i in range(6)]
        shapes, slopes = np.stack([s for s, _ in basis]), np.stack([s for _, s in basis], axis=1)
        nodes = mesh.nodes[facets]
        x, y, z = np.einsum("aq,kad->dkq", shapes, nodes)
        along = np.einsum("iaq,kad->ikqd", slopes, nodes)
        area = np.cross(along[0], along[1]) * weights[:, None]
        phi, nought = np.arctan2(y, x), np.zeros_like(x)
        c, s = np.cos(phi), np.sin(phi)
        axes = np.array([[c, s, nought], [-s, c, nought], [nought, nought, nought + 1]])
        return cls(
            mesh,
            facets,
            _of_slot(nodes.mean(axis=1), part.keyway),
            shapes,
            np.hypot(x, y),
            phi,
            z,
            np.einsum("cdkq,kqd->ckq", axes, area),
            axes,
        )

    @property
    def copies(self) -> float:
        """How many sectors make the part."""
        return 360 / self.mesh.sector_deg

    def places(self, space: Any) -> Places:
        """The points in the meridian; raises MeshingError where they leave it."""
        return Places.of(space, self.r.ravel(), self.z.ravel())

    def pull(self, stress: Parts) -> np.ndarray:
        """Return traction times area (3, k, q) along r, φ, z [N] of stresses [MPa] at the points."""
        n_r, n_t, n_z = self.area
        part = {k: np.asarray(v).reshape(self.r.shape) for k, v in stress.items()}
        rr, tt, zz, rz, rt, tz = (
            part.get(k, 0.0) for k in (RR, THETA_THETA, ZZ, RZ, R_THETA, THETA_Z)
        )
        return np.stack(
            [
                rr * n_r + rt * n_t + rz * n_z,
                rt * n_r + tt * n_t + tz * n_z,
                rz * n_r + tz * n_t + zz * n_z,
            ]
        )

    def forces(self, pull: np.ndarray) -> np.ndarray:
        """Return nodal forces (n, 3) Cartesian [N] of traction times area, real or complex."""
        forces = np.zeros((len(self.mesh.nodes), 3), pull.dtype)
        nodal = np.einsum("aq,cdkq,ckq->kad", self.shapes, self.axes, pull)
        np.add.at(forces, self.facets, nodal)
        return forces


def wall_facets(mesh: TetMesh, part: Part) -> np.ndarray:
    """Return the facets (k, 6) in a cut: on no surface of revolution and no named patch."""
    surfaces = part_surfaces(part, mesh.sector_deg)
    unnamed = mesh.facets[mesh.facet_patch == mesh.patches.index("")]
    centres = mesh.nodes[unnamed].mean(axis=1)
    off = np.array([np.linalg.norm(s.project(centres) - centres, axis=1) for s in surfaces])
    swept = np.array([isinstance(s, Swept) for s in surfaces])
    # a blind hole may end in the plane of a step; a facet of a fillet may be nearer to a cut's plane
    cut = off[~swept].min(axis=0) < off[swept].min(axis=0) - ON_SURFACE_MM
    return unnamed[cut & (_of_hole(centres, part) | _of_slot(centres, part.keyway))]


def _of_hole(centres: np.ndarray, part: Part) -> np.ndarray:
    """Mask (k,) of facets, by their middles (k, 3) [mm], that a bolt hole's wall or floor may be."""
    if (bolts := part.bolts) is None:
        return np.zeros(len(centres), bool)
    x, y, z = centres.T
    away = np.min([np.hypot(x - a, y - b) for a, b in bolts.centres], axis=0)
    room = IN_CUT * bolts.hole_radius
    return np.asarray((away < bolts.hole_radius + room) & (z < part.hole_depth + room))


def _of_slot(centres: np.ndarray, slot: Slot | None) -> np.ndarray:
    """The same of a keyway."""
    if slot is None:
        return np.zeros(len(centres), bool)
    x, y, z = centres.T
    inside = np.minimum(np.minimum(x - slot.floor, slot.half_width - np.abs(y)), z - slot.start)
    return np.asarray(inside > -IN_CUT * slot.half_width)


@dataclass(frozen=True)
class WholeTurned:
    """A part with holes or a keyway, and its torsion solved without them.

    `coarser` : solved on longer edges at the cuts, which tells how far off u₀ is.
    """

    part: Part
    solved: SolvedTorsion
    coarser: SolvedTorsion


@dataclass(frozen=True)
class WholeUnderLobes:
    """A part with bolt holes, and its field under the lobe load without them; `coarser` as above.

    `stiffness` : K₀ under that load.
    """

    part: Part
    stiffness: Stiffness
    solved: SolvedLobes
    coarser: SolvedLobes


def at_cuts(part: Part) -> tuple[Box, ...]:
    """Where in the meridian the holes and the keyway of a part are, with the length of the first edges there:
    how wide the cut is, or how deep, if that is less."""
    boxes = []
    if (bolts := part.bolts) is not None:
        boxes.append(Box((bolts.inner, bolts.outer), (0.0, part.hole_depth), 2 * bolts.hole_radius))
    if (slot := part.keyway) is not None:
        outer = max(r for s in part.meridian.segments for r, _ in (s.start, s.end))
        deep = min(2 * slot.half_width, outer - slot.floor)
        boxes.append(Box((slot.floor, outer), (slot.start, part.length), deep))
    return tuple(boxes)


@dataclass(frozen=True)
class TurnedWalls:
    """Forces (n, 3) Cartesian [N] that cancel u₀'s tractions on the walls, for a turn of 1 rad.

    `energy` : E of the whole part [N·mm].
    """

    forces: np.ndarray
    energy: float


def turned_walls(walls: Walls, solved: SolvedTorsion, material: Elastic) -> TurnedWalls:
    """Return the forces on the walls of a mesh of the part's sector.

    The energy in a cut is the work that is done on its boundary: on the walls alone where the rest is free or
    held still, as of holes. The keyway's is turned there, so the walls' share is told relative to that turn.

    Raises
    ------
    MeshingError : a wall leaves the meridian.
    """
    turn = solved.turn
    psi = walls.places(turn.space).see(turn.psi)
    shear = material.mu * walls.r.ravel() * psi.grad
    pull = walls.pull({R_THETA: shear[0], THETA_Z: shear[1]})
    turned = walls.r * (np.asarray(psi).reshape(walls.r.shape) - walls.of_slot[:, None])
    energy = -float(np.sum(pull[TANGENTIAL] * turned)) * walls.copies
    return TurnedWalls(walls.forces(-pull), energy)


@dataclass(frozen=True)
class WallWave:
    """Complex forces (n, 3) Cartesian [N] that cancel a wave of u₀'s tractions on the walls.

    `energy` : the wave's part of E, of the whole part [N·mm].
    """

    wave: CyclicWave
    forces: np.ndarray
    energy: float


def lobed_walls(
    walls: Walls, repeats: int, solved: SolvedLobes, material: Elastic
) -> Iterator[WallWave]:
    """Return the waves of the lobe load on the walls of half a repeat, or of half the part (`repeats` 1).

    Raises
    ------
    MeshingError : a wall leaves the meridian.
    """
    places = walls.places(solved.space)
    of_wave: dict[CyclicWave, list[np.ndarray]] = {}
    for number, amplitude in enumerate(solved.amplitudes):
        n = 2 * number
        harmonic = lobe_harmonic(n)
        fields = {c: places.see(amplitude[:, c]) for c in harmonic.components}
        stress = stress_of(harmonic, material, walls.r.ravel(), fields)
        (wave,) = waves((n,), repeats)
        cosine, sine = (wave.of(partial(around, f, n), walls.phi) for f in (np.cos, np.sin))
        even = {k: stress[k] for k in (R_THETA, THETA_Z)}
        odd = {k: part for k, part in stress.items() if k not in even}
        pull = cosine * walls.pull(even) - sine * walls.pull(odd)
        moved = _moved(fields, cosine, sine)
        sums = of_wave.setdefault(wave, [np.zeros_like(pull, complex) for _ in range(2)])
        sums[0] += pull
        sums[1] += moved
    for wave, (pull, moved) in of_wave.items():
        work = float(np.sum(pull.conjugate() * moved).real)
        energy = -work * wave.times * walls.copies
        yield WallWave(wave, walls.forces(-pull), energy)


def around(function: Callable[[np.ndarray], np.ndarray], n: int, phi: np.ndarray) -> np.ndarray:
    """Return f(nφ)."""
    return function(n * phi)


def _moved(fields: Mapping[int, Any], cosine: np.ndarray, sine: np.ndarray) -> np.ndarray:
    """Displacements (3, k, q) along r, φ, z of amplitudes U, V, W: −U sin nφ, V cos nφ, −W sin nφ."""
    displacement = np.zeros((3, *cosine.shape), complex)
    for component, factor in ((RADIAL, -sine), (TANGENTIAL, cosine), (AXIAL, -sine)):
        if component in fields:
            displacement[component] = factor * np.asarray(fields[component]).reshape(cosine.shape)
    return displacement
