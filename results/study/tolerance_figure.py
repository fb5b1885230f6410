"""The picture of a tolerance study: distribution, Sobol indices, what tightening buys."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pipeline.study.scatter import FACTORS, Scatter
from results.study.labels import axis_label, entry, long_name
from results.style import ACCENT, INK, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def write_scatter(path: Path, scatter: Scatter) -> None:
    """Three panels over one figure's scatter."""
    k = len(scatter.inputs)
    with styled():
        height = 3.6 + 0.62 * k
        figure = new_figure(8.0, height)
        top = 2.2 / height
        above = figure.add_axes((0.10, 1 - top - 0.35 / height, 0.86, top))
        _distribution(above, scatter)
        low, rest = 0.75 / height, 1 - top - 1.95 / height
        left = figure.add_axes((0.30, low, 0.28, rest))
        right = figure.add_axes((0.68, low, 0.28, rest))
        order = np.argsort(scatter.indices.total)
        _indices(left, scatter, order)
        _bought(right, scatter, order)
        save_png(figure, path)


def _distribution(axes: Axes, s: Scatter) -> None:
    axes.hist(s.values, bins=min(40, max(8, len(s.values) // 8)), color=PALETTE[1], ec="white")
    axes.axvspan(s.low, s.high, color=PALETTE[3], alpha=0.45, lw=0, zorder=0)
    axes.axvline(s.mean, color=ACCENT, lw=1.6)
    q = entry(s.key)
    axes.set_title(f"95 % from {q.range_text(s.low, s.high)} {q.unit}", color=INK)
    axes.set_xlabel(axis_label(s.key))
    axes.set_ylabel("designs")


def _indices(axes: Axes, s: Scatter, order: np.ndarray) -> None:
    y = np.arange(len(order))
    for shift, value, off, colour, name in (
        (0.18, s.indices.total, s.indices.total_conf, PALETTE[0], "total"),
        (-0.18, s.indices.first, s.indices.first_conf, PALETTE[2], "first order"),
    ):
        axes.barh(
            y + shift, np.maximum(value[order], 0), 0.32, xerr=off[order], color=colour, label=name,
            error_kw={"lw": 1.0, "ecolor": INK},
        )  # fmt: skip
    axes.set_yticks(y, [long_name(s.inputs[i].key) for i in order])
    axes.set_xlim(0, 1.05)
    axes.set_xlabel("Sobol index, ± 95 %")
    axes.legend(loc="lower right", fontsize=8.5)


def _bought(axes: Axes, s: Scatter, order: np.ndarray) -> None:
    y = np.arange(len(order))
    by = {(t.key, t.factor): t.bought for t in s.tightened}
    shades = (PALETTE[3], PALETTE[2], PALETTE[1], PALETTE[0])
    for i in range(len(FACTORS) - 1, -1, -1):
        values = [max(0.0, by[s.inputs[j].key, FACTORS[i]]) for j in order]
        said = f"× {FACTORS[i]:g}" if FACTORS[i] else "perfect"
        axes.barh(y, values, 0.62, color=shades[i], label=said)
    axes.set_yticks(y, [""] * len(order))
    axes.set_xlabel(f"95 % range narrower by, {entry(s.key).unit}")
    handles, names = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], names[::-1], loc="lower right", fontsize=8.5)
