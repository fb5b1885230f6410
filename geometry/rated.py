"""Rated torque if a design states none: in proportion to the pitch radius cubed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from flexspline.geometry.assumed import Assumed
from flexspline.geometry.bounds import span
from flexspline.geometry.errors import DesignError
from flexspline.geometry.percent import percent

if TYPE_CHECKING:
    from flexspline.geometry.design import Design

RATED_Nm_per_mm3 = 2.9e-3
"""The median of sizes 14, 17, 20 and 25 at ratio 100, which have 1.8, 3.1, 3.2 and 2.7 (10, 31, 52 and 87 N·m
at 17.78, 21.59, 25.40 and 31.75 mm; Schaeffler TPI 275, examples/catalogue/)."""
RATED_WHY = (
    f"{RATED_Nm_per_mm3:g} N·m/mm³ of the pitch radius cubed, the median of four catalogue sizes at "
    "ratio 100"
)
SOFTEST_STEEL_GPa = 190.0
"""Lower limit of Young's modulus of the steels in those gears. For a softer flexspline (titanium, aluminium,
plastic) the rated torque is reduced in proportion to E, so that it deforms equally: with a catalogue's torque
a plastic gear would turn by six teeth."""
STRONGEST_Nm_per_mm3 = 3.2e-3
"""The largest of these four: size 20."""
UNUSUAL = 3.0
"""Factor above the strongest of them that is taken for a slip: the four differ by a factor of 1.8, a wrong
unit gives ten or more."""
LOST_MOTION_SHARE = 0.04
"""Share of rated torque, in each direction, at which lost motion is measured (GB/T 35089-2018; Hrcek et al.,
Materials 14 (2021) 5057)."""
LOST_MOTION_TORQUE = f"{percent(LOST_MOTION_SHARE)} of rated torque"
"""The same, in words."""
RATED_SHARES = (1e-3, 1e2)
"""Allowed range over that proportion: plastic gears carry a hundredth. Below the range rounding shows in the
forces; above it no gear carries the load."""


def rated_in_proportion(pitch_radius_mm: float) -> float:
    """[N·m] of a pitch radius."""
    return RATED_Nm_per_mm3 * pitch_radius_mm**3


def _share_of_steel(design: Design) -> float:
    """Torque of the flexspline's material over that of steel, at the same shape under load."""
    return min(1.0, design.material.flexspline.youngs_modulus_GPa / SOFTEST_STEEL_GPa)


def rated_warnings(design: Design) -> Iterator[str]:
    """A rated torque that no catalogue gear of that pitch diameter has."""
    stated, radius = design.gear.rated_torque_Nm, design.gear.pitch_radius_mm
    most = _share_of_steel(design) * STRONGEST_Nm_per_mm3 * radius**3
    if stated is not None and stated > UNUSUAL * most:
        yield (
            f"gear.rated_torque_Nm = {stated:g} is {stated / most:.3g} times what the strongest catalogue "
            f"gear of {2 * radius:.3g} mm pitch diameter and this material would carry, some {most:.3g} N·m "
            "(Schaeffler TPI 275, ratio 100)"
        )


def rated_torque(design: Design) -> tuple[float, tuple[Assumed, ...]]:
    """T_N [N·m], and the assumption where the design states none."""
    stated = design.gear.rated_torque_Nm
    if stated is not None:
        return stated, ()
    value, why = rated_in_proportion(design.gear.pitch_radius_mm), RATED_WHY
    softness = _share_of_steel(design)
    if softness < 1:
        value *= softness
        why += f", which are of steel; times {softness:.3g}, E over {SOFTEST_STEEL_GPa:g} GPa"
    return value, (Assumed("gear.rated_torque_Nm", value, why),)


def rated_faults(design: Design) -> Iterator[DesignError]:
    """A rated torque that no gear of that size can have: a slip of the unit."""
    stated = design.gear.rated_torque_Nm
    usual = rated_in_proportion(design.gear.pitch_radius_mm)
    low, high = (share * usual for share in RATED_SHARES)
    if stated is not None and not low <= stated <= high:
        yield DesignError(
            "gear.rated_torque_Nm",
            stated,
            f"must be {span(low, high, 4)} N·m: a gear of this pitch radius has some {usual:.3g}",
        )
