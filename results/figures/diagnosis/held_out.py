"""Prediction errors before and after, on rows that were not used for fitting."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.results.diagnosis.channels import left_out_words
from flexspline.results.diagnosis.words import noise_words
from flexspline.results.figures.diagnosis.panels import DPI, titled
from flexspline.results.figures.diagnosis.seen import MOST_DRAWN_POINTS
from flexspline.results.figures.fitted_text import wrapped
from flexspline.results.numbers import figures_text
from flexspline.results.style import INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BARS = (
    ("before", "simulation as designed", PALETTE[2]),
    ("calibrated", "calibrated", PALETTE[1]),
    ("after", "with the causes", PALETTE[0]),
)

TITLE_LETTERS = 46
"""Of what was held out; with the words about it they fill the width. The report says all of it."""


def write_held_out(path: Path, gain: Gain) -> None:
    """Residuals row by row at the left, their rms at the right."""
    with styled():
        figure = new_figure(8.0, 3.6, DPI)
        rows = figure.add_axes((0.095, 0.155, 0.51, 0.66))
        bars = figure.add_axes((0.715, 0.155, 0.265, 0.66))
        count = len(next(iter(gain.left.values())))
        step = max(1, -(-count // MOST_DRAWN_POINTS))
        for name, words, colour in BARS:
            values = gain.left[name]
            rows.plot(
                np.arange(1, count + 1)[::step], values[::step], "o", ms=2.8, mew=0, color=colour,
                alpha=0.7, label=words, rasterized=True,
            )  # fmt: skip
        high = 1.1 * max(float(np.quantile(np.abs(v), 0.998)) for v in gain.left.values())
        rows.set_ylim(-high, high)
        rows.set_xlim(0, count + 1)
        rows.axhline(0, color=MUTED, lw=0.8)
        rows.grid(axis="y")
        rows.set_xlabel("held-out row, in order")
        rows.set_ylabel(f"measured − predicted in {gain.unit}")
        names = ("as\ndesigned", "cali-\nbrated", "with\ncauses")
        before_and_after(bars, gain, names, noise_words(gain))
        bars.set_xlim(-0.5, 2.6)
        what = wrapped(left_out_words(gain.held_out), TITLE_LETTERS, lines=1)
        titled(figure, 0.945, f"Error on {what}, not used for fitting")
        figure.legend(
            *rows.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(0.085, 0.865), ncols=3,
            fontsize=9, markerscale=2.0, handletextpad=0.1, columnspacing=1.2,
        )  # fmt: skip
        save_png(figure, path)


def before_and_after(bars: Axes, gain: Gain, names: Sequence[str], noise: str) -> None:
    """Rms error of the simulation as designed, calibrated and with the causes; the noise as a dashed line."""
    sizes = (gain.rmse_before, gain.rmse_calibrated, gain.rmse_after)
    bars.bar(range(3), sizes, width=0.62, color=[c for _, _, c in BARS], edgecolor=INK, lw=0.6)
    for i, size in enumerate(sizes):
        bars.annotate(
            figures_text(size),
            (i, size),
            (0, 4),
            textcoords="offset points",
            ha="center",
            va="bottom",
        )
    bars.axhline(gain.noise_floor, color=INK, lw=1.2, ls=(0, (4, 3)))
    bars.set_xticks(range(3), names)
    bars.set_ylim(0, 1.18 * max(*sizes, gain.noise_floor))
    bars.set_ylabel(f"rms error in {gain.unit}")
    dashed = wrapped(f"dashed: {noise}, {figures_text(gain.noise_floor)}", 24)
    bars.set_title(dashed, fontsize=9, weight="normal", pad=6)
