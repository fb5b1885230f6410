"""Sizes that no gear has, and the messages that refuse files with them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Literal, assert_never

from flexspline.pipeline.diagnosis.structure import FarSize, FarSlope, UnitSuspect

SMALLEST = 1e-6
"""Smallest ratio that is printed as a number. A smaller one comes from a channel without a signal.
Judgement."""


@dataclass(frozen=True)
class FarTwist(FarSize):
    """The same of whole twists, with the head of the angle's column, "" where it has none."""

    head: str = ""


@dataclass(frozen=True)
class FarReading:
    """Angles of end points, or stiffnesses of specimens, over the simulated ones."""

    of: Literal["end_points", "specimens"]
    ratio: float
    suspect: UnitSuspect | None
    head: str = ""


@dataclass(frozen=True)
class FallingAngle:
    """The angle falls where torque rises."""

    of: Literal["sweep", "end_points"]


@dataclass(frozen=True)
class Still:
    """The angle never changes."""


Absurd = FarTwist | FarSlope | FarReading | FallingAngle | Still


def absurd_words(absurd: Absurd, given: Collection[str] = ()) -> str:
    """Why a file is refused, as a question.

    `given`: the stiffnesses that a person stated, such as `--Kb 31.3`. The question doubts these too, except
    if it concerns a sign or a reading that never changes.
    """
    match absurd:
        case Still():
            return "the angle is the same in all rows: was its channel connected?"
        case FallingAngle("sweep"):
            return "the angle falls where torque rises: is the sign of angle or torque reversed?"
        case FallingAngle():
            return "angle_plus lies below angle_minus: are the two columns swapped, or is the sign reversed?"
        case FarTwist():
            turned = " with its sign reversed" if absurd.ratio < 0 else ""
            twist = (
                f"{absurd.head or 'the angle'} is {times(absurd.ratio)} the simulated twist{turned}"
            )
            return twist + _asked(absurd) + given_words(given if absurd.connected else ())
        case FarSlope():
            return slope_words(absurd) + given_words(given if absurd.connected else ())
        case FarReading("end_points"):
            said = f"the angles are {times(absurd.ratio)} the simulated ones"
            return f"{said}: {_which(absurd.suspect, 'are they')}?{given_words(given)}"
        case FarReading():
            said = f"{absurd.head or 'the stiffness'} is {times(absurd.ratio)} the simulated one"
            return f"{said}: {_which(absurd.suspect, 'is it')}?{given_words(given)}"
        case _:
            assert_never(absurd)


def slope_words(slope: FarSlope) -> str:
    """Asks what may be wrong with the reading, and says how much stiffer or softer the gear would be."""
    ratio = slope.ratio
    if ratio <= 0:
        return "the angle does not follow the torque" + _asked(slope)
    stiff = f"{times(1 / ratio)} stiffer" if ratio < 1 else f"{times(ratio)} softer"
    return f"the gear would be {stiff} than simulated" + _asked(slope)


def given_words(given: Collection[str]) -> str:
    """A sentence that names the stiffnesses that a person stated; "" of none."""
    return f" Or check the stiffness given: {', '.join(given)} (N·m/rad)." if given else ""


def times(ratio: float) -> str:
    """A ratio in words: "3440 times", or "1/206 of"."""
    size = abs(ratio)
    if size >= 1:
        return f"{float(f'{size:.3g}'):g} times"
    return f"1/{float(f'{1 / size:.3g}'):g} of" if size > SMALLEST else "next to nothing of"


def _asked(far: FarSize) -> str:
    asked = ["are the columns of torque and angle interchanged"] * far.interchanged
    asked += [f"is {one.head} in {_instead(one)}" for one in far.suspects]
    if not far.connected:
        asked.append("was the channel of the angle connected")
    return ": " + (", or ".join(asked) or "are the units of angle and torque right") + "?"


def _which(suspect: UnitSuspect | None, ask: str) -> str:
    return "is the unit right" if suspect is None else f"{ask} in {_instead(suspect)}"


def _instead(suspect: UnitSuspect) -> str:
    if not suspect.other:
        return "counts of an encoder (--counts-per-turn N)"
    return f"{suspect.other}, not {suspect.unit}"
