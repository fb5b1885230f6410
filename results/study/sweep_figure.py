"""Figures over the one dimension that a study varies: one panel each, with the constraint's limits."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.schema import Limit
from flexspline.results.peaks import BORDER, at_border
from flexspline.results.study.labels import axis_label, entry, in_the_table
from flexspline.results.study.why import allowed
from flexspline.results.style import ACCENT, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_PANELS = 4
"""Of a figure as wide as a page and no higher than its text."""
WIDE_IN, PANEL_IN = 8.0, 1.75
"""Inches: the figure's width, a panel's height."""
TITLE_IN, LEGEND_IN, AXIS_IN = 0.65, 0.25, 0.55
"""Inches: room for a panel's title, for the legend above all and the axis below all panels."""
LINE_IN = 0.2
"""Inches: a further line under the axis."""
TITLE_LETTERS = 75
"""In a line of a panel's title, of 10 points, above WIDE_IN's panel."""
MARGIN = 0.12
"""Of a panel's height above and below the values: room for the ring about the best."""
REACH = 1.0
"""Of what the values span: a limit farther from them would press the curve flat, and is not drawn."""


def is_sweep(result: StudyResult) -> bool:
    """Whether a study varies one dimension, so that every figure is a curve over it."""
    return not result.about_scatter and len(result.study.file.vary) == 1


def swept_figures(result: StudyResult) -> tuple[str, ...]:
    """Figures over the dimension: objectives, constraints by how many designs break them, the rest."""
    limits = sorted(result.study.file.constraint, key=lambda name: len(result.keeping(name)))
    by_use = [*result.study.file.objective, *limits, *result.shown]
    return tuple(dict.fromkeys(by_use))


def write_sweep(path: Path, result: StudyResult) -> None:
    """A panel for each of the first `swept_figures`; a curve is broken where a design was not built."""
    figures = swept_figures(result)
    shown, rest = figures[:MOST_PANELS], figures[MOST_PANELS:]
    (key,) = result.study.file.vary
    under = [axis_label(key), *([in_the_table(len(rest), "figure")] if rest else [])]
    high = LEGEND_IN + len(shown) * (TITLE_IN + PANEL_IN) + AXIS_IN + LINE_IN * len(under[1:])
    with styled():
        figure = new_figure(WIDE_IN, high)
        for i, name in enumerate(shown):
            bottom = high - LEGEND_IN - (i + 1) * (TITLE_IN + PANEL_IN)
            axes = figure.add_axes((0.13, bottom / high, 0.83, PANEL_IN / high))
            _panel(axes, result, key, name)
            if i + 1 < len(shown):
                axes.tick_params(labelbottom=False)
        figure.axes[-1].set_xlabel("\n".join(under))
        named = {
            n: h for a in figure.axes for h, n in zip(*a.get_legend_handles_labels(), strict=True)
        }
        figure.legend(named.values(), named, loc="upper right", ncols=len(named))
        save_png(figure, path)


def _panel(axes: Axes, result: StudyResult, key: str, name: str) -> None:
    rows = sorted((r for r in result.rows if key in r.values), key=lambda r: r.values[key])
    built = {r.slot for r in result.built}
    at = np.array([r.values[key] for r in rows])
    values = np.array([r.outcome.figures[name] if r.slot in built else np.nan for r in rows])
    feasible, front = ({r.slot for r in some} for some in (result.feasible, result.pareto))
    kept = np.array([r.slot in feasible for r in rows])
    marked = np.array([at_border(name, r.outcome.figures) for r in rows])
    best = np.array([r.slot in front for r in rows])
    axes.margins(y=MARGIN)
    axes.plot(at, values, color=PALETTE[1], lw=1.2)
    styles: list[tuple[np.ndarray, str, dict[str, Any]]] = [
        (kept, "designs", {"color": PALETTE[1], "ms": 5}),
        (~kept, "not allowed", {"mfc": "white", "mec": MUTED, "ms": 5}),
        (marked, BORDER, {"marker": "x", "color": INK, "ms": 6}),
        (best, "best", {"mfc": "none", "mec": ACCENT, "ms": 10, "mew": 1.8}),
    ]
    for chosen, words, style in styles:
        there = chosen & np.isfinite(values)
        if there.any():
            axes.plot(
                at[there], values[there], **{"marker": "o", "ls": "", "label": words, **style}
            )
    limit = result.study.file.constraint.get(name)
    if limit is not None:
        _draw_limit(axes, limit, values[np.isfinite(values)])
    q = entry(name)
    title = [q.name] if limit is None else [q.name, f"({allowed(name, limit)})"]
    one_line = sum(map(len, title)) < TITLE_LETTERS
    axes.set_title((" " if one_line else "\n").join(title), fontsize=10)
    axes.set_ylabel(" in ".join(filter(None, (q.symbol and q.mathtext, q.unit))))
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.grid(True)


def _draw_limit(axes: Axes, limit: Limit, values: np.ndarray) -> None:
    """Its ends as lines, where they are near the values; what is beyond is shaded."""
    low, high = float(values.min()), float(values.max())
    far = REACH * ((high - low) or abs(high) or 1.0)
    ends = [(limit.min, -1.0), (limit.max, 1.0)]
    near = [(e, side) for e, side in ends if e is not None and low - far <= e <= high + far]
    for end, _ in near:
        axes.axhline(end, color=ACCENT, lw=1.2, ls="--", label="limit")
    bottom, top = axes.get_ylim()
    for end, side in near:
        axes.axhspan(end, top if side > 0 else bottom, color=ACCENT, alpha=0.08, lw=0, zorder=0)
    axes.set_ylim(bottom, top)
