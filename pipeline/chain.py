"""The whole way of a design: stiffnesses, stresses, backlash. Each command asks for a part of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fea.solid.cases import Model, ellipse
from fea.solid.lobes import lobe_stiffness
from fea.solid.peak import SharpEdges, stress_field
from fea.solid.unfold import unfolded
from fea.types import MeshLevel, SolidField, Stiffness, StressPeak, TetMesh
from geometry.design import Design
from geometry.sanity import warnings
from geometry.symmetry import sector_of
from pipeline.backlash import Backlash, backlash
from pipeline.parts import MeshedPart, PartModel, TwistedPart, Workshop


@dataclass(frozen=True)
class RimLoads:
    """What the wave generator and the lobes do to the flexspline's rim, on one model."""

    wave_generator: SolidField
    K_b_lobes: Stiffness
    K_b_lobes_unsupported: Stiffness


CACHED_TYPES: tuple[type, ...] = (
    MeshLevel, MeshedPart, RimLoads, SolidField, Stiffness, StressPeak, TetMesh, TwistedPart,
)  # fmt: skip
"""What may stand in a cache entry."""


@dataclass(frozen=True)
class Stiffnesses:
    """K_b of each load case that was solved, and K_e; None where nobody asked."""

    K_b: Stiffness | None
    K_e: Stiffness | None
    K_b_lobes: Stiffness | None = None
    K_b_lobes_unsupported: Stiffness | None = None

    def in_sum(self, design: Design) -> Stiffness:
        """The K_b that enters the backlash sum, by `solver.load_case`."""
        chosen = self.K_b_lobes if design.solver.load_case == "lobes" else self.K_b
        if chosen is None:
            raise LookupError("K_b was not solved")
        return chosen

    @property
    def flexspline(self) -> Stiffness:
        """K_b of the case "uniform", which somebody must have asked for."""
        if self.K_b is None:
            raise LookupError("K_b was not solved")
        return self.K_b

    @property
    def shaft(self) -> Stiffness:
        """K_e, which somebody must have asked for."""
        if self.K_e is None:
            raise LookupError("K_e was not solved")
        return self.K_e

    def series_Nm_per_rad(self, design: Design) -> float:
        """1/K = 1/K_e + 1/K_b."""
        return 1 / (1 / self.shaft.K_Nm_per_rad + 1 / self.in_sum(design).K_Nm_per_rad)


@dataclass(frozen=True)
class RunResult:
    """Everything that `flexspline run` found.

    `fields` has "flexspline_torque", "shaft_torque" and "wave_generator".
    """

    design: Design
    warnings: tuple[str, ...]
    stiffnesses: Stiffnesses
    fields: Mapping[str, SolidField]
    backlash: Backlash
    stage_seconds: Mapping[str, float]


def stiffnesses(shop: Workshop, flexspline: bool = True, shaft: bool = True) -> Stiffnesses:
    """K_b and K_e, those that are asked for, and the lobes' K_b where the design sums with it.

    Raises
    ------
    DesignError, GeometryError, SolidError
    """
    rim_part, shaft_part = shop.part("flexspline"), shop.part("shaft")
    for wanted, part in ((flexspline, rim_part), (shaft, shaft_part)):
        _ = wanted and part.axisymmetric  # refuse before the long work
    K_b = rim_part.stiffness() if flexspline else None
    K_e = shaft_part.stiffness() if shaft else None
    if not flexspline or shop.design.solver.load_case == "uniform":
        return Stiffnesses(K_b, K_e)
    rim = rim_loads(shop, rim_part)
    return Stiffnesses(K_b, K_e, rim.K_b_lobes, rim.K_b_lobes_unsupported)


def run(shop: Workshop) -> RunResult:
    """The main job: all stiffnesses, the three stress fields, and the backlash sum."""
    design = shop.design
    flexspline, shaft = shop.part("flexspline"), shop.part("shaft")
    _ = flexspline.axisymmetric, shaft.axisymmetric
    rim = rim_loads(shop, flexspline)
    found = Stiffnesses(
        flexspline.stiffness(), shaft.stiffness(), rim.K_b_lobes, rim.K_b_lobes_unsupported
    )
    with shop.progress.stage("stress under torque"):
        fields = {
            "flexspline_torque": torque_field(flexspline),
            "shaft_torque": torque_field(shaft),
            "wave_generator": rim.wave_generator,
        }
    total = backlash_of(design, found)
    return RunResult(design, warnings(design), found, fields, total, dict(shop.progress.seconds))


def backlash_of(design: Design, found: Stiffnesses) -> Backlash:
    """The four-term sum with the stiffnesses found."""
    return backlash(design, found.in_sum(design).K_Nm_per_rad, found.shaft.K_Nm_per_rad)


def torque_field(part: PartModel) -> SolidField:
    """Displacement and stress under the design's torque T_L."""
    twisted = part.twisted()
    angle = part.shop.design.load.torque_Nm / twisted.stiffness.upper_Nm_per_rad
    return stress_field(
        twisted.meshed.mesh,
        twisted.displacement * angle,
        part.material,
        f"{part.name} under T_L = {part.shop.design.load.torque_Nm:g} N·m",
        _edges(part, twisted.meshed),
    )


def wave_generator_amplitude(design: Design) -> float:
    """w0 = m(z2 − z1)/2 [mm] (contract)."""
    gear = design.gear
    return gear.module_mm * (gear.teeth_circular_spline - gear.teeth_flexspline) / 2


def rim_loads(shop: Workshop, flexspline: PartModel) -> RimLoads:
    """The ellipse's stress and the lobes' K_b, on the torsion mesh reflected to a larger sector."""
    w0 = wave_generator_amplitude(shop.design)

    def make() -> RimLoads:
        twisted = flexspline.twisted()
        sector = sector_of(shop.design, "flexspline", "ellipse")
        with shop.progress.stage("wave generator and lobes"):
            model = Model.of(unfolded(twisted.meshed.mesh, sector.degrees), flexspline.material)
            shop.progress.note(f"  {len(model.mesh.cells)} elements, {sector.label} of the part")
            field = stress_field(
                model.mesh,
                ellipse(model, w0).displacement,
                flexspline.material,
                f"wave generator, w0 = {w0:g} mm",
                _edges(flexspline, twisted.meshed),
            )
            scale = twisted.stiffness.error_scale
            return RimLoads(
                field,
                lobe_stiffness(model, True, scale, sector.label),
                lobe_stiffness(model, False, scale, sector.label),
            )

    inputs: dict[str, Any] = {**flexspline.torsion_key, "w0_mm": w0}
    return shop.cache.get("rim", inputs, make)[0]


def _edges(part: PartModel, meshed: MeshedPart) -> SharpEdges:
    wall = part.shop.design.flexspline.wall_thickness_mm
    return SharpEdges(meshed.sharp_edges, meshed.mesh.sector_deg, wall)
