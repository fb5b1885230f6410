"""The picture of a tolerance study: distribution, Sobol indices, gain from tighter tolerances."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.pipeline.study.indices import Indices
from flexspline.pipeline.study.scatter import TIGHTENING_FACTORS, Scatter
from flexspline.results.study.gains import gains_drawn
from flexspline.results.study.labels import axis_label, entry, long_name
from flexspline.results.style import ACCENT, INK, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes


INPUT_IN, LEGEND_IN = 0.62, 0.34
"""Heights: of an input's bars, of a legend above them."""


def write_scatter(path: Path, scatter: Scatter) -> None:
    """The distribution, and below it indices and tightening, as far as there are any."""
    k = len(scatter.inputs)
    below = 1.1 + LEGEND_IN + INPUT_IN * k if scatter.indices else 0.1
    with styled():
        height = 3.15 + below
        figure = new_figure(8.0, height)
        above = figure.add_axes((0.10, (below + 0.55) / height, 0.86, 2.15 / height))
        _distribution(above, scatter)
        low, rest = 0.75 / height, INPUT_IN * k / height
        order = np.array(scatter.order[::-1])
        if scatter.indices:
            wide = 0.30 if scatter.tightened else 0.70
            _indices(figure.add_axes((0.21, low, wide, rest)), scatter, scatter.indices, order)
        if scatter.tightened:
            _bought(figure.add_axes((0.57, low, 0.39, rest)), scatter, order)
        save_png(figure, path)


def _distribution(axes: Axes, s: Scatter) -> None:
    bins = min(60, max(8, int(len(s.drawn) ** 0.5)))
    share = np.full(len(s.drawn), 100 / len(s.drawn))
    axes.hist(s.drawn, bins=bins, weights=share, color=PALETTE[1], ec="white", lw=0.6)
    axes.axvspan(s.low, s.high, color=PALETTE[3], alpha=0.45, lw=0, zorder=0)
    axes.axvline(s.mean, color=ACCENT, lw=1.6)
    q = entry(s.key)
    source = "by a quadratic fit" if s.surface else f"{len(s.values)} designs"
    axes.set_title(f"95 % from {q.range_text(s.low, s.high)} {q.unit}, {source}", color=INK)
    axes.set_xlabel(axis_label(s.key))
    axes.set_ylabel("% of gears")
    axes.margins(y=0.2)  # room for the mean's name, above the highest bar
    right = s.mean < sum(axes.get_xlim()) / 2  # where there is more room for it
    axes.annotate(
        f"mean {q.text(s.mean)}", (s.mean, 1), (6 if right else -6, -4),
        xycoords=("data", "axes fraction"), textcoords="offset points",
        color=ACCENT, ha="left" if right else "right", va="top",
    )  # fmt: skip


def _indices(axes: Axes, s: Scatter, indices: Indices, order: np.ndarray) -> None:
    y = np.arange(len(order))
    for shift, value, ends, colour, name in (
        (0.18, indices.total, indices.total_ends, PALETTE[0], "total"),
        (-0.18, indices.first, indices.first_ends, PALETTE[2], "first order"),
    ):
        off = np.abs(ends - value[:, None])[order].T
        axes.barh(
            y + shift, value[order], 0.32, xerr=off, color=colour, label=name,
            error_kw={"lw": 1.3, "ecolor": ACCENT},
        )  # fmt: skip
    axes.set_yticks(y, [long_name(s.inputs[i].key) for i in order])
    axes.set_xlim(0, 1.05)
    axes.set_xlabel("Sobol index with 95 % interval")
    _legend_above(axes, 2)


def _bought(axes: Axes, s: Scatter, order: np.ndarray) -> None:
    y = np.arange(len(order))
    by = gains_drawn(s)
    shades = (PALETTE[3], PALETTE[2], PALETTE[1], PALETTE[0])
    for i in range(len(TIGHTENING_FACTORS) - 1, -1, -1):
        values = [by[s.inputs[j].key, TIGHTENING_FACTORS[i]] for j in order]
        factor = f"× {TIGHTENING_FACTORS[i]:g}" if TIGHTENING_FACTORS[i] else "perfect"
        axes.barh(y, values, 0.62, color=shades[i], label=factor)
    axes.set_yticks(y, [""] * len(order))
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(f"95 % range narrower by, in {entry(s.key).unit}")
    _legend_above(axes, 4)


def _legend_above(axes: Axes, columns: int) -> None:
    """Outside the axes: bars of any length leave it free."""
    handles, names = axes.get_legend_handles_labels()
    axes.legend(
        handles[::-1] if columns > 2 else handles, names[::-1] if columns > 2 else names,
        loc="lower left", bbox_to_anchor=(-0.03, 1.0), ncols=columns, fontsize=8.5,
        columnspacing=0.8, handlelength=1.1, handletextpad=0.4, borderaxespad=0.2,
    )  # fmt: skip
