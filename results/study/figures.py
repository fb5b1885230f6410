"""The pictures of a study: Pareto front, parallel coordinates, convergence, and when each is drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.study.best_figure import write_best
from flexspline.results.study.labels import axis_label, entry, in_the_table, lines_of
from flexspline.results.study.sweep_figure import is_sweep, write_sweep
from flexspline.results.study.tolerance_figure import write_scatter
from flexspline.results.style import (
    ACCENT,
    COLOUR_MAP,
    INK,
    MUTED,
    PALETTE,
    new_figure,
    save_png,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_AXES = 9
"""Of parallel coordinates: beyond, the labels touch; objectives come first."""


def write_figures(folder: Path, result: StudyResult, best: Path | None = None) -> list[Path]:
    """Every chart that the study has matter for; their paths, `best`'s (drawn already) in its place."""
    objectives = list(result.study.file.objective)
    written: list[Path] = []
    if len(result.built) < 2:
        return written
    if len(objectives) >= 2 and not result.about_scatter and result.feasible:
        written.append(folder / "pareto.png")
        write_pareto(written[-1], result)
    if objectives and not result.about_scatter:
        if result.pareto:
            written.append(folder / "best.png")
            write_best(written[-1], result)
        if best:
            written.append(best)
    if result.shown and not result.about_scatter:
        name, draw = ("sweep", write_sweep) if is_sweep(result) else ("parallel", write_parallel)
        written.append(folder / f"{name}.png")
        draw(written[-1], result)
    if objectives and not result.about_scatter and not _has_no_order(result):
        written.append(folder / "convergence.png")
        write_convergence(written[-1], result)
    for i, scatter in enumerate(result.scatter):
        written.append(folder / ("tolerance.png" if i == 0 else f"tolerance-{i + 1}.png"))
        write_scatter(written[-1], scatter)
    return written


def _has_no_order(result: StudyResult) -> bool:
    """Whether designs follow each other by no choice and one curve shows them all."""
    return is_sweep(result) and result.study.file.run.method != "optimize"


def _values(rows: tuple[Row, ...], key: str) -> np.ndarray:
    return np.array([r.outcome.figures[key] for r in rows])


def write_pareto(path: Path, result: StudyResult) -> None:
    """The first two objectives against each other; a third is the colour."""
    first, second, *more = result.study.file.objective
    out, front = result.not_allowed, result.pareto
    with styled():
        figure = new_figure(8.0, 5.0)
        axes = figure.add_axes((0.11, 0.22, 0.72 if more else 0.86, 0.68))
        if out:
            axes.scatter(
                _values(out, first), _values(out, second), s=22, facecolors="none",
                edgecolors=MUTED, linewidths=0.8, label="breaks a constraint",
            )  # fmt: skip
        x, y = _values(result.feasible, first), _values(result.feasible, second)
        colour = _values(result.feasible, more[0]) if more else PALETTE[1]
        dots = axes.scatter(
            x, y, s=26, c=colour, cmap=COLOUR_MAP if more else None,
            label="within the constraints" if result.study.file.constraint else "designs",
        )  # fmt: skip
        order = np.argsort(_values(front, first))
        at = np.column_stack([_values(front, first), _values(front, second)])[order]
        line = "-" if not more else ""  # a front of three is no curve here
        axes.plot(
            at[:, 0], at[:, 1], line, marker="o", color=ACCENT, lw=1.4, ms=9, mfc="none", mew=1.6,
            label="Pareto front",
        )  # fmt: skip
        axes.set_xlabel(axis_label(first))
        axes.set_ylabel(axis_label(second))
        axes.grid(True)
        if more:
            bar = figure.colorbar(dots, cax=figure.add_axes((0.86, 0.22, 0.02, 0.68)))
            bar.set_label(axis_label(more[0]))
        axes.set_title(
            f"{len(front)} {'design' if len(front) == 1 else 'designs'} on the Pareto front",
            color=INK,
        )
        figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=3)
        save_png(figure, path)


def write_parallel(path: Path, result: StudyResult) -> None:
    """A line per design over the varied keys and the figures shown, coloured by the first of these."""
    import matplotlib as mpl
    from matplotlib.collections import LineCollection

    limits = result.study.file.constraint
    shown = [*result.shown, *(k for k in limits if k not in result.shown)][: MOST_AXES - 1]
    varied = list(result.built[0].values)
    keys = varied[: max(1, MOST_AXES - len(shown))]
    rest = len(varied) - len(keys)
    more = f"; {in_the_table(rest, 'dimension')}" if rest else ""
    columns = [np.array([r.values[k] for r in result.built]) for k in keys]
    columns += [_values(result.built, k) for k in shown]
    names = keys + shown
    low = [float(c.min()) for c in columns]
    high = [float(c.max()) for c in columns]
    scaled = np.column_stack(
        [(c - a) / (b - a) if b > a else np.full(len(c), 0.5)
         for c, a, b in zip(columns, low, high, strict=True)]
    )  # fmt: skip
    paths = np.stack([np.tile(np.arange(len(names)), (len(scaled), 1)), scaled], axis=-1)
    best = {r.slot for r in result.pareto}
    marked = np.array([r.slot in best for r in result.built])
    feasible = {r.slot for r in result.feasible}
    kept = np.array([r.slot in feasible for r in result.built]) & ~marked
    with styled():
        figure = new_figure(max(8.0, 1.25 * len(names)), 4.6)
        axes = figure.add_axes((0.08, 0.24, 0.84, 0.66))
        colours = mpl.colormaps[COLOUR_MAP](scaled[:, len(keys)])
        off = ~kept & ~marked
        axes.add_collection(LineCollection(list(paths[off]), colors="#d9dcdf", linewidths=0.8))
        axes.add_collection(
            LineCollection(list(paths[kept]), colors=colours[kept], linewidths=0.9, alpha=0.65)
        )
        axes.add_collection(LineCollection(list(paths[marked]), colors=ACCENT, linewidths=1.8))
        for i, key in enumerate(names):
            axes.axvline(i, color=INK, lw=0.8)
            q = entry(key)
            for y, value, side in ((1.03, high[i], "bottom"), (-0.03, low[i], "top")):
                axes.text(i, y, q.text(value), ha="center", va=side, fontsize=9, color=INK)
            if key in limits and high[i] > low[i]:
                ends = [
                    (e - low[i]) / (high[i] - low[i]) for e in limits[key].ends(low[i], high[i])
                ]
                axes.plot([i, i], np.clip(ends, 0, 1), color=ACCENT, lw=5, alpha=0.3, zorder=0)
            axes.text(i, -0.13, lines_of(key), ha="center", va="top", fontsize=8.5, color=INK)
        axes.set_xlim(-0.3, len(names) - 0.7)
        axes.set_ylim(-0.02, 1.02)
        axes.axis("off")
        first = entry(shown[0]).mathtext
        figure.text(
            0.08, 0.955,
            f"{'red: the best; ' if best else ''}colour: {first} from low (dark) to high (bright)"
            f"{'; grey: not allowed' if off.any() else ''}"
            f"{'; bar: allowed by a constraint' if limits else ''}{more}",
            fontsize=9.5, color=INK,
        )  # fmt: skip
        save_png(figure, path)


def write_convergence(path: Path, result: StudyResult) -> None:
    """Every design's objective and the best so far, one panel each, in the order they were chosen."""
    objective = dict(list(result.study.file.objective.items())[:3])
    with styled():
        figure = new_figure(8.0, 0.6 + 2.6 * len(objective))
        height = 0.94 / len(objective)
        for i, (key, sense) in enumerate(objective.items()):
            bottom = 0.94 - (i + 1) * height + 0.22 * height
            axes = figure.add_axes((0.12, bottom, 0.84, 0.72 * height))
            _settling(axes, result, key, sense)
        handles, names = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="upper right", ncols=3)
        save_png(figure, path)


def _settling(axes: Axes, result: StudyResult, key: str, sense: str) -> None:
    kept, out = result.feasible, result.not_allowed
    if out:
        axes.plot(
            [r.slot for r in out], _values(out, key), "o", mfc="none", mec=MUTED, ms=4,
            label="not allowed",
        )  # fmt: skip
    if kept:
        values, at = _values(kept, key), [r.slot for r in kept]
        best = (
            np.minimum.accumulate(values) if sense == "minimize" else np.maximum.accumulate(values)
        )
        axes.plot(at, values, "o", color=PALETTE[1], ms=4, label="designs")
        axes.step(
            [*at, len(result.rows) - 1], [*best, best[-1]], where="post", color=ACCENT, lw=1.6,
            label="best so far",
        )  # fmt: skip
    q = entry(key)
    axes.set_ylabel(f"{q.mathtext} in {q.unit}")
    axes.set_xlabel("design")
    axes.locator_params("x", integer=True)
    axes.grid(True)
