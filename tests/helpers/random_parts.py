"""Hypothesis strategies: parts over the whole range of proportions, up to what fits and beyond."""

from __future__ import annotations

from hypothesis import strategies as st

Segments = list[tuple[float, float, float]]


def share(low: float, high: float) -> st.SearchStrategy[float]:
    """A fraction of what fits; the ends themselves are tried often.

    Not between 0.95 and 1: lands narrower than the chord error cannot be triangulated.
    """
    return st.one_of(st.sampled_from([low, high]), st.floats(low, min(high, 0.95)))


@st.composite
def cups(draw: st.DrawFn) -> dict[str, str]:
    """Cups over the whole range of proportions, fillets and holes up to what fits and beyond."""
    ri, length = draw(st.floats(5, 60)), draw(st.floats(5, 80))
    wall = ri * draw(st.floats(0.005, 0.15))
    ring = wall * draw(st.one_of(st.just(1.0), st.floats(1, 3)))
    h = length * draw(st.floats(0.005, 0.3))
    room = min(length - h, length - ring + wall)
    width = room * draw(share(0.05, 0.9))
    offset = (room - width) * draw(st.one_of(st.just(0.0), st.floats(0, 0.9)))
    below = length - offset - width
    boss = ri * draw(st.floats(0.2, 0.95))
    bore = boss * draw(st.one_of(st.just(0.0), st.floats(0.05, 0.9)))
    hole = (boss - bore) * draw(st.floats(0.05, 0.9))
    circle = boss + bore + draw(st.floats(-0.5, 0.5)) * (boss - bore - hole)
    inner_fillet = min(ri - boss, below - h) * draw(share(0, 1))
    outer_fillet = min(ri + wall - boss, below - ring + wall) * draw(share(0, 1))
    values = {
        "inner_diameter_mm": 2 * ri,
        "wall_thickness_mm": wall,
        "ring_thickness_mm": ring,
        "length_mm": length,
        "ring_width_mm": width,
        "ring_offset_mm": offset,
        "diaphragm_thickness_mm": h,
        "boss_diameter_mm": 2 * boss,
        "boss_thickness_mm": h + (length - h) * draw(st.one_of(st.just(0.0), st.floats(0, 0.9))),
        "bore_diameter_mm": 2 * bore,
        "inner_fillet_mm": inner_fillet,
        "outer_fillet_mm": outer_fillet,
        "bolt_count": draw(st.integers(0, 8)),
        "bolt_circle_diameter_mm": circle,
        "bolt_hole_diameter_mm": hole,
    }
    return {f"flexspline.{k}": repr(v) for k, v in values.items()}


@st.composite
def hats(draw: st.DrawFn) -> dict[str, str]:
    """Hats over the whole range of proportions, fillets and holes up to what fits and beyond."""
    ri, length = draw(st.floats(5, 60)), draw(st.floats(5, 80))
    wall = ri * draw(st.floats(0.005, 0.15))
    ring = wall * draw(st.one_of(st.just(1.0), st.floats(1, 3)))
    h = length * draw(st.floats(0.005, 0.3))
    room = min(length, length - ring + wall - h)
    width = room * draw(share(0.05, 0.9))
    offset = (room - width) * draw(st.one_of(st.just(0.0), st.floats(0, 0.9)))
    below = length - offset - width
    inner = (ri + wall) * draw(st.floats(1.02, 2))
    outer = inner * draw(st.floats(1.05, 2))
    hole = (outer - inner) * draw(st.floats(0.05, 0.9))
    values = {
        "inner_diameter_mm": 2 * ri,
        "wall_thickness_mm": wall,
        "ring_thickness_mm": ring,
        "length_mm": length,
        "ring_width_mm": width,
        "ring_offset_mm": offset,
        "diaphragm_thickness_mm": h,
        "flange_outer_diameter_mm": 2 * outer,
        "flange_inner_diameter_mm": 2 * inner,
        "flange_thickness_mm": h + (length - h) * draw(st.one_of(st.just(0.0), st.floats(0, 0.9))),
        "inner_fillet_mm": min(inner - ri - wall, below - ring + wall - h) * draw(share(0, 1)),
        "outer_fillet_mm": min(inner - ri, below) * draw(share(0, 1)),
        "bolt_count": draw(st.integers(0, 8)),
        "bolt_circle_diameter_mm": inner
        + outer
        + draw(st.floats(-0.5, 0.5)) * (outer - inner - hole),
        "bolt_hole_diameter_mm": hole,
    }
    return {f"flexspline.{k}": repr(v) for k, v in values.items()}


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
