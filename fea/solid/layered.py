"""Meshes of shafts with holes or a keyway that no sweep about the axis makes: layers, then halved where it matters."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, radians

import numpy as np
from scipy.spatial import cKDTree

from flexspline.fea.solid.bisect import Simplices, halved
from flexspline.fea.solid.elements import element_volumes, facet_areas, jacobian_ratio
from flexspline.fea.solid.errors import MeshQualityError, TooManyElementsError
from flexspline.fea.solid.layer_edges import Seams, seams_of
from flexspline.fea.solid.layer_sizes import face_area, volume, wall_area
from flexspline.fea.solid.layers import SUNK, SUNK_OF_NEXT, Layers
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.mesh_checks import refuse_flat
from flexspline.fea.solid.prisms import cut
from flexspline.fea.solid.quadratic import JACOBIAN_RATIO, boundary_faces, with_middles
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.snap import common_point, snap_to_surfaces, undo_inverted
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS
from flexspline.fea.types import TetMesh
from flexspline.geometry.outline import SAME
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START, Surface, part_surfaces

ROUNDS = 60
"""Of halving: each asks for the longest edges first."""
AT_ONCE = 2.0
"""In a round, edges longer than what is asked or, while there are much longer ones, than the longest over this."""
BENT_ROUNDS = 5
BENT = 0.03
"""Of an edge's length: how far its middle lies off the straight line, where halving may help (an arc of 5°)."""
TOLERANCE = 1e-3
"""Of volume and patch areas; parabolas for arcs of 20° leave 2e-5."""
RING_STEP = radians(20)
ON_SURFACE = 1e-6


def layered_mesh(part: Part, sector_deg: float, spec: MeshSpec, most_elements: float = inf) -> TetMesh:
    """Mesh of a shaft's sector, graded as `spec` says.

    Raises
    ------
    MeshingError, MeshQualityError : lines of the cross-sections too near each other, or a failed check.
    TooManyElementsError : more than `most_elements`.
    """
    layers = Layers.of(part, radians(sector_deg))
    surfaces = part_surfaces(part, sector_deg)
    grading = spec.grading
    points, mesh = _first(layers, surfaces, grading)
    most = min(most_elements, MOST_ELEMENTS)
    points, mesh = _graded(points, mesh, surfaces, grading, most)
    refuse_flat(points, mesh.tets)
    made = _quadratic(points, mesh, surfaces, sector_deg, most)
    _check(made, layers)
    return made


def _first(
    layers: Layers, surfaces: Sequence[Surface], grading: Grading
) -> tuple[np.ndarray, Simplices]:
    """Corners (n, 3) [mm] and tetrahedra of the layers' prisms, as few as the lines allow."""
    polar, prisms = layers.prisms(grading.near, grading.far)
    polar, prisms = _corners_first(layers, polar, prisms)
    tets = cut(prisms)
    used, compact = np.unique(tets, return_inverse=True)
    polar, tets = polar[used], compact.reshape(tets.shape)
    points = _cartesian(polar)
    faces = boundary_faces(tets)
    on = _surface_of(points, faces, surfaces)
    points = _sunk(layers, polar, points, tets, faces, on, surfaces)
    return points, Simplices(len(points), tets, faces, on)


def _corners_first(
    layers: Layers, polar: np.ndarray, prisms: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes in the corners under fillets have the least numbers: prisms are cut from there, not along the arc."""
    corner = np.zeros(len(polar), bool)
    for f in layers.fillets:
        corner |= (np.abs(polar[:, 0] - f.r) < SAME) & (np.abs(polar[:, 2] - f.z) < SAME)
    order = np.argsort(~corner, kind="stable")
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    return polar[order], number[prisms]


def _surface_of(corners: np.ndarray, faces: np.ndarray, surfaces: Sequence[Surface]) -> np.ndarray:
    """Index of the surface that each facet's corners lie on exactly; of several, its centre decides."""
    centres = corners[faces].mean(axis=1)
    off = np.array([np.abs(s.project(corners) - corners).max(axis=1) for s in surfaces])
    away = np.array([np.abs(s.project(centres) - centres).max(axis=1) for s in surfaces])
    lies = off[:, faces].max(axis=2) < ON_SURFACE
    if not lies.any(axis=0).all():
        raise MeshQualityError(f"{int((~lies.any(axis=0)).sum())} facets lie on no surface of the part")
    away = np.where(lies, away, np.inf)
    return np.asarray((away < away.min(axis=0) + ON_SURFACE).argmax(axis=0))


def _sunk(
    layers: Layers, polar: np.ndarray, points: np.ndarray, tets: np.ndarray, faces: np.ndarray,
    on: np.ndarray, surfaces: Sequence[Surface],
) -> np.ndarray:
    """Nodes in the sharp corners under fillets moved into the material, inwards and away from the arc."""
    mirrors = [i for i, s in enumerate(surfaces) if s.patch in (SYMMETRY_START, SYMMETRY_END)]
    inside = np.ones(len(polar), bool)
    inside[faces[~np.isin(on, mirrors)]] = False
    r, _, z = polar.T
    a, b = Simplices(len(polar), tets, faces, on).edges().T
    length = np.linalg.norm(points[a] - points[b], axis=1)
    moved = polar.copy()
    for f in layers.fillets:
        corner = inside & (r > f.r - SAME) & (r < f.far - SAME) & (np.abs(z - f.z) < SAME)
        beyond = (r < f.r - SAME) | ((z - f.z) * f.up < -SAME)
        room = np.full(len(polar), np.inf)
        for one, other in ((a, b), (b, a)):
            mine = beyond[other]
            np.minimum.at(room, one[mine], length[mine])
        step = np.minimum(SUNK * f.radius, SUNK_OF_NEXT * room[corner])
        moved[corner, 0] -= np.where(r[corner] < f.r + SAME, step, 0.0)
        moved[corner, 2] -= f.up * step
    return undo_inverted(points, _cartesian(moved), tets)


def _graded(
    points: np.ndarray, mesh: Simplices, surfaces: Sequence[Surface], grading: Grading, most: float
) -> tuple[np.ndarray, Simplices]:
    """Edges halved until none is longer than the grading asks; new nodes of the boundary on its surfaces."""
    for _ in range(ROUNDS):
        edges = mesh.edges()
        seams = seams_of(points, mesh.facets, mesh.facet_surface, surfaces)
        lengths = _relative_lengths(points, edges, seams, grading)
        if lengths.max() <= 1:
            return points, mesh
        mesh, cut_edges = halved(mesh, edges, lengths, lengths > max(1.0, lengths.max() / AT_ONCE))
        if len(mesh.tets) > most:
            raise TooManyElementsError(len(mesh.tets), most)
        points = _with_new(points, mesh, cut_edges, surfaces)
    raise MeshQualityError(f"{int((lengths > 1).sum())} edges of the layers cannot be made short enough")


def _with_new(
    points: np.ndarray, mesh: Simplices, cut_edges: np.ndarray, surfaces: Sequence[Surface]
) -> np.ndarray:
    """Points with those between edges' ends: at half the angle, or on the surfaces of the boundary.

    Straight middles are kept where another place would flatten a tetrahedron; the next round tries again.
    """
    n = len(points)
    ends = points[cut_edges]
    straight = np.vstack([points, ends.mean(axis=1)])
    wanted = np.vstack([points, _cartesian(_middles(_polar(points)[cut_edges]))])
    limit = float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).max())
    wanted = snap_to_surfaces(wanted, mesh.facets, mesh.facet_surface, surfaces, limit)
    return undo_inverted(straight, wanted, mesh.tets, len(points))


def _relative_lengths(
    points: np.ndarray, edges: np.ndarray, seams: Seams, grading: Grading
) -> np.ndarray:
    """Of edges (e, 2), over those that are wanted.

    About the axis only holes and slots ask for short ones: what is revolved makes fields even there.
    """
    ends = _polar(points)[edges]
    middle = _middles(ends)
    dr, dz = (ends[:, 1, k] - ends[:, 0, k] for k in (0, 2))
    off_axis = (ends[:, :, 0] > 0).all(axis=1)
    turn = np.where(off_axis, ends[:, 1, 1] - ends[:, 0, 1], 0.0)
    there = _cartesian(middle)

    def away(which: np.ndarray) -> np.ndarray:
        chosen = seams.nodes[which]
        if not len(chosen):
            return np.full(len(edges), np.inf)
        along = np.linspace(0, 1, 5)[None, :, None]
        a, b = points[chosen[:, 0]][:, None], points[chosen[:, 1]][:, None]
        return np.asarray(cKDTree((a + along * (b - a)).reshape(-1, 3)).query(there)[0])

    across = np.minimum(grading.far, grading.near + grading.growth * away(seams.singular))
    plain = grading.near + grading.growth * away(seams.singular & ~seams.revolved)
    around = np.maximum(across, np.minimum(plain, RING_STEP * 1.01 * middle[:, 0]))
    return np.sqrt((dr**2 + dz**2) / across**2 + (middle[:, 0] * turn / around) ** 2)


def _curved(
    points: np.ndarray, mesh: Simplices, surfaces: Sequence[Surface], straight: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Nodes with middle ones, edges, ten-node cells and six-node facets.

    Middle nodes follow the angle, those of the boundary lie on its surfaces. Within the part edges are
    straight where elements would be bent too far, so that those of its surface may stay.
    """
    n = len(points)
    edges, cells, facets = with_middles(points, mesh.tets, mesh.facets)
    nodes = np.vstack([points, _cartesian(_middles(_polar(points)[edges]))])
    longest = float(np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).max())
    nodes = snap_to_surfaces(nodes, facets, mesh.facet_surface, surfaces, longest)
    nodes[:n] = points
    own = np.zeros(len(nodes), bool)
    own[facets.ravel()] = True
    for movable in [~own, np.ones_like(own)] if straight else [~own]:
        nodes = _straightened(nodes, cells, edges, movable)
    if straight and jacobian_ratio(nodes, cells).min() < JACOBIAN_RATIO:
        raise MeshQualityError("elements are badly bent even with straight edges")
    return nodes, edges, cells, facets


def _straightened(
    nodes: np.ndarray, cells: np.ndarray, edges: np.ndarray, movable: np.ndarray
) -> np.ndarray:
    """Nodes (n, 3), `movable` (n,) middle ones of elements that are bent too far on straight edges."""
    n = len(nodes) - len(edges)
    left, out, mine = movable.copy(), nodes.copy(), cells
    while len(mine):
        bad = np.unique(mine[jacobian_ratio(out, mine) < JACOBIAN_RATIO, 4:])
        bad = bad[left[bad]]
        out[bad] = out[edges[bad - n]].mean(axis=1)
        left[bad] = False
        mine = cells[np.isin(cells[:, 4:], bad).any(axis=1)]
    return out


def _quadratic(
    points: np.ndarray, mesh: Simplices, surfaces: Sequence[Surface], sector_deg: float, most: float
) -> TetMesh:
    """Ten-node tetrahedra; edges of the surface that bend one too far are halved, and straight in the end."""
    before = inf
    for _ in range(BENT_ROUNDS):
        nodes, edges, cells, facets = _curved(points, mesh, surfaces)
        n = len(points)
        bent = np.zeros(len(edges), bool)
        bent[np.unique(cells[jacobian_ratio(nodes, cells) < JACOBIAN_RATIO, 4:]) - n] = True
        off = np.linalg.norm(nodes[n:] - points[edges].mean(axis=1), axis=1)
        length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        bent &= off > BENT * length
        if not 0 < bent.sum() < before:
            break
        before = bent.sum()
        mesh, cut_edges = halved(mesh, edges, length, bent)
        if len(mesh.tets) > most:
            raise TooManyElementsError(len(mesh.tets), most)
        points = _with_new(points, mesh, cut_edges, surfaces)
    nodes, edges, cells, facets = _curved(points, mesh, surfaces, straight=True)
    names = tuple(dict.fromkeys(["", *(s.patch for s in surfaces)]))
    facet_patch = np.array([names.index(s.patch) for s in surfaces])[mesh.facet_surface]
    return TetMesh(nodes, cells, facets, facet_patch, names, sector_deg)


def _check(mesh: TetMesh, layers: Layers) -> None:
    """Volume and patch areas against integrals over the cross-sections."""
    pairs = {"volume": (float(element_volumes(mesh.nodes, mesh.cells).sum()), volume(layers))}
    segments = layers.part.meridian.segments
    for patch in {s.patch for s in segments if s.patch}:
        wanted = 0.0
        for s in (s for s in segments if s.patch == patch):
            (r0, z0), (r1, z1) = s.start, s.end
            if z0 == z1:
                wanted += face_area(layers, min(r0, r1), max(r0, r1), z0)
            else:
                wanted += wall_area(layers, r0, min(z0, z1), max(z0, z1))
        pairs[patch] = (float(facet_areas(mesh.nodes, mesh.on(patch)).sum()), wanted)
    for what, (found, wanted) in pairs.items():
        if not abs(found / wanted - 1) < TOLERANCE:
            raise MeshQualityError(f"{what}: {found:.6g} in the mesh, {wanted:.6g} in the part")


def layered_edges(part: Part, sector_deg: float, spacing: float) -> np.ndarray:
    """Points (k, 3) every `spacing` mm along the sharp edges and patch edges, as `TaggedSurface.sharp_edges`.

    Raises
    ------
    MeshingError, MeshQualityError : as `layered_mesh`.
    """
    surfaces = part_surfaces(part, sector_deg)
    size = part.length  # the coarsest mesh has all edges
    points, mesh = _first(Layers.of(part, radians(sector_deg)), surfaces, Grading(size, size))
    seams = seams_of(points, mesh.facets, mesh.facet_surface, surfaces)
    ends, on = points[seams.nodes[seams.sharp]], seams.surfaces[seams.sharp]
    counts = np.maximum(2, np.ceil(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / spacing) + 1)
    found = []
    for count in np.unique(counts):
        along = np.linspace(0, 1, int(count))[None, :, None]
        a, b = (_polar(ends[counts == count, k])[:, None] for k in (0, 1))
        found.append(_cartesian((a + along * (b - a)).reshape(-1, 3)))
    pairs = np.vstack([np.repeat(on[counts == c], int(c), axis=0) for c in np.unique(counts)])
    every = np.vstack(found)
    for both in np.unique(pairs, axis=0):
        mine = (pairs == both).all(axis=1)
        every[mine] = common_point(every[mine], [surfaces[i] for i in both])[0]
    return every


def _polar(points: np.ndarray) -> np.ndarray:
    x, y, z = points.T
    phi = np.arctan2(y, x)
    return np.column_stack([np.hypot(x, y), np.where(phi < -np.pi / 2, phi + 2 * np.pi, phi), z])


def _cartesian(polar: np.ndarray) -> np.ndarray:
    r, phi, z = polar.T
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), z])


def _middles(ends: np.ndarray) -> np.ndarray:
    """Middles (e, 3) of edges (e, 2, 3), all as (r, φ, z); an end on the axis has the other's angle."""
    off_axis = ends[:, :, 0] > 0
    middles = ends.mean(axis=1)
    middles[:, 1] = (ends[:, :, 1] * off_axis).sum(axis=1) / np.maximum(1, off_axis.sum(axis=1))
    return np.asarray(middles)
