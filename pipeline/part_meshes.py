"""Meshes of a part's sector: swept from its meridian where that works, a shaft's then in layers along the
axis, else made from its CAD surface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from math import inf
from typing import Any, Literal, get_args

import numpy as np

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.errors import MeshQualityError, SolidError, TooManyElementsError
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.defaults import surface_to_mesh
from flexspline.fea.solid.layered import layered_mesh
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.sweeps import goes_about_axis
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.swept_edges import swept_edges
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.types import TetMesh
from flexspline.geometry.errors import FlexsplineError
from flexspline.geometry.part_name import PartName
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.tagged import TaggedSurface
from flexspline.pipeline.fitting_edge import StatedEdgeError, fitting_edge_mm
from flexspline.pipeline.parts import LAYERED_COARSER, PartModel

MeshKind = Literal["swept", "layered", "tetwild"]
"""Swept about the axis, a shaft's layers along it, or fTetWild's."""
KINDS: tuple[MeshKind, ...] = get_args(MeshKind)
"""In the order in which they are tried."""
SWEEPS: tuple[MeshKind, ...] = ("swept", "layered")
"""Those that no mesher makes."""

COARSER_EDGES = 1.5
"""Edges of the next, coarser try over the last: a third of the elements, half of a thin plate's."""
COARSENINGS: Mapping[PartName, int] = {"flexspline": 6, "shaft": 3}
"""How many tries. A hat of 53 mm, its flange 183 mm wide and 0.19 mm thick, had 64 119 elements after three,
known to ± 0.06 % where 1 % was asked, and 39 303 after six. A shaft that has too many after three is answered
without its fillets, or meshed in layers, where each try costs as much as the mesh."""
COARSENINGS_UNCOUNTED = 6
"""Of a part that is swept along its axis only: a mesh in layers is given up midway, so its elements say
little about the next one's. A shaft with a deep slot was given up at 119 628, 91 863, 86 754 elements. The
second mesh had 186 732, which took five minutes and 2.9 GB to solve; the seventh has 55 022: 17 s."""
FIRST_ELEMENTS = 12_000
"""Of a first mesh: 55 000 unknowns. One of 57 000 elements took more than two minutes on a disc with small
holes (10.7 mm across, holes of 0.74 mm), one of 18 600 six seconds; a shaft of two segments whose slot goes
beyond the axis had 85 730, a minute and a half, and 21 853 with edges four times as long."""
AS_COARSE_AS_CAN_BE = 100.0
"""Edges of what follows these tries, over theirs: only the shape's own lines ask for elements then. A shaft
had 37 928 in place of 68 588, and took 10 in place of 18 s of the processor."""
HARDLY_FEWER = 0.9
"""Elements with longer edges over those before, from which the shape asks for them and no edge length: still
longer edges would only make the next meshes the same. A shaft of 15 468 elements, with 1.5 and 3.4 times
the edges alike, was solved twice on one mesh."""
SECOND_TRY_EDGES = 0.8
"""Edges of the second try where a sweep fails a check: elements beside a keyway may be bent too far in one
mesh and not in the next, and fTetWild takes minutes where a sweep takes a second."""
EDGE_POINTS = 8
"""Of sharp edges, within the stress rule's distance from them: the distance to the nearest is 0.2 % more than
that to the edge at most."""


class OtherKindError(FlexsplineError):
    """Meshes of two kinds are no sequence: between them K moves by more than its bounds.

    `kind` is the last one's.
    """

    def __init__(self, kind: MeshKind) -> None:
        self.kind = kind
        super().__init__(f"the next mesh is another kind: {kind}")


@dataclass(frozen=True)
class MeshedPart:
    """A mesh, how it was made, and its sector's sharp edges (k, 3) [mm] for the stress rule."""

    mesh: TetMesh
    sharp_edges: np.ndarray
    kind: MeshKind


@dataclass(frozen=True)
class PartMeshes:
    """Makes the meshes of a part; its CAD surface is made once, where a mesh needs it."""

    model: PartModel
    kinds: tuple[MeshKind, ...] = KINDS
    """Those that are tried, of what the part allows."""
    most_of_first: float = inf
    """Elements of a first mesh, after all coarsening, beyond which it is not begun."""

    @cached_property
    def _failed(self) -> set[tuple[MeshKind, MeshSpec]]:
        """Sweeps that failed a check: they would again."""
        return set()

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
        """Return a mesh swept from the meridian or in layers; None for a part that only a mesher can mesh.

        Raises
        ------
        TooManyElementsError : as `swept_mesh`.
        """
        part, degrees = self.model.part, self.model.sector.degrees
        if finer is None and ("swept", spec) in self._failed:
            return None
        mesh = swept_mesh(part, degrees, spec, finer, most_elements)
        if mesh is None:
            self._failed.add(("swept", spec))
            return None
        return self._of_sweep(mesh)

    def layered(self, spec: MeshSpec) -> MeshedPart | None:
        """Return a mesh in layers of a shaft whose sweep about the axis fails; None where that fails too."""
        model = self.model
        if not isinstance(model.part.shape, Shaft) or not goes_about_axis(model.part):
            return None  # `swept` has tried what there is
        if ("layered", spec) in self._failed:
            return None
        try:
            if model.states_edges:
                return self._of_sweep(layered_mesh(model.part, model.sector.degrees, spec))
            return self._of_sweep(self._coarsened_layers(spec.scaled(LAYERED_COARSER)))
        except (MeshQualityError, MeshingError, TooManyElementsError):
            self._failed.add(("layered", spec))
            return None

    def _coarsened_layers(self, spec: MeshSpec) -> BisectableMesh:
        """To a specification, or to a coarser one where it has more than FIRST_ELEMENTS elements by that.

        As `coarsened`, but that a mesh in layers is given up midway: nothing says how many elements it would
        have had, and whether longer edges leave fewer.

        Raises
        ------
        MeshQualityError, MeshingError, TooManyElementsError : as `layered_mesh`.
        """
        part, degrees = self.model.part, self.model.sector.degrees
        before = spec
        for _ in range(COARSENINGS["shaft"]):
            try:
                return layered_mesh(part, degrees, spec, FIRST_ELEMENTS)
            except TooManyElementsError:
                spec, before = spec.scaled(LAYERED_COARSER), spec
            except (MeshQualityError, MeshingError):
                if spec == before:
                    raise
                return layered_mesh(part, degrees, before)
        return layered_mesh(part, degrees, spec, self.most_of_first)

    def _of_sweep(self, mesh: BisectableMesh) -> MeshedPart:
        model = self.model
        edges = swept_edges(model.part, model.sector.degrees, self._edge_spacing)
        return MeshedPart(mesh, edges, "layered" if mesh.in_layers else "swept")

    def coarsened(self, most_elements: float) -> MeshSpec:
        """Return the first specification, or a coarser one where its swept mesh has too many elements.

        An edge length that the design states is kept, and so is the last one that can be swept.

        Raises
        ------
        DesignError : as `PartModel.is_swept`. TooManyElementsError : the coarsest is too large to begin,
            or has more than `most_of_first`.
        """
        model = self.model
        spec = before = model.first_spec
        if not model.is_swept or "swept" not in self.kinds or model.states_edges:
            return spec
        elements = inf  # of the mesh before
        counted = goes_about_axis(model.part)
        for _ in range(COARSENINGS[model.name] if counted else COARSENINGS_UNCOUNTED):
            try:
                chosen = self._swept_or(before, spec, most_elements)
                break
            except TooManyElementsError as fault:
                if counted and fault.elements > HARDLY_FEWER * elements:
                    return self._swept_or(before, before, self.most_of_first)
                elements, spec, before = fault.elements, spec.scaled(COARSER_EDGES), spec
        else:
            last = spec if counted else spec.scaled(AS_COARSE_AS_CAN_BE)
            chosen = self._swept_or(before, last, self.most_of_first)
        if chosen is before and self.most_of_first < elements < inf:
            raise TooManyElementsError(elements, self.most_of_first)
        return chosen

    def _swept_or(self, before: MeshSpec, spec: MeshSpec, most_elements: float) -> MeshSpec:
        """`spec`, whose swept mesh is kept; or the one before, where that fails a check."""
        with self.model.context.progress.stage(f"mesh of the {self.model.name}"):
            if self.model.context.cache.has("mesh", self._key(spec)):
                kept = self.meshed(spec)
                if kept.kind != ("swept" if goes_about_axis(self.model.part) else "layered"):
                    return before
                if kept.mesh.elements > most_elements:
                    raise TooManyElementsError(kept.mesh.elements, most_elements)
                return spec
            swept = self.swept(spec, most_elements=most_elements)
        if swept is None:
            return before
        self._kept(spec, lambda: swept)
        return spec

    def meshed(self, spec: MeshSpec) -> MeshedPart:
        """Mesh to a specification by `solver.mesher`, from the cache or new: "auto" sweeps where that works.

        Raises
        ------
        DesignError : as `PartModel.is_swept`. SolidError : a sweep is asked for and fails a check.
        OtherKindError : of the `kinds` none is left.
        StatedEdgeError : the edges that the design states ask for too many elements.
        """
        edge = self.model.context.design.solver.edge_length_mm
        try:
            return self._kept(spec, lambda: self._made(spec))
        except TooManyElementsError as fault:
            if edge is None or spec.grading != self.model.first_spec.grading:
                raise
            model = self.model
            fits = fitting_edge_mm(model.part, model.sector, edge)
            raise StatedEdgeError(model.name, edge, fault.elements, fits) from fault

    def _kept(self, spec: MeshSpec, make: Callable[[], MeshedPart]) -> MeshedPart:
        """From the cache, or made."""
        return self.model.context.cache.get("mesh", self._key(spec), make)[0]

    def _key(self, spec: MeshSpec) -> Mapping[str, Any]:
        """What a mesh is kept by; how long making it may take is no part of what is asked."""
        model, wanted = self.model, asdict(spec)
        del wanted["time_limit_s"]
        return {
            **model.geometry_key,
            "spec": wanted,
            "states_edges": model.states_edges,
            "mesher": model.mesher
            if self.kinds == KINDS
            else ", ".join((model.mesher, *self.kinds)),
        }

    def _made(self, spec: MeshSpec) -> MeshedPart:
        model, progress = self.model, self.model.context.progress
        if model.is_swept and self.kinds[0] != "tetwild":
            with progress.stage(f"mesh of the {model.name}"):
                made = self._swept_or_layered(spec)
            if made is not None:
                return made
            if model.mesher == "swept":
                raise SolidError(
                    f"the swept mesh of the {model.name} fails a check; solver.mesher"
                    ' "tetwild" or "auto" works'
                )
            if "tetwild" not in self.kinds:
                raise OtherKindError("tetwild")
            progress.note("  the swept mesh fails a check: fTetWild instead")
        surface = self._surface  # by CAD, a stage of its own
        with progress.stage(f"mesh of the {model.name}"):
            return MeshedPart(mesh_surface(surface, spec), surface.sharp_edges, "tetwild")

    def _swept_or_layered(self, spec: MeshSpec) -> MeshedPart | None:
        made = None
        if "swept" in self.kinds:
            made = self.swept(spec) or self.swept(spec.scaled(SECOND_TRY_EDGES))
        return made or self.layered(spec)
