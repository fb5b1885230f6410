"""Peak stresses compared with material limits: valid comparisons, and limits that are exceeded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, Protocol, get_args

from flexspline.geometry.design import Design
from flexspline.geometry.material import Material
from flexspline.geometry.part_name import PartName

HIGHEST_STRENGTH_MPA = 2000.0
"""Spring wire, maraging steel and metallic glass yield at about this; nothing that a flexspline is made of is
linear elastic beyond."""
ON_ELLIPSE = "wave_generator_peak"
"""The peak that no torque makes, as result.json names it."""
ON_HALF_SEAT = f"{ON_ELLIPSE}_half_seat"
"""The same on a seat half as wide as the ring: seldom at the excluded border."""
PART_OF: Mapping[str, PartName] = {
    ON_ELLIPSE: "flexspline",
    "torque_peak": "flexspline",
    "shaft_torque_peak": "shaft",
}
"""The part that bears a peak, by the peak's name in result.json."""
StressCase = Literal["flexspline_torque", "shaft_torque", "wave_generator"]
"""The flexspline or the shaft under the load torque, or the flexspline on the wave generator's ellipse."""
STRESS_CASES: tuple[StressCase, ...] = get_args(StressCase)
PEAK_OF: Mapping[str, str] = {
    "flexspline_torque": "torque_peak",
    "shaft_torque": "shaft_torque_peak",
    "wave_generator": ON_ELLIPSE,
}
"""result.json's name of the peak of a case."""


class Peak(Protocol):
    """What a limit needs of a peak: a `StressPeak`, or a row of a study (`TabledPeak`)."""

    @property
    def mises_MPa(self) -> float: ...
    @property
    def at_excluded_border(self) -> bool: ...
    @property
    def exclusion_mm(self) -> float | None: ...


@dataclass(frozen=True)
class TabledPeak:
    """A peak [MPa] of which a table keeps no place and no distance."""

    mises_MPa: float
    at_excluded_border: bool
    exclusion_mm: float | None = None


@dataclass(frozen=True)
class PassedLimit:
    """A limit [MPa] that a peak passes; `key`: where the design states it, "" for HIGHEST_STRENGTH_MPA.

    `results/limit_words.py` says it.
    """

    name: str
    peak: Peak
    limit_MPa: float
    key: str = ""


def share_of_limit(peak: Peak, material: Material) -> float | None:
    """Return peak over stated fatigue limit; None without one, or where the stress rule decides the peak."""
    if material.fatigue_limit_MPa is None or peak.at_excluded_border:
        return None
    return peak.mises_MPa / material.fatigue_limit_MPa


def stated_limit(design: Design, name: str) -> tuple[float, str] | None:
    """Return the fatigue limit [MPa] of the part that bears a peak, and the key that states it, if any."""
    limit = design.part(PART_OF[name]).material.fatigue_limit_MPa
    part = "shaft" if name == "shaft_torque_peak" and design.material.shaft else "flexspline"
    return None if limit is None else (limit, f"material.{part}.fatigue_limit_MPa")


def is_compared(name: str, peak: Peak) -> bool:
    """Whether a limit is compared with a peak, by its name in result.json.

    On the wave generator a peak at the excluded border counts too: there the stress is at least so large,
    so a limit that it passes is passed, while one that it keeps need not be kept. Under torque such a peak
    comes from a clamped or bolted face that yields in truth, and passes nothing.
    """
    return name == ON_ELLIPSE or not peak.at_excluded_border


def limits_passed(design: Design, peaks: Mapping[str, Peak]) -> Iterator[PassedLimit]:
    """Return the limits that `peaks`, by their names in result.json, pass."""
    for name, peak in peaks.items():
        if not is_compared(name, peak):
            continue
        stated = stated_limit(design, name)
        if stated is not None and peak.mises_MPa > stated[0]:
            yield PassedLimit(name, peak, *stated)
        if peak.mises_MPa > HIGHEST_STRENGTH_MPA:
            yield PassedLimit(name, peak, HIGHEST_STRENGTH_MPA)
