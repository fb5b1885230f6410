"""The inputs of the gear's model that a drawing states least surely, and how each changes the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from flexspline.fea.gear.model import GearModel
from flexspline.geometry.design import Design
from flexspline.geometry.fields import MM_PER_UM
from flexspline.geometry.wave_generator import flexible_bearing
from flexspline.pipeline.gear.gear_chain import Chain

MOST_PLAY_STROKES = 1.9
"""Times the radial stroke w0: a play of 2 w0 takes the whole of it, and the gear turns freely."""
STROKE_SHARES = (0.7, 1.3)
"""Of the design's stroke: where the first steps of a search may lead; no drawing is off by so much."""
SOFTEST_PAIR = 100.0
"""Times the computed compliance of a pair of teeth."""
SOFTEST_SERIES = 1e3
"""Most added compliance over the shaft's: a joint a thousand times softer. The least is 0: no spring in
series has a negative compliance. Judgement."""
FIRST_FLANK_um, FIRST_PLAY_um, FIRST_STROKE_SHARE = 1.0, 2.0, 0.01
"""First steps: what a maker's tolerance on clearance, play and stroke allows."""
FIRST_PAIR, FIRST_SERIES = 3.0, 0.2
"""First steps, times the pair's and the shaft's compliance. Judgement: both are known less well than
lengths."""


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
    a hundred times softer, a joint that adds compliance. First steps are what a maker's tolerance allows.
    """
    bearing, gear = flexible_bearing(design), design.gear
    play, w0 = design.bearing.radial_clearance_um, bearing.deflection

    def with_model(
        change: Callable[[GearModel, float], GearModel],
    ) -> Callable[[Chain, float], Chain]:
        return lambda chain, value: replace(chain, model=change(chain.model, value))

    def flanks(model: GearModel, value: float) -> GearModel:
        return model.with_gaps(
            replace(model.mesh, clearance=value * MM_PER_UM), model.wave_generator
        )

    def bearing_play(model: GearModel, value: float) -> GearModel:
        return model.with_gaps(model.mesh, replace(model.wave_generator, play=value * MM_PER_UM))

    def stroke(model: GearModel, value: float) -> GearModel:
        return model.with_gaps(model.mesh, replace(model.wave_generator, deflection=value))

    pair = chain.model.pair
    return (
        GearInput("gear.flank_clearance_um", "µm", gear.flank_clearance_um, 0.0,
              gear.module_mm / MM_PER_UM, FIRST_FLANK_um, with_model(flanks)),
        GearInput("bearing.radial_clearance_um", "µm", play, 0.0,
              MOST_PLAY_STROKES * w0 / MM_PER_UM, FIRST_PLAY_um, with_model(bearing_play)),
        GearInput("wave_generator.deflection_mm", "mm", w0, STROKE_SHARES[0] * w0,
              STROKE_SHARES[1] * w0, FIRST_STROKE_SHARE * w0, with_model(stroke)),
        GearInput("tooth pair compliance", "mm/N", pair, 0.0, SOFTEST_PAIR * pair, FIRST_PAIR * pair,
              with_model(lambda model, value: replace(model, pair=value))),
        GearInput("compliance in series", "rad/(N·m)", 0.0, 0.0,
              SOFTEST_SERIES * chain.shaft, FIRST_SERIES * chain.shaft,
              lambda chain, value: replace(chain, holes=chain.holes + value)),
    )  # fmt: skip
