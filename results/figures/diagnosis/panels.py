"""Residual over every channel, one panel each, with separate marks for loading and unloading."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.results.figures.diagnosis.seen import PlotChannel, SweepPictureData, thinned
from flexspline.results.figures.fitted_text import angle_title, thin_labels
from flexspline.results.style import GRID, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

RISING, FALLING = PALETTE[1], PALETTE[2]
"""Colours of the two branches."""
DPI = 150
"""Dots per inch: a line of 1.6 points is 3 dots."""
WIDTH = 8.0
"""Inches, of all figures of a diagnosis."""
PANEL, TOP, BOTTOM, BETWEEN = 1.8, 0.95, 0.62, 0.72
"""Inches: height of a panel; above all, below all, and between rows of panels."""
MOST_REACH = 4.0
"""Times what 19 of 20 rows reach, at which a panel ends: a few rows far off, which stand at its edge, would
flatten all the others."""
BINS = 14
"""Of a mean line over a panel of 3.2 inches: a quarter of an inch each."""
FEWEST_OF_MEAN = 4
"""Values of which a mean is drawn: it scatters half as much as they."""
LEVELS = 16
"""Distinct values up to which a channel is drawn level by level: as many as bins, about."""
DODGE = 0.012
"""Share of a channel's range by which the branches stand apart where it has levels."""
APART = " (branches apart)"
"""Beside the name of such a channel; the caption says which branch goes where."""
CLUSTER_GAP_SHARE = 0.04
"""Share of a channel's range that, empty, parts clusters."""


def write_channels(
    path: Path,
    shown: SweepPictureData,
    left_arcsec: np.ndarray,
    title: str,
    results: Mapping[str, str] | None = None,
) -> None:
    """Write the panels.

    Parameters
    ----------
    left_arcsec : (n,) what is drawn. told : a word for a channel's panel, by its key.
    """
    high = _reach(shown, left_arcsec)
    with styled():
        figure, panels = panel_sheet(len(shown.channels), title, angle_title("residual"))
        for axes, channel in zip(panels, shown.channels, strict=True):
            _panel(axes, shown, channel, left_arcsec, high)
            if results and channel.key in results:
                axes.text(
                    0.985, 0.03, results[channel.key], transform=axes.transAxes, ha="right", va="bottom",
                    fontsize=9, color=INK,
                    bbox={"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 1.5},
                )  # fmt: skip
        _branch_legend(figure, shown)
        save_png(figure, path)


def titled(figure: Figure, y: float, title: str) -> None:
    """Write a picture's title at its left, at a share of its height."""
    figure.text(0.035, y, title, fontsize=12, weight="bold", va="center")


def panel_sheet(count: int, title: str, ylabel: str) -> tuple[Figure, list[Axes]]:
    """A titled figure and its panels, two in a row, with room for a legend above."""
    rows = -(-count // 2)
    height = TOP + rows * PANEL + (rows - 1) * BETWEEN + BOTTOM
    figure, panels = new_figure(WIDTH, height, DPI), []
    for i in range(count):
        row, column = divmod(i, 2)
        axes = figure.add_axes((
            0.095 + 0.475 * column,
            (BOTTOM + (rows - 1 - row) * (PANEL + BETWEEN)) / height,
            0.875 if count == 1 else 0.40,
            PANEL / height,
        ))  # fmt: skip
        axes.set_ylabel(ylabel if column == 0 else "")
        panels.append(axes)
    titled(figure, 1 - 0.28 / height, title)
    return figure, panels


def panel_legend(figure: Figure, handles: Sequence[Artist], **more: Any) -> None:
    """One legend in a row for all panels, below the title."""
    y = 1 - 0.62 / figure.get_figheight()
    figure.legend(
        handles=handles, loc="center left", bbox_to_anchor=(0.025, y), ncols=len(handles),
        fontsize=9, columnspacing=1.3, handletextpad=0.5, borderpad=0, **more,
    )  # fmt: skip


def _branch_legend(figure: Figure, shown: SweepPictureData) -> None:
    """Branches, sides of the gap, noise."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Line2D | Patch] = [
        Line2D([], [], color=RISING, marker="o", ms=4, lw=1.8, label="torque rising"),
        Line2D([], [], color=FALLING, marker="o", ms=4, lw=1.8, label="torque falling"),
    ]
    if len(shown.channels) > 1:
        handles += [
            Line2D([], [], color=MUTED, lw=1.8, label="mean, T > 0"),
            Line2D([], [], color=MUTED, lw=1.8, ls=(0, (2.5, 1.5)), label="mean, T < 0"),
        ]
    noise = f"noise of all rows used:\n± 2σ, σ = {shown.noise_arcsec:.2g} arcsec"
    handles.append(Patch(color=GRID, label=noise))
    panel_legend(figure, handles, handlelength=1.7)


def _panel(
    axes: Axes, shown: SweepPictureData, channel: PlotChannel, left: np.ndarray, high: float
) -> None:
    noise = 2 * shown.noise_arcsec
    axes.axhspan(-noise, noise, color=GRID, lw=0, zorder=0)
    axes.axhline(0, color=MUTED, lw=0.8)
    values = channel.values
    levels = np.unique(values)
    few = len(levels) <= LEVELS
    step = float(np.diff(levels).min()) if few and len(levels) > 1 else 0.0
    for rises, colour, side in ((True, RISING, -1), (False, FALLING, 1)):
        rows = thinned(shown.kept & (shown.rises == rises))
        moved = side * max(0.12 * step, DODGE * np.ptp(levels)) if step else 0.0
        moved = 0.0 if channel.key == "torque_Nm" else moved
        axes.plot(
            values[rows] + moved, np.clip(left[rows], -high, high), "o", ms=2.2, mew=0, color=colour,
            alpha=0.35, rasterized=True, clip_on=False,
        )  # fmt: skip
        for sign, x, y in _lines(shown, channel, left, rises):
            style = "-" if sign > 0 or channel.key == "torque_Nm" else (0, (2.5, 1.5))
            axes.plot(x + moved, y, color=colour, lw=1.8, ls=style)
    axes.set_ylim(-high, high)
    # values that no row has would be read off the axis, where nothing says that points were moved
    axes.set_xlabel(f"{channel.label}{APART * bool(moved)}")
    axes.grid(axis="y")
    if channel.levels:
        axes.set_xticks(range(len(channel.levels)), channel.levels)
    elif channel.key == "cycle" and few:
        axes.set_xticks(levels)
    if step and channel.key != "torque_Nm":
        axes.set_xlim(levels[0] - 0.5 * step, levels[-1] + 0.5 * step)
    if channel.levels:
        thin_labels(axes)


def means(x: np.ndarray, y: np.ndarray, few: bool) -> tuple[np.ndarray, np.ndarray]:
    """Mean of y in bins of x: levels or clusters where they are few, else bins of equal count.

    Single values, far from the next where a channel is thinly covered, are no clusters.
    """
    if len(x) < FEWEST_OF_MEAN:
        return np.empty(0), np.empty(0)
    sorted_x = np.sort(x)
    gaps = np.flatnonzero(np.diff(sorted_x) > CLUSTER_GAP_SHARE * np.ptp(x))
    if few:
        where, codes = np.unique(x, return_inverse=True)
    elif 1 < len(gaps) < LEVELS and _sizes(gaps, len(x)).min() >= FEWEST_OF_MEAN:
        # a bin across a gap would put its mean where nothing was measured
        where = np.arange(len(gaps) + 1, dtype=float)
        codes = np.searchsorted((sorted_x[gaps] + sorted_x[gaps + 1]) / 2, x)
    else:
        edges = np.unique(np.quantile(x, np.linspace(0, 1, BINS + 1)[1:-1]))
        codes = np.searchsorted(edges, x, side="right")
        where = np.arange(codes.max() + 1, dtype=float)
    count = np.bincount(codes, minlength=len(where))
    good = count >= (1 if few else FEWEST_OF_MEAN)
    mean_x = np.bincount(codes, x, len(where)) / np.maximum(count, 1)
    mean_y = np.bincount(codes, y, len(where)) / np.maximum(count, 1)
    return mean_x[good], mean_y[good]


def _sizes(gaps: np.ndarray, count: int) -> np.ndarray:
    """How many of so many values lie between two gaps each."""
    return np.diff(gaps, prepend=-1, append=count - 1)


def _reach(shown: SweepPictureData, left: np.ndarray) -> float:
    most, all_but_few = np.quantile(np.abs(left[shown.kept]), [0.95, 0.998])
    points = max(min(all_but_few, MOST_REACH * most), 3 * shown.noise_arcsec)
    lines = [
        np.abs(y).max(initial=0.0)
        for channel in shown.channels
        for rises in (True, False)
        for _, _, y in _lines(shown, channel, left, rises)
    ]
    return 1.15 * float(max(points, *lines))


def _lines(
    shown: SweepPictureData, channel: PlotChannel, left: np.ndarray, rises: bool
) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """Sign of the torque, and the mean line over the channel, of a branch's two halves."""
    few = len(np.unique(channel.values)) <= LEVELS
    for sign in (1, -1):
        half = shown.kept & (shown.rises == rises) & (np.sign(shown.history.torque_Nm) == sign)
        yield sign, *means(channel.values[half], left[half], few)
