"""Meshes of a part's sector: swept from its meridian where that works, else made from its CAD surface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cached_property
from math import inf

import numpy as np

from flexspline.fea.solid.defaults import surface_to_mesh
from flexspline.fea.solid.errors import SolidError, TooManyElementsError
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.swept_edges import swept_edges
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
    """A mesh, whether it is swept, and its sector's sharp edges (k, 3) [mm] for the stress rule."""

    mesh: TetMesh
    sharp_edges: np.ndarray
    swept: bool


@dataclass(frozen=True)
class PartMeshes:
    """The meshes that can be had of a part; its CAD surface is made once, where one needs it."""

    model: PartModel
    sweeps: bool = True
    """Whether parts that can be swept are; else fTetWild makes every mesh."""

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

    def swept(
        self, spec: MeshSpec, finer: Finer | None = None, most_elements: float = inf
    ) -> MeshedPart | None:
        """Swept from the meridian; None for a part that only a mesher can mesh.

        Raises
        ------
        TooManyElementsError : as `swept_mesh`.
        """
        part, degrees = self.model.part, self.model.sector.degrees
        mesh = swept_mesh(part, degrees, spec, finer, most_elements)
        if mesh is None:
            return None
        return MeshedPart(mesh, swept_edges(part, degrees, self._edge_spacing), swept=True)

    def coarsened(self, most_elements: float) -> MeshSpec:
        """The part's first specification, or a coarser one where its swept mesh has more elements than that.

        An edge length that the design states is kept, and so is the last one that can be swept.

        Raises
        ------
        DesignError : as `PartModel.is_swept`. TooManyElementsError : the coarsest is too large to begin.
        """
        model = self.model
        spec = before = model.first_spec
        if not model.is_swept or model.context.design.solver.edge_length_mm is not None:
            return spec
        for tried in range(COARSENINGS + 1):
            most = most_elements if tried < COARSENINGS else inf
            try:
                with model.context.progress.stage(f"mesh of the {model.name}"):
                    swept = self.swept(spec, most_elements=most)
            except TooManyElementsError:
                spec, before = spec.scaled(COARSER), spec
                continue
            if swept is None:
                return before
            self._keep(spec, swept)
            break
        return spec

    def _keep(self, spec: MeshSpec, made: MeshedPart) -> None:
        self._kept(spec, lambda: made)

    def meshed(self, spec: MeshSpec) -> MeshedPart:
        """To a specification, by `solver.mesher`: "auto" sweeps where that works. From the cache, or made.

        Raises
        ------
        DesignError : as `PartModel.is_swept`. SolidError : a sweep is asked for and fails a check.
        """
        return self._kept(spec, lambda: self._made(spec))

    def _kept(self, spec: MeshSpec, make: Callable[[], MeshedPart]) -> MeshedPart:
        """From the cache, or made; how long making it may take is no part of what is asked."""
        model, wanted = self.model, asdict(spec)
        del wanted["time_limit_s"]
        inputs = {
            **model.geometry_key,
            "spec": wanted,
            "mesher": model.mesher if self.sweeps else "tetwild",
        }
        return model.context.cache.get("mesh", inputs, make)[0]

    def _made(self, spec: MeshSpec) -> MeshedPart:
        model, progress = self.model, self.model.context.progress
        if model.is_swept and self.sweeps:
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
            return MeshedPart(mesh_surface(surface, spec), surface.sharp_edges, swept=False)
