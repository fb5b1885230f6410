"""Hypothesis strategies: parts over the whole range of proportions, up to what fits and beyond."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from hypothesis import strategies as st

Segments = list[tuple[float, float, float]]


def share(low: float, high: float) -> st.SearchStrategy[float]:
    """A fraction of what fits; the ends themselves are tried often.

    Not between 0.95 and 1: lands narrower than the chord error cannot be triangulated.
    """
    return st.one_of(st.sampled_from([low, high]), st.floats(low, min(high, 0.95)))


@dataclass(frozen=True)
class Tube:
    """What cups and hats have in common, in mm."""

    radius: float
    """Inner."""
    length: float
    wall: float
    ring: float
    """Thickness of the toothed ring."""
    width: float
    offset: float
    diaphragm: float

    @property
    def below(self) -> float:
        """From z = 0 to the ring."""
        return self.length - self.offset - self.width

    @property
    def values(self) -> dict[str, float]:
        return {
            "inner_diameter_mm": 2 * self.radius,
            "wall_thickness_mm": self.wall,
            "ring_thickness_mm": self.ring,
            "length_mm": self.length,
            "ring_width_mm": self.width,
            "ring_offset_mm": self.offset,
            "diaphragm_thickness_mm": self.diaphragm,
        }


def tube(draw: st.DrawFn, kind: Literal["cup", "hat"]) -> Tube:
    """A cup's diaphragm lies below the seat, inside; a hat's below the ring's shoulder, outside."""
    ri, length = draw(st.floats(5, 60)), draw(st.floats(5, 80))
    wall = ri * draw(st.floats(0.005, 0.15))
    ring = wall * draw(st.one_of(st.just(1.0), st.floats(1, 3)))
    h = length * draw(st.floats(0.005, 0.3))
    shoulder = ring - wall
    room = length - (max(h, shoulder) if kind == "cup" else h + shoulder)
    width = room * draw(share(0.05, 0.9))
    offset = (room - width) * draw(st.one_of(st.just(0.0), st.floats(0, 0.9)))
    return Tube(ri, length, wall, ring, width, offset, h)


def thicker(draw: st.DrawFn, tube: Tube) -> float:
    """Of a boss or flange: from the diaphragm's thickness to nearly the whole length."""
    more = draw(st.one_of(st.just(0.0), st.floats(0, 0.9)))
    return tube.diaphragm + (tube.length - tube.diaphragm) * more


@st.composite
def cups(draw: st.DrawFn) -> dict[str, float]:
    """Cups over the whole range of proportions, fillets and holes up to what fits and beyond."""
    t = tube(draw, "cup")
    boss = t.radius * draw(st.floats(0.2, 0.95))
    bore = boss * draw(st.one_of(st.just(0.0), st.floats(0.05, 0.9)))
    hole = (boss - bore) * draw(st.floats(0.05, 0.9))
    inside = min(t.radius - boss, t.below - t.diaphragm)
    outside = min(t.radius + t.wall - boss, t.below - t.ring + t.wall)
    values = t.values | {
        "boss_diameter_mm": 2 * boss,
        "boss_thickness_mm": thicker(draw, t),
        "bore_diameter_mm": 2 * bore,
        "inner_fillet_mm": inside * draw(share(0, 1)),
        "outer_fillet_mm": outside * draw(share(0, 1)),
        "bolt_count": draw(st.integers(0, 8)),
        "bolt_circle_diameter_mm": boss + bore + draw(st.floats(-0.5, 0.5)) * (boss - bore - hole),
        "bolt_hole_diameter_mm": hole,
    }
    return {f"flexspline.{k}": v for k, v in values.items()}


@st.composite
def hats(draw: st.DrawFn) -> dict[str, float]:
    """Hats over the whole range of proportions, fillets and holes up to what fits and beyond."""
    t = tube(draw, "hat")
    wall = t.radius + t.wall
    inner = wall * draw(st.floats(1.02, 2))
    outer = inner * draw(st.floats(1.05, 2))
    hole = (outer - inner) * draw(st.floats(0.05, 0.9))
    values = t.values | {
        "flange_outer_diameter_mm": 2 * outer,
        "flange_inner_diameter_mm": 2 * inner,
        "flange_thickness_mm": thicker(draw, t),
        "inner_fillet_mm": min(inner - wall, t.below - t.ring + t.wall - t.diaphragm)
        * draw(share(0, 1)),
        "outer_fillet_mm": min(inner - t.radius, t.below) * draw(share(0, 1)),
        "bolt_count": draw(st.integers(0, 8)),
        "bolt_circle_diameter_mm": inner
        + outer
        + draw(st.floats(-0.5, 0.5)) * (outer - inner - hole),
        "bolt_hole_diameter_mm": hole,
    }
    return {f"flexspline.{k}": v for k, v in values.items()}


@st.composite
def shafts(draw: st.DrawFn) -> tuple[Segments, str, float]:
    """Segments, grip and keyway as TOML text, fillet: up to what fits and beyond."""
    outer = st.one_of(st.sampled_from([12.0, 18.0, 25.0]), st.floats(10, 40))
    bore = st.one_of(st.just(0.0), st.floats(0.05, 0.9))
    segments = [
        (draw(st.floats(2, 30)), d, d * draw(bore))
        for d in draw(st.lists(outer, min_size=1, max_size=4))
    ]
    length = sum(s[0] for s in segments)
    text = f"grip_length_mm = {length * draw(st.floats(0.05, 0.99))}"
    if draw(st.booleans()):
        radius = segments[-1][1] / 2
        depth, width = radius * draw(st.floats(0.02, 0.5)), radius * draw(st.floats(0.05, 1.2))
        reach = length * draw(st.floats(0.05, 0.98))
        text += f"\n[keyway]\ndepth_mm = {depth}\nwidth_mm = {width}\nlength_mm = {reach}"
    return segments, text, draw(st.one_of(st.just(0.0), st.floats(0, 3)))
