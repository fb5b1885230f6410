"""The tagged surface: a part's CAD faces as triangles; each triangle has a reference to its surface.

Patches are named here, at the CAD face, and nowhere else.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from flexspline.geometry.cad import build_solid, partition_faces
from flexspline.geometry.errors import GeometryError
from flexspline.geometry.face_triangles import (
    inside_point,
    mesh_faces,
    triangles_of,
    triangles_of_all,
)
from flexspline.geometry.part import Part
from flexspline.geometry.sharp_edges import sharp_edges
from flexspline.geometry.surfaces import ON_SURFACE_MM, Surface, part_surfaces


@dataclass(frozen=True)
class TaggedSurface:
    """Boundary of a part's sector as triangles, and the cuts that keep patch edges in the mesh.

    Attributes
    ----------
    vertices : (n, 3) mm.
    triangles : (m, 3) indices, outward normals.
    surface_of : (m,) index into `surfaces` for each triangle.
    surfaces : the analytic surfaces.
    cut_vertices, cut_triangles : internal faces through the patch edges, (k, 3) each.
    patch_areas : CAD area of each named patch [mm²].
    volume : CAD volume [mm³].
    sharp_edges : (p, 3) points along every sharp edge and every patch edge, for the stress rule.
    critical_edges : (q, 3) those of them where the torsional stress is singular: patch edges and
        inside corners, the rims of bolt holes left out (the boss carries them).
    sector_deg : angle of the sector about z.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    surface_of: np.ndarray
    surfaces: tuple[Surface, ...]
    cut_vertices: np.ndarray
    cut_triangles: np.ndarray
    patch_areas: dict[str, float]
    volume: float
    sharp_edges: np.ndarray
    critical_edges: np.ndarray
    sector_deg: float


def tagged_surface(
    part: Part,
    sector_deg: float,
    chord_error: float,
    edge_spacing: float,
    cut_reach: float = inf,
) -> TaggedSurface:
    """Tessellate the CAD solid within `chord_error` [mm] and name its faces.

    Points along its edges are `edge_spacing` [mm] apart; cuts end `cut_reach` [mm] from patch edges.

    Raises
    ------
    GeometryError : no valid solid, a face on no known surface, or a surface that is not watertight.
    """
    solid = build_solid(part, sector_deg)
    surfaces = part_surfaces(part, sector_deg)
    mesh_faces(solid, chord_error)
    points: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    owner: list[np.ndarray] = []
    areas: dict[str, float] = defaultdict(float)
    face_surface: dict[int, int] = {}
    count = 0
    for face in solid.Faces():
        v, t = triangles_of(face)
        index = _surface_of(v, inside_point(face), surfaces)
        face_surface[face.hashCode()] = index
        if surfaces[index].patch:
            areas[surfaces[index].patch] += face.Area()
        points.append(v)
        triangles.append(t + count)
        owner.append(np.full(len(t), index))
        count += len(v)
    vertices, faces = _merged(np.concatenate(points), np.concatenate(triangles))
    surface_of = np.concatenate(owner)
    solid_faces = (
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    )
    faces, surface_of = faces[solid_faces], surface_of[solid_faces]
    _check_watertight(vertices, faces, part.name)
    cut_v, cut_t = triangles_of_all(
        partition_faces(solid, part.meridian, sector_deg, cut_reach), chord_error
    )
    sharp, critical = sharp_edges(solid, face_surface, surfaces, edge_spacing)
    return TaggedSurface(
        vertices=vertices,
        triangles=faces,
        surface_of=surface_of,
        surfaces=tuple(surfaces),
        cut_vertices=cut_v,
        cut_triangles=cut_t,
        patch_areas=dict(areas),
        volume=solid.Volume(),
        sharp_edges=sharp,
        critical_edges=critical,
        sector_deg=sector_deg,
    )


def _surface_of(vertices: np.ndarray, inside: np.ndarray, surfaces: list[Surface]) -> int:
    """The surface that all vertices lie on; of several, the one nearest to the inside point.

    A flat disc is triangulated with all its vertices on the rim, which lies on the cylinder too.
    """
    far = [np.abs(s.project(vertices) - vertices).max() for s in surfaces]
    near = [i for i, d in enumerate(far) if d < ON_SURFACE_MM]
    if not near:
        where = np.round(vertices.mean(axis=0), 3).tolist()
        raise GeometryError(f"a CAD face around {where} mm lies on no surface of the design")
    distances = [np.abs(surfaces[i].project(inside) - inside).max() for i in near]
    first = next(k for k, d in enumerate(distances) if d < min(distances) + ON_SURFACE_MM)
    return near[first]


def _merged(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Join vertices that neighbouring faces share (closer than ON_SURFACE_MM)."""
    pairs = cKDTree(vertices).query_pairs(ON_SURFACE_MM, output_type="ndarray")
    n = len(vertices)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    _, first, inverse = np.unique(label, return_index=True, return_inverse=True)
    return vertices[first], inverse.ravel()[triangles]


def _check_watertight(vertices: np.ndarray, triangles: np.ndarray, part_name: str) -> None:
    import trimesh

    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    if not (mesh.is_watertight and mesh.is_winding_consistent):
        raise GeometryError(f"the tessellated surface of the {part_name} is not watertight")
