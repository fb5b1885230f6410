"""The wave generator's flexible bearing: stated values, and assumed proportions for the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import asin, pi, sin
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from flexspline.geometry.assumed import Assumed, taken_from
from flexspline.geometry.bounds import lengths
from flexspline.geometry.errors import DesignError
from flexspline.geometry.fields import DesignTable, Length
from flexspline.geometry.play_limit import ROUNDING_SHARE
from flexspline.geometry.share_range import share_faults

if TYPE_CHECKING:
    from flexspline.geometry.design import Design

FEWEST_BALLS, MOST_BALLS = 6, 200
"""With fewer balls the rim is not an ellipse between them. Thin section bearings of one metre have about
150."""
USUAL_BALLS = 23
"""Number of balls if the design states none. Judgement: usual in flexible bearings."""
BALL_SHARE = 0.20
"""Ball diameter over the tube's inner radius: 23 such balls leave a fifth of their circle to the cage."""
RACE_SHARE = 0.04
"""Thickness of the outer race at the groove over the tube's inner radius: about 1.2 mm at 30 mm, from
drawings in papers. It is not standardised, and makers do not publish it."""
DEFLECTION_SHARES = (0.5, 1.5)
"""Range of the stroke over m(z2 − z1)/2: with less the teeth hardly meet, with more their tips touch the root
circle."""
RACE_SHARES = (0.01, 0.25)
"""Range of the race thickness over the inner radius. Balls dent a thinner race, and K then changes by more
than 2 % with twice the harmonics; a thicker race does not bend like a ring."""
SMALLEST_BALL = 0.01
"""Smallest ball diameter over the inner radius: even the largest allowed number of balls then fills only a
third of their circle."""


class WaveGenerator(DesignTable):
    """The wave generator; what is left out is taken in proportion, and named with the result."""

    deflection_mm: Length | None = Field(
        default=None, description="mm, w0, radial stroke of the plug; default m(z2 - z1)/2"
    )
    ball_count: Annotated[int, Field(ge=FEWEST_BALLS, le=MOST_BALLS)] | None = Field(
        default=None, description=f"number of balls; default {USUAL_BALLS}, or as many as fit"
    )
    ball_diameter_mm: Length | None = Field(
        default=None, description=f"mm, default {BALL_SHARE:g} of the tube's inner radius"
    )
    race_thickness_mm: Length | None = Field(
        default=None,
        description=f"mm, outer race at its groove; default {RACE_SHARE:g} of the tube's inner radius",
    )


@dataclass(frozen=True)
class FlexibleBearing:
    """The wave generator with every dimension; lengths in mm."""

    deflection: float
    ball_count: int
    ball_diameter: float
    race_thickness: float
    assumed: tuple[Assumed, ...]


def flexible_bearing(design: Design) -> FlexibleBearing:
    """What the design states, and proportions for the rest."""
    given, radius = design.wave_generator, design.flexspline.inner_radius
    assumed: list[Assumed] = []
    taken = taken_from(given, "wave_generator", assumed)
    stroke = design.gear.centre_distance_mm
    deflection = taken("deflection_mm", stroke, "m(z2 - z1)/2")
    race = taken("race_thickness_mm", RACE_SHARE * radius, f"{RACE_SHARE:g} of the inner radius")
    room = radius - race
    wanted = given.ball_count or USUAL_BALLS
    ball = taken(
        "ball_diameter_mm",
        min(BALL_SHARE * radius, largest_ball(room, wanted)),
        f"{BALL_SHARE:g} of the inner radius, or what {wanted} balls leave room for",
    )
    most = most_balls(room, ball)
    count = taken("ball_count", min(USUAL_BALLS, most), "usual, or as many as fit")
    return FlexibleBearing(deflection, int(count), ball, race, tuple(assumed))


def largest_ball(room: float, count: int) -> float:
    """Diameter [mm] of `count` balls that touch each other inside a circle of radius `room` [mm]."""
    s = sin(pi / count)
    return 2 * room * s / (1 + s)


def most_balls(room: float, diameter: float) -> int:
    """How many balls have room side by side inside a circle of radius `room` [mm]; 0 for none."""
    ratio = diameter / (2 * room - diameter) if 2 * room > diameter else 2.0
    return int(pi / asin(ratio) * (1 + ROUNDING_SHARE)) if ratio <= 1 else 0


def wave_generator_faults(design: Design) -> Iterator[DesignError]:
    """Balls that find no room, a race that does not bend, a stroke that does not mesh."""
    given, radius = design.wave_generator, design.flexspline.inner_radius
    stroke, race = design.gear.centre_distance_mm, given.race_thickness_mm
    yield from share_faults(
        "wave_generator.deflection_mm",
        given.deflection_mm,
        DEFLECTION_SHARES,
        stroke,
        f"m(z2 - z1)/2 = {stroke:.4g} mm",
    )
    race_faults = list(
        share_faults(
            "wave_generator.race_thickness_mm", race, RACE_SHARES, radius, "the tube's inner radius"
        )
    )
    yield from race_faults
    if race_faults:
        return
    room = radius - (race if race is not None else RACE_SHARE * radius)
    ball = given.ball_diameter_mm
    count = given.ball_count if given.ball_count is not None else FEWEST_BALLS
    smallest, largest = SMALLEST_BALL * radius, largest_ball(room, count)
    if ball is not None and not smallest <= ball <= largest * (1 + ROUNDING_SHARE):
        yield DesignError(
            "wave_generator.ball_diameter_mm",
            ball,
            f"must be {lengths(smallest, largest, 4)} mm: {count} balls inside a race of radius "
            f"{room:.4g} mm touch each other beyond, and {SMALLEST_BALL:g} of the tube's inner radius is "
            "the least",
        )
