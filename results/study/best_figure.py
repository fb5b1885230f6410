"""The best designs' flexsplines in section, over the design that the study began with."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geometry.design import Design
from geometry.meridian import meridian
from pipeline.study.result import StudyResult
from results.study.labels import entry
from results.style import ACCENT, INK, MUTED, STEEL, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 3


def write_best(path: Path, result: StudyResult) -> None:
    """Half sections of up to SHOWN designs, one below the other, to one scale."""
    best = result.best(SHOWN)
    base = _outline(result.study.design)
    outlines = [_outline(result.design_of(r)) for r in best]
    everything = np.concatenate([base, *outlines])
    (r0, z0), (r1, z1) = everything.min(axis=0), everything.max(axis=0)
    tall = 6.4 * (r1 - r0) / (z1 - z0)
    with styled():
        figure = new_figure(8.0, len(best) * (tall + 0.75) + 0.5)
        share = 1 / figure.get_figheight()
        for i, (row, outline) in enumerate(zip(best, outlines, strict=True)):
            bottom = 1 - share * ((i + 1) * (tall + 0.75))
            axes = figure.add_axes((0.10, bottom, 0.80, share * tall))
            _section(axes, base, outline)
            axes.set_xlim(z0 - 0.5, z1 + 0.5)
            axes.set_ylim(r0 - 0.5, r1 + 0.5)
            axes.set_ylabel("r in mm")
            figures = ", ".join(
                f"{entry(k).mathtext} = {entry(k).with_unit(row.outcome.figures[k])}"
                for k in result.study.file.objective
            )
            axes.set_title(f"design {row.slot}: {figures}", fontsize=10.5, color=INK, pad=6)
        axes.set_xlabel("z in mm; dashed: the design the study began with", color=MUTED)
        save_png(figure, path)


def _outline(design: Design) -> np.ndarray:
    """Points (n, 2) around the flexspline's section, (r, z) in mm."""
    t = np.linspace(0, 1, 17)[:-1]
    return np.concatenate([s.at(t) for s in meridian(design, "flexspline").segments])


def _section(axes: Axes, base: np.ndarray, outline: np.ndarray) -> None:
    axes.fill(outline[:, 1], outline[:, 0], fc=STEEL, ec=INK, lw=0.9)
    closed = np.concatenate([base, base[:1]])
    axes.plot(closed[:, 1], closed[:, 0], "--", color=ACCENT, lw=0.8)
    axes.set_aspect("equal", adjustable="box")
