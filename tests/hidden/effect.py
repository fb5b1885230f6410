"""A hidden effect: what it adds to the angle, and its size as docs/contract.md defines it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hidden.gear import Gear, Rig
from hidden.program import Program

LEVELS = ("slight", "clear", "strong")


class CannotShowError(ValueError):
    """The programme drawn cannot show this effect: another one is drawn."""


@dataclass(frozen=True)
class Hidden:
    """Attributes.

    cause : id of docs/contract.md, or ``foreign:…``.
    magnitude : in the unit of docs/contract.md; nan for what is in no vocabulary.
    law : one line on the law and its parameters.
    angle : arcsec added on the program's grid. reading_Nm : added to the torque reading.
    crosses : whether `angle` says itself where the gap is crossed, at once.
    teeth : torque [N·m] that reaches the teeth, where the effect lies ahead of them: others act on that.
    """

    cause: str
    magnitude: float
    law: str
    angle: Callable[[Program, Gear], np.ndarray]
    reading_Nm: float = 0.0
    crosses: bool = False
    teeth: Callable[[Program, Gear], np.ndarray] | None = None


@dataclass(frozen=True)
class Setting:
    """What a law may look at when it is drawn."""

    rig: Rig
    gear: Gear
    program: Program
    level: int

    @property
    def windup(self) -> float:
        """Elastic twist at the largest torque, one way [arcsec]."""
        return self.gear.compliance * self.program.peak

    def size(self, slight: float, clear: float, strong: float, rng: np.random.Generator) -> float:
        """The level's value within a factor of 1.35 either way."""
        return (slight, clear, strong)[self.level] * float(np.exp(rng.uniform(-0.3, 0.3)))


def nothing(program: Program, gear: Gear) -> np.ndarray:
    return np.zeros_like(program.time)
