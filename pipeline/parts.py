"""One part of a gear: CAD, mesh and torsional stiffness, each answered from the cache when it can."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.shortfall import of_the_machine
from flexspline.fea.solid.defaults import first_spec, surface_to_mesh
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.stiffness import solid_stiffness
from flexspline.fea.solid.swept import can_be_swept, swept_edges, swept_mesh
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.toothed_ring.equivalent import EquivalentRing
from flexspline.fea.types import Elastic, Stiffness, StressPeak, TetMesh
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.exclusion import exclusion_mm
from flexspline.geometry.meridian import meridian
from flexspline.geometry.symmetry import Sector, sector_of
from flexspline.geometry.tagged import TaggedSurface
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.drawn_teeth import of_toothed, ring_of, with_plain_ring
from flexspline.pipeline.progress import Progress

DRIVEN = {"flexspline": "mesh", "shaft": "grip"}
RIM_ELEMENTS = 40_000
"""About 180 000 unknowns and 5 s for each of the two lobe cases."""
EDGE_POINTS = 8
"""Of sharp edges, within the stress rule's distance from them."""


@dataclass(frozen=True)
class MeshedPart:
    """A mesh and the sharp edges (k, 3) [mm] of the same sector, for the stress rule."""

    mesh: TetMesh
    sharp_edges: np.ndarray


@dataclass(frozen=True)
class TwistedPart:
    """A solid part's stiffness and its displacement (n, 3) mm for a turn of 1 rad.

    `rim` is the finest of its meshes that, unfolded for the lobe cases, keeps within RIM_ELEMENTS.
    """

    stiffness: Stiffness
    meshed: MeshedPart
    displacement: np.ndarray
    rim: MeshedPart


@dataclass(frozen=True)
class AnalysisContext:
    """What every stage needs: the design, the cache, and somebody to tell."""

    design: Design
    cache: Cache
    progress: Progress

    @cached_property
    def ring(self) -> EquivalentRing | None:
        """The plain ring that stands for drawn teeth; None where none are drawn."""
        return ring_of(self.design, self.cache, self.progress)

    def part(self, name: str) -> PartModel:
        """Its model; a flexspline's teeth enter it as the equivalent plain ring."""
        if name == "shaft" or self.ring is None:
            return PartModel(self, name)
        plain = replace(self, design=with_plain_ring(self.design, self.ring))
        return PartModel(plain, name, toothed=True)


def is_lasting(found: Stiffness | StressPeak) -> bool:
    """Whether a figure would be the same on a machine with more time and memory."""
    return not of_the_machine(found.shortfall)


@dataclass(frozen=True)
class PartModel:
    """The flexspline or the shaft of a design.

    `toothed`: teeth are drawn, and the plain ring of the context's design stands for them.
    """

    context: AnalysisContext
    name: str
    toothed: bool = False

    @property
    def material(self) -> Elastic:
        design = self.context.design
        own = design.shaft_material if self.name == "shaft" else design.material.flexspline
        return Elastic.of(own)

    @property
    def sector(self) -> Sector:
        return sector_of(self.context.design, self.name, "torsion")

    @property
    def is_revolved(self) -> bool:
        """Whether the part is a body of revolution."""
        design = self.context.design
        if self.name == "shaft":
            return not design.shaft.bolt_count and design.shaft.keyway is None
        return not design.flexspline.bolt_count

    @property
    def geometry_key(self) -> Mapping[str, Any]:
        """What the part's shape depends on, and nothing else; its teeth are in the ring by now."""
        design = self.context.design
        own = design.shaft if self.name == "shaft" else design.flexspline
        shape = own.model_dump(mode="json", exclude={"teeth", "tooth_flank"})
        return {"part": self.name, "shape": shape}

    @property
    def revolved_key(self) -> Mapping[str, Any]:
        """What the axisymmetric solutions depend on."""
        return {
            **self.geometry_key,
            "material": asdict(self.material),
            "tolerance_pct": self.context.design.solver.tolerance_pct,
        }

    @property
    def torsion_key(self) -> Mapping[str, Any]:
        """What the solid solution depends on."""
        return {**self.revolved_key, "spec": asdict(first_spec(self.context.design, self.name))}

    @property
    def exclusion_mm(self) -> float:
        """The stress rule's distance from sharp edges and patch edges."""
        design = self.context.design
        return exclusion_mm(design.shaft if self.name == "shaft" else design.flexspline)

    @property
    def _edge_spacing(self) -> float:
        return self.exclusion_mm / EDGE_POINTS

    @cached_property
    def _surface(self) -> TaggedSurface:
        with self.context.progress.stage(f"CAD of the {self.name}"):
            return surface_to_mesh(
                self.context.design, self.name, self.sector.degrees, self._edge_spacing
            )

    def swept(self, spec: MeshSpec, finer: Finer | None = None) -> MeshedPart | None:
        """The sector's mesh swept from the meridian; None for a part that only a mesher can mesh."""
        design, degrees = self.context.design, self.sector.degrees
        mesh = swept_mesh(design, self.name, degrees, spec, finer)
        if mesh is None:
            return None
        return MeshedPart(mesh, swept_edges(design, self.name, degrees, self._edge_spacing))

    def meshed(self, spec: MeshSpec) -> MeshedPart:
        """The sector's mesh to a specification: swept where that works, else by fTetWild."""

        def make() -> MeshedPart:
            if can_be_swept(self.context.design, self.name):
                with self.context.progress.stage(f"mesh of the {self.name}"):
                    swept = self.swept(spec)
                if swept is not None:
                    return swept
                self.context.progress.note("  the swept mesh fails a check: fTetWild instead")
            surface = self._surface
            with self.context.progress.stage(f"mesh of the {self.name}"):
                return MeshedPart(mesh_surface(surface, spec), surface.sharp_edges)

        inputs = {**self.geometry_key, "spec": asdict(spec)}
        return self.context.cache.get("mesh", inputs, make)[0]

    def stiffness(self) -> Stiffness:
        """K by the design's `solver.model`: axisymmetric where the part allows it, else solid."""
        if not self.axisymmetric:
            return self.twisted().stiffness
        found = self._axisymmetric_stiffness()
        return of_toothed(found) if self.toothed else found

    @property
    def axisymmetric(self) -> bool:
        """Whether K comes from the axisymmetric model.

        Raises
        ------
        DesignError : that model is asked for and the part has holes or a keyway.
        """
        wanted = self.context.design.solver.model
        if wanted == "axisymmetric" and not self.is_revolved:
            raise DesignError(
                "solver.model",
                wanted,
                f"the {self.name} has bolt holes or a keyway and is no body of revolution;"
                ' "solid" or "auto" works',
            )
        return self.is_revolved and wanted != "solid"

    def _axisymmetric_stiffness(self) -> Stiffness:
        design = self.context.design
        tolerance = design.solver.tolerance_pct / 100

        def make() -> Stiffness:
            with self.context.progress.stage(f"axisymmetric bounds of the {self.name}"):
                outline = meridian(design, self.name)
                return torsional_stiffness(
                    outline, self.material, DRIVEN[self.name], tolerance, Deadline(STAGE_SECONDS)
                )

        return self.context.cache.get("axisymmetric", self.revolved_key, make, is_lasting)[0]

    def twisted(self) -> TwistedPart:
        """The solid model turned by 1 rad, refined until the tolerance is met."""
        design = self.context.design

        def make() -> TwistedPart:
            with self.context.progress.stage(f"torsion of the {self.name}"):
                edges: dict[MeshSpec, np.ndarray] = {}

                def mesher(spec: MeshSpec) -> TetMesh:
                    made = self.meshed(spec)
                    edges[spec] = made.sharp_edges
                    return made.mesh

                found = solid_stiffness(
                    mesher,
                    first_spec(design, self.name),
                    self.material,
                    DRIVEN[self.name],
                    design.solver.tolerance_pct / 100,
                    self.sector.label,
                    lambda text: self.context.progress.note(f"  {self.name}: {text}"),
                )
            sharp = next(iter(edges.values()))
            meshed = [MeshedPart(mesh, sharp) for mesh in found.meshes]
            times = sector_of(design, self.name, "ellipse").degrees / self.sector.degrees
            sizes = [len(m.mesh.cells) * times for m in meshed]
            rim = max(1, sum(size <= RIM_ELEMENTS for size in sizes)) - 1
            return TwistedPart(found.stiffness, meshed[-1], found.solved.displacement, meshed[rim])

        return self.context.cache.get(
            "torsion", self.torsion_key, make, lambda made: is_lasting(made.stiffness)
        )[0]
