"""From a tagged CAD surface to a checked mesh of curved quadratic tetrahedra with named patches."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.fea.solid.elements import element_volumes, facet_areas, jacobian_ratio, linear_mesh
from flexspline.fea.solid.errors import MeshQualityError
from flexspline.fea.solid.imprint import Meshed, with_patch_edges
from flexspline.fea.solid.sizing import Grading, graded_background
from flexspline.fea.solid.snap import snap_to_surfaces, undo_inverted
from flexspline.fea.solid.tetwild import TetwildSettings, signed_volumes, tetrahedralize
from flexspline.fea.solid.unroll import Cartesian, MeshingMap, Unrolled
from flexspline.fea.types import TetMesh
from flexspline.geometry.nearest import nearest_triangles
from flexspline.geometry.surfaces import sector_planes
from flexspline.geometry.tagged import TaggedSurface

AREA_TOLERANCE = 0.005
"""A patch whose mesh area is farther than this from its CAD area is refused: parabolas for arcs of a coarse
mesh leave 0.1 %, facets on the wrong side of a patch edge more."""
ASTRAY_SHARE = 0.002
"""Of the boundary: a few facets across sharp edges; a crack along a cut would be many."""
VOLUME_TOLERANCE = 0.01
"""Parabolas for arcs of a coarse mesh lose 0.1 %; a mesh with a hole closed is off by more."""
OFF_PLANE = 1e-6
"""Nodes of a symmetry plane lie in it to this share of the part's size, else it is no mirror."""
ENVELOPES_PER_EDGE = 6
"""The envelope stays this much below the smallest edge: above it the mesher's surface has cracked."""
JACOBIAN_RATIO = 0.3
"""Least ratio of det J within an element; 0.2 is where meshers' quality checks warn. Seen: one element
in ten thousand below it, with ten times the true stress at its nodes."""
FLAT = 1e-7
"""Least volume over the cube of the longest edge; 0.12 for a regular tetrahedron, 0.006 or more in meshes."""
RETRIES = ((1.0, True), (0.95, True), (0.9, False))
"""Edge lengths of the attempts at a mesh, and whether they may be in unrolled space: a keyway's planes are
bent there."""
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
"""Outward faces of a positively oriented tetrahedron; face i is opposite corner i."""


@dataclass(frozen=True)
class MeshSpec:
    """What to ask of the mesher; lengths in mm.

    `unrolled_radius` 0 meshes in part space, otherwise see `fea.solid.unroll`.
    """

    grading: Grading
    envelope: float
    snap_limit: float
    unrolled_radius: float = 0.0
    stop_energy: float = 10.0
    time_limit_s: float = 300.0


def mesh_surface(surface: TaggedSurface, spec: MeshSpec) -> TetMesh:
    """Mesh a part's sector; the mesher is not deterministic, so a poor mesh is tried again, finer.

    Raises
    ------
    MesherError : from the mesher.
    MeshQualityError : a patch or the volume is not the CAD's, or an element is inverted.
    """
    for factor, unrolled in RETRIES:
        radius = spec.unrolled_radius if unrolled else 0.0
        grading = spec.grading.scaled(factor)
        try:
            return _mesh_once(surface, replace(spec, grading=grading, unrolled_radius=radius))
        except MeshQualityError as fault:
            last = fault
    raise last


def _mesh_once(surface: TaggedSurface, spec: MeshSpec) -> TetMesh:
    space: MeshingMap = (
        Unrolled(spec.unrolled_radius, surface.sector_deg) if spec.unrolled_radius else Cartesian()
    )
    boundary = space.to(surface.vertices)
    vertices = np.vstack([boundary, space.to(surface.cut_vertices)])
    triangles = np.vstack([surface.triangles, surface.cut_triangles + len(boundary)])
    settings = TetwildSettings(spec.grading.far, spec.envelope, spec.stop_energy, spec.time_limit_s)
    box = vertices.min(axis=0), vertices.max(axis=0)
    background = graded_background(space.to(surface.critical_edges), box, spec.grading)
    points, tets = tetrahedralize(vertices, triangles, settings, background)
    points, tets = _without_orphans(points, tets)
    faces = boundary_faces(tets)
    raw = Meshed(points, tets, faces, _tag(points, faces, boundary, surface, spec))
    return _quadratic(with_patch_edges(raw, surface.surfaces, space), surface, space, spec)


def boundary_faces(tets: np.ndarray) -> np.ndarray:
    """Faces (k, 3) that belong to one tetrahedron only, outward."""
    faces = tets[:, FACES].reshape(-1, 3)
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    return faces[first[count == 1]]


def _without_orphans(points: np.ndarray, tets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    used, compact = np.unique(tets, return_inverse=True)
    return points[used], compact.reshape(tets.shape)


def _tag(
    points: np.ndarray,
    faces: np.ndarray,
    boundary: np.ndarray,
    surface: TaggedSurface,
    spec: MeshSpec,
) -> np.ndarray:
    """Surface index of every boundary facet, in meshing space where both are planar."""
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(areas, 1e-300)[:, None]
    centres = corners.mean(axis=1)
    triangle, agrees = np.full(len(faces), -1), np.zeros(len(faces), bool)
    for reach in (
        spec.snap_limit,
        5 * spec.snap_limit,
    ):  # the envelope is kept but for a few facets
        lost = np.flatnonzero(triangle < 0)
        if not len(lost):
            break
        triangle[lost], agrees[lost] = nearest_triangles(
            centres[lost], normals[lost], boundary, surface.triangles, reach
        )
    # a few facets across sharp edges face between their surfaces; a crack along a cut would be many
    astray = areas[(triangle < 0) | ~agrees].sum() / areas.sum()
    if astray > ASTRAY_SHARE or (triangle < 0).any():
        raise MeshQualityError(
            f"{astray:.2%} of the mesh's boundary lies on no CAD surface, allowed {ASTRAY_SHARE:.2%}"
        )
    return surface.surface_of[triangle]


def _quadratic(mesh: Meshed, surface: TaggedSurface, space: MeshingMap, spec: MeshSpec) -> TetMesh:
    """Put corners on the exact surfaces, add middle nodes, put those on the surfaces too."""
    n, tets, faces, facet_surface = len(mesh.points), mesh.tets, mesh.faces, mesh.facet_surface
    raw = _in_planes(space.back(mesh.points), faces, facet_surface, surface)
    corners = snap_to_surfaces(raw, faces, facet_surface, surface.surfaces, spec.snap_limit)
    corners = undo_inverted(raw, corners, tets)
    _refuse_flat(corners, tets)
    edges, cells, facets = with_middles(corners, tets, faces)
    # a middle follows its corners in meshing space, then goes onto the surface itself
    middles = space.back(space.to(corners)[edges].mean(axis=1))
    nodes = snap_to_surfaces(
        np.vstack([corners, middles]), facets, facet_surface, surface.surfaces, spec.snap_limit
    )
    nodes[:n] = corners
    nodes = straightened(nodes, cells, edges)
    names = tuple(dict.fromkeys(["", *(s.patch for s in surface.surfaces)]))
    facet_patch = np.array([names.index(s.patch) for s in surface.surfaces])[facet_surface]
    made = TetMesh(nodes, cells, facets, facet_patch, names, surface.sector_deg)
    _check(made, surface)
    return made


def _in_planes(
    points: np.ndarray, faces: np.ndarray, facet_surface: np.ndarray, surface: TaggedSurface
) -> np.ndarray:
    """Nodes of the symmetry planes put into them, whatever else may be undone later.

    Nodes of both planes go onto the axis: put into one plane and then the other they leave the first.
    """
    out = points.copy()
    in_planes = np.zeros(len(points), int)
    for plane in sector_planes(surface.sector_deg):
        mine = [i for i, s in enumerate(surface.surfaces) if s.patch == plane.patch]
        nodes = np.unique(faces[np.isin(facet_surface, mine)])
        out[nodes] = plane.project(out[nodes])
        in_planes[nodes] += 1
    out[in_planes == 2, :2] = 0.0
    return out


def _refuse_flat(points: np.ndarray, tets: np.ndarray) -> None:
    """Beside the axis two nodes can go to one place of it, and the tetrahedron between has no volume."""
    corner = points[tets]
    sides = [corner - np.roll(corner, k, axis=1) for k in (1, 2)]
    longest = np.linalg.norm(sides, axis=3).max(axis=(0, 2))
    flat = signed_volumes(points, tets) < FLAT * longest**3
    if flat.any():
        raise MeshQualityError(
            f"{int(flat.sum())} elements are flat once their nodes are on the CAD"
        )


def with_middles(
    corners: np.ndarray, tets: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2), ten-node cells and six-node facets; middle node of edge i is len(corners) + i."""
    mesh = linear_mesh(corners, tets)
    edges = mesh.edges.T
    n = len(corners)
    cells = np.hstack([tets, mesh.t2e.T + n])
    key = edges[:, 0].astype(np.int64) * n + edges[:, 1]
    order = np.argsort(key)
    sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).astype(np.int64)
    found = order[np.searchsorted(key[order], sides[:, :, 0] * n + sides[:, :, 1])]
    return edges, cells, np.hstack([faces, found + n])


def straightened(nodes: np.ndarray, cells: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Straighten the edges of elements that curving has bent too far: their stresses are wrong."""
    n = len(nodes) - len(edges)
    out = nodes.copy()
    for _ in range(10):
        bad = jacobian_ratio(out, cells) < JACOBIAN_RATIO
        if not bad.any():
            return out
        middles = np.unique(cells[bad, 4:])
        out[middles] = out[edges[middles - n]].mean(axis=1)
    raise MeshQualityError(f"{int(bad.sum())} elements are badly bent even with straight edges")


def _check(mesh: TetMesh, surface: TaggedSurface) -> None:
    """Compare volume and patch areas with the CAD's, and symmetry planes with themselves."""
    size = np.ptp(mesh.nodes, axis=0).max()
    for plane in sector_planes(mesh.sector_deg):
        nodes = mesh.nodes[mesh.nodes_on(plane.patch)]
        # at 180° both planes are one, and its facets all go by the first name
        off = np.abs(plane.project(nodes) - nodes).max(initial=0.0)
        if off > OFF_PLANE * size:
            raise MeshQualityError(f"a node of {plane.patch} lies {off:.3g} mm off the plane")
    volume = element_volumes(mesh.nodes, mesh.cells).sum()
    if abs(volume / surface.volume - 1) > VOLUME_TOLERANCE:
        raise MeshQualityError(
            f"the mesh holds {volume:.6g} mm³, the CAD solid {surface.volume:.6g} mm³"
        )
    for patch, wanted in surface.patch_areas.items():
        area = facet_areas(mesh.nodes, mesh.on(patch)).sum()
        if abs(area / wanted - 1) > AREA_TOLERANCE:
            raise MeshQualityError(
                f"patch '{patch}' has {area:.6g} mm² in the mesh, {wanted:.6g} mm² in the CAD,"
                f" allowed difference {AREA_TOLERANCE:.0%}"
            )
