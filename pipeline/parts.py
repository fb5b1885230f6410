"""One part of a gear in the analysis: the model and mesher that its settings select, and its keys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

from flexspline.fea.address_space import refuse_little_address_space
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.sweeps import can_be_swept, goes_about_axis
from flexspline.fea.toothed_ring.equivalent import EquivalentRing
from flexspline.fea.types import Elastic, Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.part import Part
from flexspline.geometry.part_name import PartName
from flexspline.geometry.symmetry import Sector, sector_of
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.drawn_teeth import ring_of, with_plain_ring
from flexspline.pipeline.progress import Progress

LAYERED_COARSER = 2.0
"""Edges of the first mesh of a shaft that is not swept about the axis, over those of one that is. On two of
fTetWild's K was ± 0.04 and 2.42 % at 1.5 times and ± 0.05 and 2.43 % at twice, in two thirds of the processor
time of the first (48 and 33 s)."""


@dataclass(frozen=True)
class AnalysisContext:
    """The design, the cache, and the progress to report: what every stage needs."""

    design: Design
    cache: Cache
    progress: Progress

    @cached_property
    def ring(self) -> EquivalentRing | None:
        """The plain ring that stands for drawn teeth; None where none are drawn."""
        return ring_of(self.design, self.cache, self.progress)

    def part(self, name: PartName) -> PartModel:
        """Return a part's model; a flexspline's teeth enter it as the equivalent plain ring.

        Raises
        ------
        AddressSpaceError : this process can solve nothing.
        """
        refuse_little_address_space()
        if name == "shaft" or self.ring is None:
            return PartModel(self, self.design.part(name))
        plain = replace(self, design=with_plain_ring(self.design, self.ring))
        return PartModel(plain, plain.design.part(name), toothed=True)


def is_lasting(figure: Stiffness | StressPeak) -> bool:
    """Whether a figure would be the same on a machine with more time and memory."""
    return not figure.shortfall.of_the_machine


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
    def tolerance(self) -> float:
        """Wanted error of K, ±, as a fraction: `solver.tolerance_pct`.

        On a meridian the whole width of the bounds is brought below it: K is then known to ± half of it.
        """
        return self.context.design.solver.tolerance

    @property
    def sector(self) -> Sector:
        return sector_of(self.part, "torsion")

    @property
    def first_spec(self) -> MeshSpec:
        """Specification of the part's first, coarse mesh."""
        spec = first_spec(self.part, self.context.design.solver.edge_length_mm)
        if not self.states_edges and self.name == "shaft" and not goes_about_axis(self.part):
            return spec.scaled(LAYERED_COARSER)
        return spec

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
        return {
            **self.revolved_key,
            "spec": asdict(self.first_spec),
            "states_edges": self.states_edges,
            "model": self.context.design.solver.model,
            "mesher": self.mesher,
        }

    @property
    def states_edges(self) -> bool:
        """Whether the design states the edges of solid meshes: no mesh then has others to save time."""
        return self.context.design.solver.edge_length_mm is not None

    @property
    def mesher(self) -> str:
        """`solver.mesher`."""
        return self.context.design.solver.mesher

    @property
    def is_swept(self) -> bool:
        """Whether its solid meshes are swept from the meridian, by `solver.mesher`.

        Raises
        ------
        DesignError : that is asked for, and the part needs fTetWild.
        """
        able = can_be_swept(self.part)
        if self.mesher == "swept" and not able:
            raise DesignError(
                "solver.mesher",
                self.mesher,
                f"the {self.name} has bolt holes that no plain column of its meridian holds and cannot be"
                ' swept; "tetwild" or "auto" works',
            )
        return able and self.mesher != "tetwild"

    def refuse_settings(self) -> None:
        """Refuse a model or a mesher that the part does not allow, before the long work.

        Raises
        ------
        DesignError : as `axisymmetric` and `is_swept`.
        """
        _ = self.axisymmetric, self.is_swept

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
                f"the {self.name} has bolt holes or a keyway and is not a body of revolution;"
                ' "solid" or "auto" works',
            )
        return self.part.is_revolved and wanted != "solid"
