"""Why a measurement allows no verdict, as facts; `results/diagnosis/shortage_words.py` puts them into
words."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ConstantTorque:
    """Neither stiffness nor gap can be determined."""


@dataclass(frozen=True)
class FewTorques:
    """Fewer different torques than are `wanted`."""

    wanted: int


@dataclass(frozen=True)
class FewRows:
    """Rows outside the gap's crossing and the torque's turns: `count` of those `wanted`."""

    count: int
    wanted: int


@dataclass(frozen=True)
class FewSpecimens:
    """`count` of those `wanted`."""

    count: int
    wanted: int


@dataclass(frozen=True)
class Drowned:
    """The noise of one reading exceeds the whole simulated twist [arcsec]."""

    noise_arcsec: float
    twist_arcsec: float


@dataclass(frozen=True)
class Leaps:
    """How many, the smallest and largest, the torques between which they come, the usual move."""

    count: int
    sizes_arcsec: tuple[float, float]
    torques_Nm: tuple[float, float]
    usual_arcsec: float


@dataclass(frozen=True)
class LeapingAngle:
    """An angle that leaps by more than the simulated twist [arcsec]."""

    leaps: Leaps
    twist_arcsec: float


Shortage = ConstantTorque | FewTorques | FewRows | FewSpecimens | Drowned | LeapingAngle
