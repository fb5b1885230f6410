"""The whole way of a design: stiffnesses, stresses, backlash. Each command asks for a part of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fea.axisymmetric.stress import torsion_stress
from fea.solid.peak import stress_field
from fea.toothed_ring.equivalent import EquivalentRing
from fea.types import MeshLevel, SolidField, Stiffness, StressPeak, TetMesh
from geometry.design import Design
from geometry.meridian import meridian
from geometry.sanity import warnings
from pipeline.backlash import Backlash, backlash
from pipeline.parts import DRIVEN, MeshedPart, PartModel, TwistedPart, Workshop
from pipeline.rim import (
    STRESS_TOLERANCE,
    RimAnswers,
    SolidLobes,
    rim_answers,
    wave_generator_field,
)
from pipeline.rim_stress import sharp_edges

CACHED_TYPES: tuple[type, ...] = (
    EquivalentRing, MeshLevel, MeshedPart, RimAnswers, SolidField, SolidLobes, Stiffness, StressPeak,
    TetMesh, TwistedPart,
)  # fmt: skip
"""What may stand in a cache entry."""


@dataclass(frozen=True)
class Stiffnesses:
    """K_b of each load case that was solved, and K_e; None where nobody asked.

    `ring` is the plain ring that stood for the teeth in all K_b, None where none were drawn.
    """

    K_b: Stiffness | None
    K_e: Stiffness | None
    K_b_lobes: Stiffness | None = None
    K_b_lobes_unsupported: Stiffness | None = None
    K_b_lobes_contact: Stiffness | None = None
    wave_generator_peak: StressPeak | None = None
    ring: EquivalentRing | None = None

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


def stiffnesses(
    shop: Workshop, flexspline: bool = True, shaft: bool = True, rim: bool = True
) -> Stiffnesses:
    """All that `flexspline stiffness` answers, for the parts that are asked for.

    Without `rim` the lobes and the wave generator are left out: the backlash sum needs them only
    where `solver.load_case` says so.

    Raises
    ------
    DesignError, ComputationError
    """
    rim_part, shaft_part = shop.part("flexspline"), shop.part("shaft")
    for wanted, part in ((flexspline, rim_part), (shaft, shaft_part)):
        _ = wanted and part.axisymmetric  # refuse before the long work
    K_b = rim_part.stiffness() if flexspline else None
    K_e = shaft_part.stiffness() if shaft else None
    if not flexspline:
        return Stiffnesses(K_b, K_e)
    if not rim:
        return Stiffnesses(K_b, K_e, ring=shop.ring)
    answers = rim_answers(rim_part)
    return Stiffnesses(
        K_b,
        K_e,
        answers.K_b_lobes,
        answers.K_b_lobes_unsupported,
        answers.K_b_lobes_contact,
        answers.wave_generator_peak,
        shop.ring,
    )


def run(shop: Workshop) -> RunResult:
    """The main job: all stiffnesses, the three stress fields, and the backlash sum."""
    design = shop.design
    flexspline, shaft = shop.part("flexspline"), shop.part("shaft")
    found = stiffnesses(shop)
    fields = {
        "flexspline_torque": torque_field(flexspline),
        "shaft_torque": torque_field(shaft),
        "wave_generator": wave_generator_field(flexspline),
    }
    total = backlash_of(design, found)
    return RunResult(design, warnings(design), found, fields, total, dict(shop.progress.seconds))


def backlash_of(design: Design, found: Stiffnesses) -> Backlash:
    """The four-term sum with the stiffnesses found."""
    return backlash(design, found.in_sum(design).K_Nm_per_rad, found.shaft.K_Nm_per_rad)


def torque_field(part: PartModel) -> SolidField:
    """Displacement and stress under the design's torque T_L; the peak from the model that answers."""
    design = part.shop.design
    torque = design.load.torque_Nm
    twisted = part.twisted()
    with part.shop.progress.stage(f"stress of the {part.name} under torque"):
        field = stress_field(
            twisted.meshed.mesh,
            twisted.displacement * (torque / twisted.stiffness.upper_Nm_per_rad),
            part.material,
            f"{part.name} under T_L = {torque:g} N·m",
            sharp_edges(part, twisted.meshed),
        )
        if not part.axisymmetric:
            return field
        exact = torsion_stress(
            meridian(design, part.name),
            part.material,
            DRIVEN[part.name],
            torque,
            design.flexspline.wall_thickness_mm,
            STRESS_TOLERANCE,
        )
    return replace(field, peak=exact.peak)
