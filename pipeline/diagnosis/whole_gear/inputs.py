"""The inputs of the gear's model that a drawing states least surely, and how each changes the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from flexspline.fea.gear.model import GearModel
from flexspline.geometry.design import Design
from flexspline.geometry.wave_generator import flexible_bearing
from flexspline.pipeline.gear_chain import Chain


@dataclass(frozen=True)
class GearInput:
    """A value that the gear's model takes. `first`: the first step away from the nominal value."""

    key: str
    unit: str
    nominal: float
    low: float
    high: float
    first: float
    changed: Callable[[Chain, float], Chain]


def inputs_of(design: Design, chain: Chain) -> tuple[GearInput, ...]:
    """Those that a drawing states least surely.

    Ends are wide: no clearance or a module of it, play up to nearly the whole stroke, a stroke ± 30 %, teeth
    a hundred times softer, a shaft ten times stiffer. First steps are what a maker's tolerance allows.
    """
    bearing, gear = flexible_bearing(design), design.gear
    play = design.bearing.radial_clearance_um

    def with_model(
        change: Callable[[GearModel, float], GearModel],
    ) -> Callable[[Chain, float], Chain]:
        return lambda chain, value: replace(chain, model=change(chain.model, value))

    def flanks(model: GearModel, value: float) -> GearModel:
        return model.with_gaps(replace(model.mesh, clearance=value / 1e3), model.wave_generator)

    def bearing_play(model: GearModel, value: float) -> GearModel:
        return model.with_gaps(model.mesh, replace(model.wave_generator, play=value / 1e3))

    def stroke(model: GearModel, value: float) -> GearModel:
        return model.with_gaps(model.mesh, replace(model.wave_generator, deflection=value))

    pair = chain.model.pair
    return (
        GearInput("gear.flank_clearance_um", "µm", gear.flank_clearance_um, 0.0,
              1e3 * gear.module_mm, 1.0, with_model(flanks)),
        GearInput("bearing.radial_clearance_um", "µm", play, 0.0,
              1.9e3 * bearing.deflection, 2.0, with_model(bearing_play)),
        GearInput("wave_generator.deflection_mm", "mm", bearing.deflection, 0.7 * bearing.deflection,
              1.3 * bearing.deflection, 0.01 * bearing.deflection, with_model(stroke)),
        GearInput("tooth pair compliance", "mm/N", pair, 0.0, 100 * pair, 3 * pair,
              with_model(lambda model, value: replace(model, pair=value))),
        GearInput("compliance in series", "rad/(N·m)", 0.0, -0.9 * chain.shaft, 1e3 * chain.shaft,
              0.2 * chain.shaft, lambda chain, value: replace(chain, holes=chain.holes + value)),
    )  # fmt: skip
