"""Layered meshes, without a mesher, of shafts whose holes or keyway cannot be swept about the axis.

Each cross-section's prisms along the axis (`fea.solid.layers`), cut into tetrahedra; then edges are halved
where the grading asks for shorter ones, new nodes on the exact surfaces. The same design gives the same
mesh.
"""

from __future__ import annotations

from math import inf, radians

import numpy as np

from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.curving import quadratic
from flexspline.fea.solid.layer_grading import graded
from flexspline.fea.solid.layer_mesh import coarsest
from flexspline.fea.solid.layer_sizes import face_area, volume, wall_area
from flexspline.fea.solid.layers import Layers
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.mesh_checks import VOLUME, check_sizes
from flexspline.fea.solid.polar import cartesian, polar
from flexspline.fea.solid.seams import seams_of
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.snap import common_point
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import part_surfaces


def layered_mesh(
    part: Part, sector_deg: float, spec: MeshSpec, most_elements: float = inf
) -> BisectableMesh:
    """Return the mesh of a shaft's sector, graded as `spec` says.

    Raises
    ------
    MeshingError, MeshQualityError : lines of the cross-sections too near each other, or a failed check.
    TooManyElementsError : more than `most_elements`.
    """
    layers = Layers.of(part, radians(sector_deg))
    surfaces = part_surfaces(part, sector_deg)
    grading = spec.grading
    most = min(most_elements, MOST_ELEMENTS)
    points, mesh = coarsest(layers, surfaces, grading, most)
    points, mesh = graded(points, mesh, surfaces, grading, most)
    made = quadratic(points, mesh, surfaces, sector_deg, most, in_layers=True)
    check_layered(made, part)
    return made


def check_layered(mesh: BisectableMesh, part: Part) -> None:
    """Compare volume and patch areas with integrals over the cross-sections.

    Raises
    ------
    MeshQualityError : one of them is off.
    """
    check_sizes(mesh, _sizes(Layers.of(part, radians(mesh.sector_deg))))


def _sizes(layers: Layers) -> dict[str, float]:
    """Volume and patch areas, by integrals over the cross-sections."""
    sizes = {VOLUME: volume(layers)}
    segments = layers.part.meridian.segments
    for patch in {s.patch for s in segments if s.patch}:
        area = 0.0
        for s in (s for s in segments if s.patch == patch):
            (r0, z0), (r1, z1) = s.start, s.end
            if z0 == z1:
                area += face_area(layers, min(r0, r1), max(r0, r1), z0)
            else:
                area += wall_area(layers, r0, min(z0, z1), max(z0, z1))
        sizes[patch] = area
    return sizes


def layered_edges(part: Part, sector_deg: float, spacing: float) -> np.ndarray:
    """Return points (k, 3) every `spacing` mm along the sharp edges and patch edges of a shaft in layers.

    Raises
    ------
    MeshingError, MeshQualityError : as `layered_mesh`.
    """
    surfaces = part_surfaces(part, sector_deg)
    size = part.length  # the coarsest mesh has all edges
    points, mesh = coarsest(Layers.of(part, radians(sector_deg)), surfaces, Grading(size, size))
    seams = seams_of(points, mesh.facets, mesh.facet_surface, surfaces)
    ends, on = points[seams.nodes[seams.sharp]], seams.surfaces[seams.sharp]
    counts = np.maximum(2, np.ceil(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / spacing) + 1)
    lines = []
    for count in np.unique(counts):
        along = np.linspace(0, 1, int(count))[None, :, None]
        a, b = (polar(ends[counts == count, k])[:, None] for k in (0, 1))
        lines.append(cartesian((a + along * (b - a)).reshape(-1, 3)))
    pairs = np.vstack([np.repeat(on[counts == c], int(c), axis=0) for c in np.unique(counts)])
    every = np.vstack(lines)
    for both in np.unique(pairs, axis=0):
        mine = (pairs == both).all(axis=1)
        every[mine] = common_point(every[mine], [surfaces[i] for i in both])[0]
    return every
