"""A mesh made without a mesher, whose edges can be halved on the part's exact surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.solid.bisect import Simplices
from flexspline.fea.types import TetMesh


@dataclass(frozen=True)
class BisectableMesh(TetMesh):
    """A mesh that is swept about the axis, or in layers along it.

    Attributes
    ----------
    facet_surface : (k,) number of the part's surface of each facet, as in `geometry.surfaces.part_surfaces`.
    in_layers : along the axis.
    """

    facet_surface: np.ndarray
    in_layers: bool

    @property
    def corners(self) -> np.ndarray:
        """Places of the corners (n, 3) mm."""
        return self.nodes[: int(self.cells[:, :4].max()) + 1]

    @property
    def simplices(self) -> Simplices:
        """The straight tetrahedra and facets on the corners."""
        tets, facets = self.cells[:, :4], self.facets[:, :3]
        return Simplices(len(self.corners), tets, facets, self.facet_surface)
