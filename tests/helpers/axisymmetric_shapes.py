"""Outlines written by hand or drawn at random, for checks of the axisymmetric solvers."""

from __future__ import annotations

from hypothesis import strategies as st

from flexspline.geometry.cup import Cup
from flexspline.geometry.hat import Hat
from flexspline.geometry.outline import Meridian, Segment
from flexspline.geometry.shaft_shape import Shaft, ShaftSegment


def outline(*corners: tuple[float, float, str | None]) -> Meridian:
    """Straight outline through (r, z), each with the patch of the edge that leaves it."""
    return Meridian(
        tuple(
            Segment((r, z), corners[(i + 1) % len(corners)][:2], patch=patch)
            for i, (r, z, patch) in enumerate(corners)
        )
    )


def tube(inner: float, outer: float, length: float) -> Meridian:
    """Held at z = 0, turned at its other end."""
    return outline(
        (inner, 0, "mount"), (outer, 0, None), (outer, length, "grip"), (inner, length, None)
    )


def annular_plate(inner: float, outer: float, thickness: float) -> Meridian:
    """Held at its bore, turned at its rim."""
    return outline(
        (inner, 0, None), (outer, 0, "grip"), (outer, thickness, None), (inner, thickness, "mount")
    )


MODEL_CUP = Cup(
    kind="cup",
    inner_diameter_mm=39.6,
    wall_thickness_mm=0.4,
    ring_thickness_mm=0.4,
    length_mm=30.0,
    ring_width_mm=8.0,
    diaphragm_thickness_mm=2.0,
    boss_diameter_mm=22.0,
    boss_thickness_mm=2.001,
    bore_diameter_mm=10.0,
)
"""The published shell model's cup: mid radius 20, wall 0.4, length 30, diaphragm 2.0, clamped at 11 mm."""


@st.composite
def cups(draw: st.DrawFn) -> Meridian:
    tube = _tube(draw)
    inner = tube["inner_diameter_mm"] / 2
    thickness = draw(st.floats(0.4, 2.5))
    boss = draw(st.floats(0.2, 0.7)) * inner
    bore = draw(st.sampled_from([0.0, 0.3, 0.6])) * boss
    fillet = draw(st.floats(0.1, 0.8)) * min(inner - boss, 0.2 * tube["length_mm"])
    return Cup(
        kind="cup",
        **tube,
        diaphragm_thickness_mm=thickness,
        boss_diameter_mm=2 * boss,
        boss_thickness_mm=thickness + draw(st.floats(0.3, 4)),
        bore_diameter_mm=2 * bore,
        inner_fillet_mm=fillet,
        outer_fillet_mm=min(fillet, 0.9 * thickness),
    ).meridian()


@st.composite
def hats(draw: st.DrawFn) -> Meridian:
    tube = _tube(draw)
    wall = tube["inner_diameter_mm"] / 2 + tube["wall_thickness_mm"]
    thickness = draw(st.floats(0.4, 2.5))
    flange = wall * draw(st.floats(1.3, 1.8))
    fillet = draw(st.floats(0.1, 0.8)) * min(flange - wall, 0.2 * tube["length_mm"])
    return Hat(
        kind="hat",
        **tube,
        diaphragm_thickness_mm=thickness,
        flange_inner_diameter_mm=2 * flange,
        flange_outer_diameter_mm=2 * flange * draw(st.floats(1.1, 1.4)),
        flange_thickness_mm=thickness + draw(st.floats(0.3, 4)),
        inner_fillet_mm=fillet,
        outer_fillet_mm=min(fillet, 0.9 * thickness),
    ).meridian()


@st.composite
def shafts(draw: st.DrawFn) -> Meridian:
    count = draw(st.integers(1, 4))
    bore = draw(st.sampled_from([0.0, 2.0, 4.0]))
    segments = tuple(
        ShaftSegment(
            length_mm=draw(st.floats(6, 20)),
            outer_diameter_mm=float(draw(st.integers(10, 30))),
            inner_diameter_mm=draw(st.sampled_from([0.0, bore])),
        )
        for _ in range(count)
    )
    grip = draw(st.floats(0.2, 0.8)) * segments[-1].length_mm
    return Shaft(
        segment=segments, fillet_mm=draw(st.floats(0.05, 0.45)), grip_length_mm=grip
    ).meridian()


def _tube(draw: st.DrawFn) -> dict[str, float]:
    inner = draw(st.floats(15, 60))
    length = inner * draw(st.floats(0.4, 1.5))
    wall = draw(st.floats(0.008, 0.04)) * inner
    return {
        "inner_diameter_mm": inner,
        "wall_thickness_mm": wall,
        "ring_thickness_mm": wall * draw(st.floats(1.05, 2.5)),
        "length_mm": length,
        "ring_width_mm": length * draw(st.floats(0.15, 0.35)),
        "ring_offset_mm": draw(st.sampled_from([0.0, 0.1])) * length,
    }
