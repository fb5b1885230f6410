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
from flexspline.geometry.outline import Meridian
from flexspline.geometry.part import Part
from flexspline.geometry.percent import percent

ESTIMATE_WIDTH = 0.02
"""Relative width of both bodies' bounds of K, 0.1 s each. K itself agrees within 0.1 % with K from bounds
that are ten times closer."""
LEAST_SHARE = 0.002
"""Smallest excess of K_e that is reported: twice the possible error of each K."""
LEAST_RING_mm, LEAST_RING_SHARE = 0.1, 0.1
"""Width of a ring of two faces that touch, at least, and as a share of the flange's, of small parts. Each
ring lies between edges of two parts, and an edge that a drawing calls sharp may be broken by 0.05 mm (ISO
13715): a narrower ring is not there in the parts as made."""
SPLIT_MM = 0.5
"""Of the first segment: so much of it is hollowed, to leave the face under the flange alone."""
ANY = Material(name="any", youngs_modulus_GPa=1.0, poissons_ratio=0.3)
"""Any shear modulus: both K are proportional to it, so their ratio does not depend on it."""
KEPT = 64
"""Shafts whose excess is kept in memory."""


def held_beyond_flange(design: Design) -> bool:
    """Whether K_e's shaft is held where the hat's flange does not touch it; by its dimensions alone."""
    if design.flexspline.inward:
        return False
    inner = design.flexspline.size(design.flexspline.land.inner)
    beyond = (inner - design.shaft.segment[0].inner_diameter_mm) / 2
    return beyond > _least_ring_mm(design) or not touches(design)


def touches(design: Design) -> bool:
    """Whether a hat's flange and the shaft's first face have a ring in common."""
    f, face = design.flexspline, design.shaft.segment[0]
    inner = max(f.size(f.land.inner), face.inner_diameter_mm)
    outer = min(f.size(f.land.outer), face.outer_diameter_mm)
    return (outer - inner) / 2 >= _least_ring_mm(design)


def excess(design: Design) -> float | None:
    """Return the share by which K_e is larger than that of the shaft held under the flange alone.

    None where the flange does not touch the first face, or no mesh gives it.
    """
    if not touches(design):
        return None
    shaft = replace(design.part("shaft").without_holes(), material=ANY)
    try:
        return _excess(shaft, design.flexspline.size(design.flexspline.land.inner) / 2)
    except ComputationError:
        return None


def is_too_large(design: Design) -> bool:
    """Whether the shaft is `held_beyond_flange`, and K_e larger by more than the estimate may be off by."""
    if not held_beyond_flange(design):
        return False
    share = excess(design)
    return share is None or share >= LEAST_SHARE


def why_too_large(design: Design, estimate: bool = True) -> str:
    """Return the words after "K_e is"; `estimate`: with the figure, which takes up to 0.3 s."""
    if not touches(design):
        return "that of a shaft held on its whole first face, which the hat's flange does not touch"
    share = excess(design) if estimate else None
    by = "" if share is None else f" by about {percent(share)}"
    return f"too large{by}: held on its whole first face, not only under the hat's flange"


def too_large_line(design: Design, estimate: bool = True) -> str:
    """Return the warning, with its remedy."""
    why = why_too_large(design, estimate)
    if not touches(design):
        return f"K_e is {why}; {_apart(design)}"
    f, first = design.flexspline, design.shaft.segment[0]
    split = min(SPLIT_MM, first.length_mm / 2)
    rest = first.length_mm - split
    holes = " (its bolt holes then end there)" if design.shaft.bolt_count else ""
    return (
        f"K_e is {why}; its bounds do not include that, and if you change shaft.segment[0].length_mm, K_e "
        "may change in the wrong direction. Remedy: split the first [[shaft.segment]] into one with "
        f"length_mm = {split:g} and inner_diameter_mm = {f.size(f.land.inner):g} (flexspline.{f.land.inner})"
        f"{holes} and one with length_mm = {rest:g} and the old diameters"
    )


def too_large_lines(design: Design) -> tuple[str, ...]:
    """Return `too_large_line` where `is_too_large`, else nothing."""
    return (too_large_line(design),) if is_too_large(design) else ()


def _least_ring_mm(design: Design) -> float:
    """Less is no ring."""
    f = design.flexspline
    flange = (f.size(f.land.outer) - f.size(f.land.inner)) / 2
    return min(LEAST_RING_mm, LEAST_RING_SHARE * flange)


def _apart(design: Design) -> str:
    """Where the two faces are, and which diameter makes them touch."""
    f, face = design.flexspline, design.shaft.segment[0]
    inner, outer = f.size(f.land.inner), f.size(f.land.outer)
    flange = (
        f"the flange lies between diameters of {inner:g} and {outer:g} mm (flexspline.{f.land.inner}, "
        f"{f.land.outer}), the face between {face.inner_diameter_mm:g} and {face.outer_diameter_mm:g}, and a "
        f"common ring of less than {_least_ring_mm(design):.3g} mm does not count. Remedy: "
    )
    if face.outer_diameter_mm < outer:
        return f"{flange}shaft.segment[0].outer_diameter_mm = {outer:g}"
    return f"{flange}shaft.segment[0].inner_diameter_mm = {inner:g}"


@lru_cache(maxsize=KEPT)
def _excess(shaft: Part, from_mm: float) -> float:
    # here, as the live page's server asks for words alone
    from flexspline.fea.axisymmetric.torsion import torsional_stiffness
    from flexspline.fea.types import Elastic

    def K(outline: Meridian) -> float:
        elastic = Elastic.of(shaft.material)
        return torsional_stiffness(outline, elastic, shaft.driven, ESTIMATE_WIDTH).K_Nm_per_rad

    return K(shaft.meridian) / K(with_mount_from(shaft.meridian, from_mm)) - 1
