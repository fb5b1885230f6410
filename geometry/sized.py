"""A first design for a catalogue size and ratio: the default design of its kind, scaled.

Makers keep inner dimensions to themselves. Sizes are the pitch diameter in tenths of an inch (size
25 has a pitch radius of 31.75 mm at all ratios, size 14 17.78; as in Schaeffler's TPI 275), and the
ratio with the circular spline held is z1/(z2 − z1). The wall follows from a catalogue's buckling torques.
Everything else is the kind's first design, scaled by the pitch radius.
"""

from __future__ import annotations

import tomllib
from typing import Any

from flexspline.geometry.basic_rack import DEDENDUM
from flexspline.geometry.bounds import span
from flexspline.geometry.circular_spline import circular_spline
from flexspline.geometry.errors import DesignError
from flexspline.geometry.first_values import first_values
from flexspline.geometry.load import design_from
from flexspline.geometry.percent import percent
from flexspline.geometry.ranges import Range
from flexspline.geometry.rated import (
    LOST_MOTION_SHARE,
    RATED_SHARES,
    RATED_WHY,
    rated_in_proportion,
)
from flexspline.geometry.schema import Location
from flexspline.geometry.shapes import SHAPES
from flexspline.geometry.template import text_of
from flexspline.geometry.toml_text import TomlTable
from flexspline.geometry.wave_generator import flexible_bearing

PITCH_RADIUS_PER_SIZE_mm = 1.27
"""Pitch radius per unit of size: half of a tenth of an inch."""
SIZES = Range(3, 200)
"""Catalogues list sizes 3 to 100; the largest gear ever built has twice that."""
RATIOS = Range(30, 320)
"""As in catalogues. With fewer teeth the rim must bend too far; with more, the module is too small to
make."""
WALL_SHARE = 0.0123
"""Wall thickness over pitch radius. The tube then buckles at the torque that a catalogue gives: its 15 sizes
need 0.0117 to 0.0127, equally at all ratios (docs/whole-gear.md)."""
LENGTH_DIGITS = 4
"""Significant digits of a length: finer than any tolerance of ISO 2768-f."""

RATED: Location = ("gear", "rated_torque_Nm")

Why = dict[Location, str]


def sized_template(kind: str, size: float, ratio: int, rated_Nm: float | None = None) -> str:
    """Text of a design that loads as it stands; every assumed value says where it comes from.

    `rated_Nm`: rated torque [N·m] of a catalogue; without it in proportion.

    Raises
    ------
    DesignError : no such kind, size or ratio; a rated torque that no gear of that size has.
    """
    values, why = sized_values(kind, size, ratio, rated_Nm)
    first = SHAPES[kind].first
    title = (
        f"# A strain wave gear with a {kind}, size {size:g}, ratio {ratio}.\n"
        "# Catalogues do not give inner dimensions: "
        f'what is marked "assumed" is a proportion of {first.named}, or says its source.'
    )
    if ratio < (least := first.overstressed_below):
        title += (
            f"\n# Below a ratio of {least} the wave generator stresses these proportions above the fatigue "
            f"limit (`flexspline run`).\n# {first.lowers_stress}; makers' dimensions are not published."
        )
    stated = frozenset() if rated_Nm is None else frozenset({RATED})
    return text_of(title, values, kind, why, stated)


def sized_values(
    kind: str, size: float, ratio: int, rated_Nm: float | None = None
) -> tuple[TomlTable, Why]:
    """The design file's tables, and where each assumed value comes from; errors as `sized_template`."""
    for option, value, allowed in (("--size", size, SIZES), ("--ratio", ratio, RATIOS)):
        if value not in allowed:
            raise DesignError(option, value, f"must be {allowed}")
    first = first_values(kind)
    gear = first["gear"]
    was, pitch = gear["module_mm"] * gear["teeth_flexspline"] / 2, PITCH_RADIUS_PER_SIZE_mm * size
    why: Why = {}
    values = _scaled(first, (), pitch / was, was, why)
    flexspline, gear = values["flexspline"], values["gear"]
    module = _rounded(pitch / ratio)
    values["name"] = f"{kind} of size {size:g}, ratio {ratio}"
    gear |= {
        "module_mm": module,
        "teeth_flexspline": 2 * ratio,
        "teeth_circular_spline": 2 * ratio + 2,
    }
    why[("gear", "module_mm")] = f"pitch radius {pitch:g} mm over the ratio, two lobes"
    inner = 2 * (module * (ratio - DEDENDUM) - flexspline["ring_thickness_mm"])
    flexspline["inner_diameter_mm"] = _rounded(inner, LENGTH_DIGITS + 1)
    why[("flexspline", "inner_diameter_mm")] = f"root m(z1/2 - {DEDENDUM:g}) less the ring"
    _thin_walled(flexspline, first["flexspline"], pitch, why)
    part = module / first["gear"]["module_mm"]
    for table, key in (("gear", "flank_clearance_um"), ("bearing", "radial_clearance_um")):
        values[table][key] = _rounded(first[table][key] * part)
        values["uncertainty"][key] = _rounded(first["uncertainty"][key] * part)
        for place in (table, "uncertainty"):
            why[(place, key)] = (
                f"{first[place][key] / first['gear']['module_mm'] / 1e3:.3g} modules"
            )
    usual = rated_in_proportion(pitch)
    # as the design file's check takes it, from a rounded module
    low, high = (share * rated_in_proportion(module * ratio) for share in RATED_SHARES)
    if rated_Nm is None:
        rated = usual
        gear["rated_torque_Nm"] = _rounded(rated, 3)
        why[RATED] = RATED_WHY
    elif low <= rated_Nm <= high:
        gear["rated_torque_Nm"] = rated = rated_Nm
    else:
        reason = f"must be {span(low, high, 4)} N·m: a gear of this size has some {usual:.3g}"
        raise DesignError("--rated", rated_Nm, reason)
    values["load"]["torque_Nm"] = _rounded(LOST_MOTION_SHARE * rated, 3)
    why[("load", "torque_Nm")] = (
        f"{percent(LOST_MOTION_SHARE)} of rated torque, where makers measure lost motion"
    )
    whole = design_from(tomllib.loads(text_of("", values, kind, {})))
    for assumed in (*circular_spline(whole).assumed, *flexible_bearing(whole).assumed):
        table, key = assumed.key.split(".")
        count = key == "ball_count"
        values[table][key] = int(assumed.value) if count else _rounded(assumed.value)
        why[(table, key)] = assumed.why
    return values, why


def _thin_walled(flexspline: TomlTable, first: TomlTable, pitch: float, why: Why) -> None:
    """The tube's wall of a catalogue, and a diaphragm in proportion to it."""
    wall = WALL_SHARE * pitch
    walls = first["diaphragm_thickness_mm"] / first["wall_thickness_mm"]
    flexspline["wall_thickness_mm"] = _rounded(wall)
    flexspline["diaphragm_thickness_mm"] = _rounded(walls * wall)
    why[("flexspline", "wall_thickness_mm")] = (
        f"{WALL_SHARE:g} of the pitch radius, from buckling torques of a catalogue"
    )
    why[("flexspline", "diaphragm_thickness_mm")] = f"{walls:g} walls"


def _scaled(table: TomlTable, location: Location, factor: float, was: float, why: Why) -> Any:
    """Lengths times a factor, all else as it is; `was`: the pitch radius that they belong to [mm]."""
    if isinstance(table, list):
        return [_scaled(entry, (*location, i), factor, was, why) for i, entry in enumerate(table)]
    if not isinstance(table, dict):
        key = str(location[-1])
        if not key.endswith("_mm") or key == "edge_length_mm" or not table:
            return table
        why[location] = f"{table / was:.3g} of the pitch radius"
        return _rounded(table * factor)
    return {key: _scaled(value, (*location, key), factor, was, why) for key, value in table.items()}


def _rounded(value: float, digits: int = LENGTH_DIGITS) -> float:
    return float(f"{value:.{digits}g}")
