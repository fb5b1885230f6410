"""Effects in a measurement that no cause explains, as facts: a kind and its numbers.

`results/diagnosis/structure_words.py` puts them into words.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from flexspline.pipeline.diagnosis.left_out import LeftOut

FormKind = Literal[
    "smooth",
    "even_curve",
    "ripple",
    "bump",
    "curve_step",
    "softening",
    "one_sided",
    "less_bend",
    "uneven_loop",
    "leading",
    "gives_way",
    "rings",
    "wave",
    "step",
    "own_zero",
    "own_stiffness",
    "own_gap",
    "changing_zero",
    "changing_stiffness",
    "changing_gain",
    "changing_loop",
    "bent_gap",
    "jumps",
    "comes_back",
    "remainder",
    "slow_noise",
    "curve_of_totals",
    "trend",
    "bend",
    "alternating",
    "half_step",
    "one_specimen",
]
"""Forms of structure over a channel."""


@dataclass(frozen=True)
class UnnamedForm:
    """Structure over a channel.

    Attributes
    ----------
    number : of the unit or specimen that alone has it, from 1; 0: of none. name : that unit's, where the file
        names it. at_Nm : torque near which it is, of what is in one place; of a bend of one side, from which
        on, with that side's sign. period_s : of ringing. more_arcsec : of such a bend, the twist that it adds
        at the largest torque; less than 0 where the gear is stiffer on that side.
    """

    kind: FormKind
    number: int = 0
    name: str = ""
    at_Nm: float | None = None
    period_s: float | None = None
    more_arcsec: float | None = None


@dataclass(frozen=True)
class Trace:
    """An effect like that of a cause, by its id, that is too small to be named."""

    cause: str


@dataclass(frozen=True)
class Slip:
    """`slip_arcsec` that the output goes on in a load, and how many `times` what it springs there."""

    slip_arcsec: float
    times: float


@dataclass(frozen=True, order=True)
class UnitSuspect:
    """A column's head, and the `other` unit in which its readings would be right, in place of its own.

    Both units are "" where the readings may be counts of an encoder.
    """

    head: str
    other: str = ""
    unit: str = ""


@dataclass(frozen=True)
class FarSize:
    """Measured over simulated, far from 1, and what may be wrong with the reading, the likeliest first.

    `connected` : whether the angle moves enough for its channel to be connected. `interchanged` : whether
    torque and angle, each taken for the other, have the simulated size.
    """

    ratio: float
    suspects: tuple[UnitSuspect, ...]
    connected: bool
    interchanged: bool = False


@dataclass(frozen=True)
class FarSlope(FarSize):
    """The same of compliances."""


@dataclass(frozen=True)
class NegativeGap:
    """The gap that the best explanation needs, with its standard deviation [arcsec]."""

    gap_arcsec: float
    std_arcsec: float


@dataclass(frozen=True)
class MissedLevel:
    """Errors [arcsec rms] at a level held out, with what was learnt on the other rows and without it."""

    held_out: LeftOut
    with_causes_arcsec: float
    without_arcsec: float


@dataclass(frozen=True)
class BackwardLoop:
    """Loops run backwards: by how much the angle is lower while torque falls, in the mean [arcsec].

    Attributes
    ----------
    loops : so many. rate_Nm_per_s : of the quickest, where only those do; else None.
    delay_s : by which a late torque reading explains how loops differ with their rate, with its standard
        deviation; None where the rates do not differ, or where that does not explain it. grows : whether
        the loops do with the rate; None where rates do not differ. unrecorded : channels that are missing,
        which would show what else may look like it.
    """

    width_arcsec: float
    loops: int
    rate_Nm_per_s: float | None
    delay_s: tuple[float, float] | None
    grows: bool | None
    unrecorded: tuple[str, ...] = ()

    @property
    def rms_arcsec(self) -> float:
        """Of the angle, off the middle of the loop."""
        return self.width_arcsec / 2


@dataclass(frozen=True)
class LateAngle:
    """How the angle is late, with the time and its standard deviation.

    Attributes
    ----------
    kind : of `sweep/rig_faults/crossing_forms.py`. rms_arcsec : of what the record's step of the gap is
        off a sharp one at zero torque.
    """

    kind: str
    time_s: float
    std_s: float
    rms_arcsec: float


@dataclass(frozen=True)
class DraggedCrossing:
    """The friction torque against which a gap is crossed beside drag, with its standard deviation [N·m].

    `rms_arcsec` : of what the record's step of the gap is off a sharp one behind that friction.
    """

    friction_Nm: float
    std_Nm: float
    rms_arcsec: float


BrokenLimit = (
    Slip | FarSlope | NegativeGap | MissedLevel | BackwardLoop | LateAngle | DraggedCrossing
)
"""Findings that no gear can cause, or that no explanation may contain."""
Structure = tuple[UnnamedForm, ...] | Trace | BrokenLimit
"""Several forms at once are of one channel."""
