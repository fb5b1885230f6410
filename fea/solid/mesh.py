"""From a tagged CAD surface to a checked mesh of curved quadratic tetrahedra with named patches."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from flexspline.fea.deadline import Deadline
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.facet_surfaces import patches_of
from flexspline.fea.solid.imprint import MesherMesh, with_patch_edges
from flexspline.fea.solid.mesh_checks import check_against_cad, refuse_flat
from flexspline.fea.solid.quadratic import boundary_faces, straightened, with_middles
from flexspline.fea.solid.sizing import Grading, graded_background
from flexspline.fea.solid.snap import (
    into_sector_planes,
    snap_middles,
    snap_to_surfaces,
    undo_inverted,
)
from flexspline.fea.solid.tetwild import MESHER_SECONDS, TetwildSettings, tetrahedralize
from flexspline.fea.solid.unroll import Cartesian, MeshingMap, Unrolled
from flexspline.fea.types import TetMesh
from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.geometry.nearest import nearest_triangles
from flexspline.geometry.percent import percent
from flexspline.geometry.tagged import TaggedSurface

ASTRAY_SHARE = 0.002
"""Share of the boundary that may face another way than the CAD. A few facets across sharp edges do; a crack
along a cut would be many facets."""
ENVELOPES_PER_EDGE = 6
"""Smallest edge over the envelope, at least. With wider envelopes the mesher's surface has cracked."""
RETRIES = ((1.0, True), (0.95, True), (0.9, False))
"""For each attempt at a mesh: its edge lengths over those asked for, and whether it may use unrolled space.
Other edges make another mesh, and the last attempt does without the unrolling."""


@dataclass(frozen=True)
class MeshSpec:
    """Requirements on a mesh; lengths in mm.

    `unrolled_radius` 0 meshes in part space, otherwise see `fea.solid.unroll`. `time_limit_s` is the
    mesher's, for all its attempts.
    """

    grading: Grading
    envelope: float
    snap_limit: float
    unrolled_radius: float = 0.0
    time_limit_s: float = MESHER_SECONDS

    def scaled(self, factor: float) -> MeshSpec:
        """Return the requirements for a mesh `factor` times as coarse."""
        return replace(
            self,
            grading=self.grading.scaled(factor),
            envelope=self.envelope * factor,
            snap_limit=self.snap_limit * factor,
        )


def mesh_surface(surface: TaggedSurface, spec: MeshSpec) -> TetMesh:
    """Mesh a part's sector; the mesher is not deterministic, so a poor mesh is tried again, finer.

    Raises
    ------
    MesherError : from the mesher.
    MeshQualityError : a patch or the volume is not the CAD's, or an element is inverted.
    """
    until = Deadline(spec.time_limit_s)
    for factor, unrolled in RETRIES:
        left_s = spec.time_limit_s - until.elapsed()
        if left_s <= 0:
            break
        radius = spec.unrolled_radius if unrolled else 0.0
        grading = spec.grading.scaled(factor)
        try:
            complete = replace(spec, grading=grading, unrolled_radius=radius, time_limit_s=left_s)
            return _mesh_once(surface, complete)
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
    settings = TetwildSettings(spec.grading.far, spec.envelope, time_limit_s=spec.time_limit_s)
    box = vertices.min(axis=0), vertices.max(axis=0)
    background = graded_background(space.to(surface.critical_edges), box, spec.grading)
    points, tets = tetrahedralize(vertices, triangles, settings, background)
    points, tets = _without_orphans(points, tets)
    faces = boundary_faces(tets)
    raw = MesherMesh(points, tets, faces, _tag(points, faces, boundary, surface, spec))
    return _quadratic(with_patch_edges(raw, surface.surfaces, space), surface, space, spec)


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
    normals /= np.maximum(areas, ABOVE_ZERO)[:, None]
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
            f"{percent(astray)} of the mesh's boundary lies on no CAD surface, allowed "
            f"{percent(ASTRAY_SHARE)}"
        )
    return surface.surface_of[triangle]


def _quadratic(
    mesh: MesherMesh, surface: TaggedSurface, space: MeshingMap, spec: MeshSpec
) -> TetMesh:
    """Put corners on the exact surfaces, add middle nodes, put those on the surfaces too."""
    tets, faces, facet_surface = mesh.tets, mesh.faces, mesh.facet_surface
    raw = into_sector_planes(
        space.back(mesh.points), faces, facet_surface, surface.surfaces, surface.sector_deg
    )
    corners = snap_to_surfaces(raw, faces, facet_surface, surface.surfaces, spec.snap_limit)
    corners = undo_inverted(raw, corners, tets)
    refuse_flat(corners, tets)
    edges, cells, facets = with_middles(corners, tets, faces)
    # a middle follows its corners in meshing space, then goes onto the surface itself
    middles = space.back(space.to(corners)[edges].mean(axis=1))
    nodes = snap_middles(
        np.vstack([corners, middles]),
        edges,
        facets,
        facet_surface,
        surface.surfaces,
        spec.snap_limit,
    )
    nodes = straightened(nodes, cells, edges, facets)
    patches = patches_of(facet_surface, surface.surfaces)
    made = TetMesh(nodes, cells, facets, *patches, surface.sector_deg)
    check_against_cad(made, surface)
    return made
