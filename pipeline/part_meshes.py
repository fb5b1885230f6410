"""Meshes of a part's sector: swept from its meridian where that works, else made from its CAD surface."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property

import numpy as np

from flexspline.fea.solid.defaults import surface_to_mesh
from flexspline.fea.solid.errors import SolidError
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.swept import swept_edges, swept_mesh
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.types import TetMesh
from flexspline.geometry.tagged import TaggedSurface
from flexspline.pipeline.parts import PartModel

COARSER, COARSENINGS = 1.5, 3
"""Edges of the next, coarser try over the last: a third of the elements; and how many tries."""
ANOTHER = 0.8
"""Edges of the second try where a sweep fails a check: elements beside a keyway may be bent too far in one
mesh and not in the next, and fTetWild takes minutes where a sweep takes a second."""
EDGE_POINTS = 8
"""Of sharp edges, within the stress rule's distance from them."""


@dataclass(frozen=True)
class MeshedPart:
    """A mesh and the sharp edges (k, 3) [mm] of the same sector, for the stress rule."""

    mesh: TetMesh
    sharp_edges: np.ndarray


@dataclass(frozen=True)
class PartMeshes:
    """The meshes that can be had of a part; its CAD surface is made once, where one needs it."""

    model: PartModel

    @property
    def _edge_spacing(self) -> float:
        return self.model.part.exclusion_mm / EDGE_POINTS

    @cached_property
    def _surface(self) -> TaggedSurface:
        model = self.model
        with model.context.progress.stage(f"CAD of the {model.name}"):
            return surface_to_mesh(
                model.part, model.first_spec, model.sector.degrees, self._edge_spacing
            )

    def swept(self, spec: MeshSpec, finer: Finer | None = None) -> MeshedPart | None:
        """Swept from the meridian; None for a part that only a mesher can mesh."""
        part, degrees = self.model.part, self.model.sector.degrees
        mesh = swept_mesh(part, degrees, spec, finer)
        if mesh is None:
            return None
        return MeshedPart(mesh, swept_edges(part, degrees, self._edge_spacing))

    def coarsened(self, most_elements: float) -> MeshSpec:
        """The part's first specification, or a coarser one where its swept mesh has more elements than that.

        An edge length that the design states is kept, and so is the last one that can be swept.

        Raises
        ------
        DesignError, SolidError : as `meshed`.
        """
        model = self.model
        spec = model.first_spec
        if not model.is_swept or model.context.design.solver.edge_length_mm is not None:
            return spec
        for _ in range(COARSENINGS):
            coarser = spec.scaled(COARSER)
            if self.meshed(spec).mesh.elements <= most_elements or self.swept(coarser) is None:
                return spec
            spec = coarser
        return spec

    def meshed(self, spec: MeshSpec) -> MeshedPart:
        """To a specification, by `solver.mesher`: "auto" sweeps where that works. From the cache, or made.

        Raises
        ------
        DesignError : as `PartModel.is_swept`. SolidError : a sweep is asked for and fails a check.
        """
        model = self.model
        inputs = {**model.geometry_key, "spec": asdict(spec), "mesher": model.mesher}
        return model.context.cache.get("mesh", inputs, lambda: self._made(spec))[0]

    def _made(self, spec: MeshSpec) -> MeshedPart:
        model, progress = self.model, self.model.context.progress
        if model.is_swept:
            with progress.stage(f"mesh of the {model.name}"):
                swept = self.swept(spec) or self.swept(spec.scaled(ANOTHER))
            if swept is not None:
                return swept
            if model.mesher == "swept":
                raise SolidError(
                    f"the swept mesh of the {model.name} fails a check; solver.mesher"
                    ' "tetwild" or "auto" works'
                )
            progress.note("  the swept mesh fails a check: fTetWild instead")
        surface = self._surface
        with progress.stage(f"mesh of the {model.name}"):
            return MeshedPart(mesh_surface(surface, spec), surface.sharp_edges)
