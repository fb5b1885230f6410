"""The whole way of a design: stiffnesses, stresses, backlash. Each command asks for a part of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from flexspline.fea.axisymmetric.stress import torsion_stress
from flexspline.fea.deadline import STAGE_SECONDS, Deadline
from flexspline.fea.solid.peak import stress_field
from flexspline.fea.toothed_ring.equivalent import EquivalentRing
from flexspline.fea.types import MeshLevel, SolidField, Stiffness, StressPeak, TetMesh
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.attempts import Attempts
from flexspline.pipeline.backlash import Backlash, backlash
from flexspline.pipeline.linear_limit import LinearLimit, linear_limit
from flexspline.pipeline.load_cases import (
    STRESS_TOLERANCE,
    half_seat_peak,
    rim_answers,
    wave_generator_field,
)
from flexspline.pipeline.parts import AnalysisContext, MeshedPart, PartModel, TwistedPart
from flexspline.pipeline.stress_limits import PEAK_OF
from flexspline.pipeline.wave_generator import sharp_edges

CACHED_TYPES: tuple[type, ...] = (
    EquivalentRing, MeshLevel, MeshedPart, SolidField, Stiffness, StressPeak,
    TetMesh, TwistedPart,
)  # fmt: skip
"""What may stand in a cache entry."""


@dataclass(frozen=True)
class Stiffnesses:
    """K_b of each load case that was solved, and K_e; None where nobody asked, or what failed.

    `ring` is the plain ring that stood for the teeth in all K_b, None where none were drawn.
    `half_seat_peak` is the wave generator's peak on a seat half as wide as the ring.
    `missing`: why a figure that was asked for is not there, by its name.
    """

    K_b: Stiffness | None
    K_e: Stiffness | None
    K_b_lobes: Stiffness | None = None
    K_b_lobes_unsupported: Stiffness | None = None
    K_b_lobes_contact: Stiffness | None = None
    wave_generator_peak: StressPeak | None = None
    ring: EquivalentRing | None = None
    missing: Mapping[str, str] = field(default_factory=dict)
    half_seat_peak: StressPeak | None = None

    def in_sum(self, design: Design) -> Stiffness:
        """The K_b that enters the backlash sum, by `solver.load_case`; raises as `shaft`."""
        return self._found("K_b_lobes" if design.solver.load_case == "lobes" else "K_b")

    @property
    def named(self) -> dict[str, Stiffness]:
        """What was solved, by the name of its figure ("K_b_lobes"), in the order of the reports."""
        every = {
            "K_b": self.K_b,
            "K_b_lobes": self.K_b_lobes,
            "K_b_lobes_contact": self.K_b_lobes_contact,
            "K_b_lobes_unsupported": self.K_b_lobes_unsupported,
            "K_e": self.K_e,
        }
        return {name: found for name, found in every.items() if found is not None}

    @property
    def flexspline(self) -> Stiffness:
        """K_b of the case "uniform"; raises as `shaft`."""
        return self._found("K_b")

    @property
    def shaft(self) -> Stiffness:
        """K_e.

        Raises
        ------
        NotFoundError : it failed, or nobody asked for it.
        """
        return self._found("K_e")

    def _found(self, name: str) -> Stiffness:
        if name not in self.named:
            raise NotFoundError(name, self.missing.get(name, "nobody asked for it"), self)
        return self.named[name]

    def has_sum(self, design: Design) -> bool:
        """Whether both K of the backlash sum are there."""
        return {"K_b_lobes" if design.solver.load_case == "lobes" else "K_b", "K_e"} <= set(
            self.named
        )

    def require(self, design: Design) -> None:
        """Both K of the sum and K_b of the case "uniform", which every answer is about; as `shaft`."""
        for name in ("K_b", "K_e"):
            self._found(name)
        self.in_sum(design)

    def series_Nm_per_rad(self, design: Design) -> float:
        """1/K = 1/K_e + 1/K_b; raises as `shaft`."""
        return 1 / (1 / self.shaft.K_Nm_per_rad + 1 / self.in_sum(design).K_Nm_per_rad)


class NotFoundError(ComputationError):
    """A figure that the answer needs failed: its `name`, and all that was `found` beside it."""

    def __init__(self, name: str, why: str, found: Stiffnesses) -> None:
        self.name, self.found = name, found
        super().__init__(f"{name} was not found: {why}")


@dataclass(frozen=True)
class RunResult:
    """Everything that `flexspline run` found.

    `fields` has "flexspline_torque", "shaft_torque" and "wave_generator", but for those that are
    `stiffnesses.missing`. `warnings` are the design's own.
    """

    design: Design
    warnings: tuple[str, ...]
    stiffnesses: Stiffnesses
    fields: Mapping[str, SolidField]
    backlash: Backlash
    linear_limit: LinearLimit
    stage_seconds: Mapping[str, float]


def stiffnesses(
    context: AnalysisContext, flexspline: bool = True, shaft: bool = True, rim: bool = True
) -> Stiffnesses:
    """All that `flexspline stiffness` answers, for the parts that are asked for.

    What fails is absent, with its reason in `missing`; the rest is there.

    Without `rim` the lobes and the wave generator are left out: the backlash sum needs them only
    where `solver.load_case` says so.

    Raises
    ------
    DesignError
    ComputationError : the plain ring of drawn teeth failed.
    """
    rim_part, shaft_part = context.part("flexspline"), context.part("shaft")
    for wanted, part in ((flexspline, rim_part), (shaft, shaft_part)):
        if wanted:
            part.refuse_settings()
    tried = Attempts()
    K_b = tried.get("K_b", rim_part.stiffness) if flexspline else None
    K_e = tried.get("K_e", shaft_part.stiffness) if shaft else None
    if not flexspline:
        return Stiffnesses(K_b, K_e, missing=tried.missing)
    if not rim:
        return Stiffnesses(K_b, K_e, ring=context.ring, missing=tried.missing)
    answers = rim_answers(rim_part, tried)
    return Stiffnesses(
        K_b,
        K_e,
        answers.K_b_lobes,
        answers.K_b_lobes_unsupported,
        answers.K_b_lobes_contact,
        answers.wave_generator_peak,
        context.ring,
        tried.missing,
        tried.get("half_seat_peak", lambda: half_seat_peak(rim_part)),
    )


def run(context: AnalysisContext) -> RunResult:
    """The main job: all stiffnesses, the three stress fields, and the backlash sum.

    A field that fails is absent, with its reason in `stiffnesses.missing`.

    Raises
    ------
    DesignError
    NotFoundError : what the backlash sum needs failed; it carries what was found.
    """
    design = context.design
    flexspline, shaft = context.part("flexspline"), context.part("shaft")
    found = stiffnesses(context)
    found.require(design)
    total = backlash_of(design, found)
    tried = Attempts()
    asked = {
        "flexspline_torque": lambda: torque_field(flexspline),
        "shaft_torque": lambda: torque_field(shaft),
        "wave_generator": lambda: wave_generator_field(flexspline),
    }
    made = {name: tried.get(name, solve) for name, solve in asked.items()}
    fields = {name: solved for name, solved in made.items() if solved is not None}
    found = replace(found, missing={**found.missing, **tried.missing})
    peaks = {PEAK_OF[name]: solved.peak for name, solved in fields.items()}
    limit = linear_limit(design, found.series_Nm_per_rad(design), peaks)
    seconds = dict(context.progress.seconds)
    return RunResult(design, warnings(design), found, fields, total, limit, seconds)


def backlash_of(design: Design, found: Stiffnesses) -> Backlash:
    """The four-term sum with the stiffnesses found."""
    return backlash(design, found.in_sum(design).K_Nm_per_rad, found.shaft.K_Nm_per_rad)


def torque_field(model: PartModel) -> SolidField:
    """Displacement and stress under the design's torque T_L; the peak from the model that answers."""
    design = model.context.design
    torque = design.load.torque_Nm
    twisted = model.twisted()
    with model.context.progress.stage(f"stress of the {model.name} under torque"):
        solved = stress_field(
            twisted.meshed.mesh,
            twisted.displacement * (torque / twisted.stiffness.upper_Nm_per_rad),
            model.material,
            f"{model.name} under T_L = {torque:g} N·m",
            sharp_edges(model, twisted.meshed),
        )
        if not model.axisymmetric:
            return solved
        exact = torsion_stress(
            model.part.meridian,
            model.material,
            model.part.driven,
            torque,
            model.part.exclusion_mm,
            STRESS_TOLERANCE,
            Deadline(STAGE_SECONDS),
        )
    return replace(solved, peak=exact.peak)
