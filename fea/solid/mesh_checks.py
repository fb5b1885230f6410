"""Checks of a mesh before the solve: volume, patch areas, planes of symmetry."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid.flatness import longest_edges
from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.fea.types import TetMesh
from flexspline.geometry.percent import percent
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START, sector_planes
from flexspline.geometry.tagged import TaggedSurface

AREA_TOLERANCE = 0.005
"""Largest relative difference of a patch's area from its CAD area. Parabolas for the arcs of a coarse mesh
leave 0.1 %; facets on the wrong side of a patch edge leave more."""
VOLUME_TOLERANCE = 0.01
"""Largest relative difference of the volume. Parabolas for the arcs of a coarse mesh lose 0.1 %; a mesh with
a closed hole is off by more."""
SIZE_TOLERANCE = 1e-3
"""The same for a mesh that no mesher made. Parabolas leave 1e-5 for arcs of 15° and 2e-5 for arcs of 20°, a
few straight edges of holes leave more."""
VOLUME = "volume"
"""Name of the volume beside the patches' names in `check_sizes`."""
OFF_PLANE = 1e-6
"""Largest distance of a symmetry plane's nodes from it, as a share of the part's size: rounding."""
LEAST_SHAPE = 1e-7
"""Least volume over the cube of the longest edge; 0.12 for a regular tetrahedron, 0.006 or more in meshes."""


def refuse_flat(points: np.ndarray, tets: np.ndarray) -> None:
    """Beside the axis, two nodes can be projected to the same place, so that their tetrahedron has no
    volume."""
    flat = signed_volumes(points, tets) < LEAST_SHAPE * longest_edges(points, tets) ** 3
    if flat.any():
        raise MeshQualityError(
            f"{int(flat.sum())} elements are flat once their nodes are on the CAD"
        )


def check_sizes(mesh: TetMesh, wanted: Mapping[str, float]) -> None:
    """Compare volume [mm³] and patch areas [mm²] with those `wanted`, by VOLUME or the patch's name.

    Raises
    ------
    MeshQualityError : one of them is off.
    """
    space = SolidSpace.of(mesh)
    for what, right in wanted.items():
        actual = float((space.volumes if what == VOLUME else space.areas(what)).sum())
        if not abs(actual / right - 1) < SIZE_TOLERANCE:
            unit = "mm³" if what == VOLUME else "mm²"
            raise MeshQualityError(
                f"{_in_words(what)}: {actual:.6g} {unit} in the mesh, {right:.6g} in the part:"
                " a smaller solver.edge_length_mm describes it better"
            )


def check_against_cad(mesh: TetMesh, surface: TaggedSurface) -> None:
    """Compare volume and patch areas with the CAD's, and symmetry planes with themselves."""
    size = np.ptp(mesh.nodes, axis=0).max()
    for plane in sector_planes(mesh.sector_deg):
        nodes = mesh.nodes[mesh.nodes_on(plane.patch)]
        # at 180° both planes are one, and its facets all go by the first name
        off = np.abs(plane.project(nodes) - nodes).max(initial=0.0)
        if off > OFF_PLANE * size:
            raise MeshQualityError(
                f"a node of {_in_words(plane.patch)} lies {off:.3g} mm off the plane"
            )
    space = SolidSpace.of(mesh)
    volume = space.volumes.sum()
    if abs(volume / surface.volume - 1) > VOLUME_TOLERANCE:
        raise MeshQualityError(
            f"the mesh holds {volume:.6g} mm³, the CAD solid {surface.volume:.6g} mm³"
        )
    for patch, wanted in surface.patch_areas.items():
        area = space.areas(patch).sum()
        if abs(area / wanted - 1) > AREA_TOLERANCE:
            raise MeshQualityError(
                f"the mesh describes {_in_words(patch)} badly: {area:.6g} mm² of {wanted:.6g} mm², "
                f"{percent(abs(area / wanted - 1))} off where {percent(AREA_TOLERANCE)} is allowed"
            )


def _in_words(patch: str) -> str:
    """The name of a patch in messages. Users know the named patches (docs/contract.md), but not the planes at
    which a sector is cut."""
    if patch in (SYMMETRY_START, SYMMETRY_END):
        return "the plane at which the part is cut for its symmetry"
    return "the volume" if patch == VOLUME else f"patch '{patch}'"
