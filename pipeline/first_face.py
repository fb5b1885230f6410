"""How much too large K_e of a shaft under a hat is: its whole first face is held, the flange touches less.

K_e is defined so (docs/contract.md). A second body of revolution, held only where the hat's flange touches,
says what that does; both leave holes and keyway out.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.material import Material
from flexspline.geometry.meridian import with_mount_from
from flexspline.geometry.outline import Meridian, SAME_mm
from flexspline.geometry.part import Part
from flexspline.geometry.percent import percent

ESTIMATE_WIDTH = 0.02
"""Of both bodies' bounds of K: 0.1 s each; K itself is within 0.1 % of that of bounds ten times closer."""
SPLIT_MM = 0.5
"""Of the first segment: so much of it is hollowed, to leave the face under the flange alone."""
ANY = Material(name="any", youngs_modulus_GPa=1.0, poissons_ratio=0.3)
"""Both K are proportional to the shear modulus, so their ratio has none."""
KEPT = 64
"""Shafts whose excess is remembered."""


def held_beyond_flange(design: Design) -> bool:
    """Whether K_e's shaft is held where the hat's flange does not touch it."""
    f = design.flexspline
    face = design.shaft.segment[0]
    return not f.inward and face.inner_diameter_mm < f.size(f.land.inner) - SAME_mm


def excess(design: Design) -> float | None:
    """By which share K_e is larger than of the shaft held under the flange alone.

    None where the flange does not touch the first face, or no mesh gives it.
    """
    inner = design.flexspline.size(design.flexspline.land.inner)
    if inner >= design.shaft.segment[0].outer_diameter_mm - SAME_mm:
        return None
    shaft = replace(design.part("shaft").without_holes(), material=ANY)
    try:
        return _excess(shaft, inner / 2)
    except ComputationError:
        return None


def why_too_large(design: Design, estimate: bool = True) -> str:
    """In words, after "K_e is"; `estimate`: with the figure, which takes up to 0.3 s."""
    share = excess(design) if estimate else None
    by = "" if share is None else f" by about {percent(share)}"
    return f"too large{by}: held on its whole first face, not only under the hat's flange"


def too_large_line(design: Design, estimate: bool = True) -> str:
    """The warning, with its remedy."""
    f, first = design.flexspline, design.shaft.segment[0]
    split = min(SPLIT_MM, first.length_mm / 2)
    rest = first.length_mm - split
    holes = " (its bolt holes then end there)" if design.shaft.bolt_count else ""
    return (
        f"K_e is {why_too_large(design, estimate)}; its bounds do not count that, and it may change with "
        "shaft.segment[0].length_mm the wrong way. Remedy: split the first [[shaft.segment]] into one with "
        f"length_mm = {split:g} and inner_diameter_mm = {f.size(f.land.inner):g} (flexspline.{f.land.inner})"
        f"{holes} and one with length_mm = {rest:g} and the old diameters"
    )


def too_large_lines(design: Design) -> tuple[str, ...]:
    """`too_large_line` where the shaft is `held_beyond_flange`."""
    return (too_large_line(design),) if held_beyond_flange(design) else ()


@lru_cache(maxsize=KEPT)
def _excess(shaft: Part, from_mm: float) -> float:
    # here, as the live page's server asks for words alone
    from flexspline.fea.axisymmetric.torsion import torsional_stiffness
    from flexspline.fea.types import Elastic

    def K(outline: Meridian) -> float:
        elastic = Elastic.of(shaft.material)
        return torsional_stiffness(outline, elastic, shaft.driven, ESTIMATE_WIDTH).K_Nm_per_rad

    return K(shaft.meridian) / K(with_mount_from(shaft.meridian, from_mm)) - 1
