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
from flexspline.fea.solid.errors import SolidError
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.stiffness import solid_stiffness
from flexspline.fea.solid.swept import can_be_swept, swept_edges, swept_mesh
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.toothed_ring.equivalent import EquivalentRing
from flexspline.fea.types import Elastic, Stiffness, StressPeak, TetMesh
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.part import Part, PartName
from flexspline.geometry.symmetry import Sector, sector_of
from flexspline.geometry.tagged import TaggedSurface
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.drawn_teeth import of_toothed, ring_of, with_plain_ring
from flexspline.pipeline.progress import Progress

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

    def part(self, name: PartName) -> PartModel:
        """Its model; a flexspline's teeth enter it as the equivalent plain ring."""
        if name == "shaft" or self.ring is None:
            return PartModel(self, self.design.part(name))
        plain = replace(self, design=with_plain_ring(self.design, self.ring))
        return PartModel(plain, plain.design.part(name), toothed=True)


def is_lasting(found: Stiffness | StressPeak) -> bool:
    """Whether a figure would be the same on a machine with more time and memory."""
    return not of_the_machine(found.shortfall)


@dataclass(frozen=True)
class PartModel:
    """The flexspline or the shaft of a design.

    `toothed`: teeth are drawn, and the plain ring of the context's design stands for them.
    """

    context: AnalysisContext
    part: Part
    toothed: bool = False

    @property
    def name(self) -> PartName:
        return self.part.name

    @property
    def material(self) -> Elastic:
        return Elastic.of(self.part.material)

    @property
    def sector(self) -> Sector:
        return sector_of(self.part, "torsion")

    @property
    def first_spec(self) -> MeshSpec:
        """Of its first, coarse mesh."""
        return first_spec(self.part, self.context.design.solver.edge_length_mm)

    @property
    def geometry_key(self) -> Mapping[str, Any]:
        """What the part's shape depends on, and nothing else; its teeth are in the ring by now."""
        shape = self.part.shape.model_dump(mode="json", exclude={"teeth", "tooth_flank"})
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
        return {**self.revolved_key, "spec": asdict(self.first_spec), "mesher": self._mesher}

    @property
    def _mesher(self) -> str:
        return self.context.design.solver.mesher

    @property
    def is_swept(self) -> bool:
        """Whether its solid meshes are swept from the meridian, by `solver.mesher`.

        Raises
        ------
        DesignError : that is asked for, and the part needs fTetWild.
        """
        able = can_be_swept(self.part)
        if self._mesher == "swept" and not able:
            holes = "bolt holes that no plain column of its meridian holds"
            why = holes if self.part.keyway is None else "a keyway"
            raise DesignError(
                "solver.mesher",
                self._mesher,
                f'the {self.name} has {why} and cannot be swept; "tetwild" or "auto" works',
            )
        return able and self._mesher != "tetwild"

    @property
    def _edge_spacing(self) -> float:
        return self.part.exclusion_mm / EDGE_POINTS

    @cached_property
    def _surface(self) -> TaggedSurface:
        with self.context.progress.stage(f"CAD of the {self.name}"):
            return surface_to_mesh(
                self.part, self.first_spec, self.sector.degrees, self._edge_spacing
            )

    def refuse_settings(self) -> None:
        """Refuse a model or a mesher that the part does not allow, before the long work.

        Raises
        ------
        DesignError : as `axisymmetric` and `is_swept`.
        """
        _ = self.axisymmetric, self.is_swept

    def swept(self, spec: MeshSpec, finer: Finer | None = None) -> MeshedPart | None:
        """The sector's mesh swept from the meridian; None for a part that only a mesher can mesh."""
        degrees = self.sector.degrees
        mesh = swept_mesh(self.part, degrees, spec, finer)
        if mesh is None:
            return None
        return MeshedPart(mesh, swept_edges(self.part, degrees, self._edge_spacing))

    def meshed(self, spec: MeshSpec) -> MeshedPart:
        """The sector's mesh to a specification, by `solver.mesher`: "auto" sweeps where that works.

        Raises
        ------
        DesignError : as `is_swept`. SolidError : a sweep is asked for and fails a check.
        """

        def make() -> MeshedPart:
            if self.is_swept:
                with self.context.progress.stage(f"mesh of the {self.name}"):
                    swept = self.swept(spec)
                if swept is not None:
                    return swept
                if self._mesher == "swept":
                    raise SolidError(
                        f"the swept mesh of the {self.name} fails a check; solver.mesher"
                        ' "tetwild" or "auto" works'
                    )
                self.context.progress.note("  the swept mesh fails a check: fTetWild instead")
            surface = self._surface
            with self.context.progress.stage(f"mesh of the {self.name}"):
                return MeshedPart(mesh_surface(surface, spec), surface.sharp_edges)

        inputs = {**self.geometry_key, "spec": asdict(spec), "mesher": self._mesher}
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
        if wanted == "axisymmetric" and not self.part.is_revolved:
            raise DesignError(
                "solver.model",
                wanted,
                f"the {self.name} has bolt holes or a keyway and is no body of revolution;"
                ' "solid" or "auto" works',
            )
        return self.part.is_revolved and wanted != "solid"

    def _axisymmetric_stiffness(self) -> Stiffness:
        tolerance = self.context.design.solver.tolerance_pct / 100

        def make() -> Stiffness:
            with self.context.progress.stage(f"axisymmetric bounds of the {self.name}"):
                return torsional_stiffness(
                    self.part.meridian,
                    self.material,
                    self.part.driven,
                    tolerance,
                    Deadline(STAGE_SECONDS),
                )

        return self.context.cache.get("axisymmetric", self.revolved_key, make, is_lasting)[0]

    def twisted(self) -> TwistedPart:
        """The solid model turned by 1 rad, refined until the tolerance is met."""

        def make() -> TwistedPart:
            with self.context.progress.stage(f"torsion of the {self.name}"):
                edges: dict[MeshSpec, np.ndarray] = {}

                def mesher(spec: MeshSpec) -> TetMesh:
                    made = self.meshed(spec)
                    edges[spec] = made.sharp_edges
                    return made.mesh

                found = solid_stiffness(
                    mesher,
                    self.first_spec,
                    self.material,
                    self.part.driven,
                    self.context.design.solver.tolerance_pct / 100,
                    self.sector.label,
                    lambda text: self.context.progress.note(f"  {self.name}: {text}"),
                )
            sharp = next(iter(edges.values()))
            meshed = [MeshedPart(mesh, sharp) for mesh in found.meshes]
            times = sector_of(self.part, "ellipse").degrees / self.sector.degrees
            sizes = [len(m.mesh.cells) * times for m in meshed]
            rim = max(1, sum(size <= RIM_ELEMENTS for size in sizes)) - 1
            return TwistedPart(found.stiffness, meshed[-1], found.solved.displacement, meshed[rim])

        return self.context.cache.get(
            "torsion", self.torsion_key, make, lambda made: is_lasting(made.stiffness)
        )[0]
