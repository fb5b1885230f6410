"""A finer mesh by the errors of a coarser one's elements, without a mesher."""

from __future__ import annotations

import numpy as np

from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.layer_curving import quadratic
from flexspline.fea.solid.layer_refining import refined
from flexspline.fea.solid.layered import check_layered
from flexspline.fea.solid.swept import check_swept
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import part_surfaces


def finer_by_error(
    part: Part, mesh: BisectableMesh, error: np.ndarray, wanted: float
) -> BisectableMesh:
    """The mesh with so many elements as are `wanted`, shorter edges where its elements' errors (m,) are.

    Raises
    ------
    MeshQualityError : elements are flat or bent too far, or a size is not the part's.
    TooManyElementsError : more than MOST_ELEMENTS.
    """
    surfaces = part_surfaces(part, mesh.sector_deg)
    points, finer = refined(mesh.corners, mesh.simplices, surfaces, error, wanted)
    made = quadratic(points, finer, surfaces, mesh.sector_deg, MOST_ELEMENTS, mesh.in_layers)
    check = check_layered if mesh.in_layers else check_swept
    check(made, part)
    return made
