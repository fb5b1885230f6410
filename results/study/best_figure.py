"""Sections of the best flexsplines, drawn over the first design.

A wall is a hundredth of a section's length, so two places are drawn again, enlarged: the closed end's
corner and the beginning of the toothed ring. Everything is in proportion.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.study.labels import entry
from flexspline.results.style import ACCENT, INK, MUTED, RULE, STEEL, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DRAWN_DESIGNS = 3
"""Designs, a row each."""
WIDE_IN, SECTION_IN, DETAIL_IN = 7.4, 3.8, (2.4, 0.76)
"""Inches: the figure's width, the sections' width, a detail's width and height."""
ROW_IN, LEFT_IN, FOOT_IN = 0.8, 0.7, 0.7
"""Inches: what a row needs besides its section, and the margins left and below."""
DETAIL_WALLS = 3.2
"""A detail's height in wall thicknesses of the thickest wall shown."""
MARGIN_MM = 0.5
"""Around what is shown."""


def write_best(path: Path, result: StudyResult) -> None:
    """Half sections of up to DRAWN_DESIGNS designs to one scale, and beside each its walls enlarged."""
    with styled():
        save_png(best_figure(result), path)


def best_figure(result: StudyResult) -> Figure:
    """One row for each design."""
    best = result.best(DRAWN_DESIGNS)
    base = result.study.design
    designs = [result.design_of(r) for r in best]
    everything = np.concatenate([_outline(d) for d in (base, *designs)])
    (r0, z0), (r1, z1) = everything.min(axis=0) - MARGIN_MM, everything.max(axis=0) + MARGIN_MM
    tall = max(SECTION_IN * (r1 - r0) / (z1 - z0), 2 * DETAIL_IN[1] + 0.35)
    high = len(best) * (tall + ROW_IN) + FOOT_IN
    figure = new_figure(WIDE_IN, high)
    walls = [d.flexspline.wall_thickness_mm for d in (base, *designs)]
    window = DETAIL_WALLS * max(walls) * np.array([DETAIL_IN[0] / DETAIL_IN[1], 1.0])
    times = DETAIL_IN[0] / window[0] / (SECTION_IN / (z1 - z0))
    for i, (row, design) in enumerate(zip(best, designs, strict=True)):
        bottom = high - (i + 1) * (tall + ROW_IN) + 0.25
        axes = _axes(figure, LEFT_IN, bottom, SECTION_IN, tall)
        _section(axes, base, design)
        axes.set_xlim(z0, z1)
        axes.set_ylim(r1 - tall * (z1 - z0) / SECTION_IN, r1)
        axes.set_ylabel("r in mm")
        figures = ", ".join(
            f"{entry(k).mathtext} = {entry(k).with_unit(row.outcome.figures[k])}"
            for k in result.study.file.objective
        )
        axes.set_title(f"design {row.slot}: {figures}", fontsize=10.5, color=INK, pad=8)
        for name, corner, up in zip(
            "ab", _places(design, window), (bottom + tall - DETAIL_IN[1], bottom), strict=True
        ):
            detail = _axes(figure, LEFT_IN + SECTION_IN + 0.35, up, *DETAIL_IN)
            _section(detail, base, design)
            _framed(axes, detail, name, corner, window, not base.flexspline.inward)
    axes.set_xlabel("z in mm")
    figure.text(
        LEFT_IN / WIDE_IN, 0.12 / high,
        f"dashed: the start design; a, b: enlarged {times:.1f} times",
        color=MUTED, fontsize=9.5,
    )  # fmt: skip
    return figure


def _axes(figure: Figure, left: float, bottom: float, wide: float, tall: float) -> Axes:
    """Axes placed in inches."""
    w, h = figure.get_size_inches()
    return figure.add_axes((left / w, bottom / h, wide / w, tall / h))


def _outline(design: Design) -> np.ndarray:
    """Points (n, 2) around the flexspline's section, (r, z) in mm."""
    t = np.linspace(0, 1, 17)[:-1]
    return np.concatenate([s.at(t) for s in design.part("flexspline").meridian.segments])


def _places(design: Design, window: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower left corners (z, r) of both details: the closed end's corner, the ring's beginning."""
    f = design.flexspline
    inner = f.inner_diameter_mm / 2
    if f.inward:
        low = inner + f.ring_thickness_mm - 0.88 * window[1]
    else:
        low = inner - 0.12 * window[1]
    ring = f.length_mm - f.ring_offset_mm - f.ring_width_mm
    return np.array([-0.1 * window[0], low]), np.array([ring - window[0] / 2, low])


def _section(axes: Axes, base: Design, design: Design) -> None:
    shape, began = _outline(design), _outline(base)
    axes.fill(shape[:, 1], shape[:, 0], fc=STEEL, ec=INK, lw=0.9)
    closed = np.concatenate([began, began[:1]])
    axes.plot(closed[:, 1], closed[:, 0], "--", color=ACCENT, lw=0.8)


def _framed(
    axes: Axes, detail: Axes, name: str, corner: np.ndarray, window: np.ndarray, above: bool
) -> None:
    """The detail's limits and frame, and its place in the section; its letter on the free side."""
    from matplotlib.patches import Rectangle

    (z, r), (wide, high) = corner, window
    axes.add_patch(Rectangle((z, r), wide, high, fc="none", ec=MUTED, lw=0.8))
    axes.annotate(
        name, (z + wide * (0.5 if name == "a" else 0.9), r + high if above else r),
        xytext=(0, 2 if above else -2), textcoords="offset points", ha="center",
        va="bottom" if above else "top", color=MUTED, fontsize=9.5,
    )  # fmt: skip
    detail.set_xlim(z, z + wide)
    detail.set_ylim(r, r + high)
    detail.set_xticks([])
    detail.set_yticks([])
    for side in detail.spines.values():
        side.set_visible(True)
        side.set_color(RULE)
    detail.text(
        1.02, 0.98, name, transform=detail.transAxes, ha="left", va="top", color=MUTED, fontsize=9.5
    )
