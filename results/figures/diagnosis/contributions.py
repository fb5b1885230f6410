"""Contribution of each cause to the angle, over the channel in which it is clearest."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Effect
from flexspline.pipeline.diagnosis.causes.torque_offset import OFFSET
from flexspline.results.figures.diagnosis.contribution_parts import ContributionPanel, parts
from flexspline.results.figures.diagnosis.panels import DPI, FALLING, RISING, titled
from flexspline.results.figures.diagnosis.seen import SweepPictureData, thinned
from flexspline.results.figures.fitted_text import (
    angle_title,
    keep_inside,
    thin_labels,
    torque_title,
)
from flexspline.results.style import INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

YLABELS: Mapping[Effect, str] = {
    "angle": angle_title("added angle"),
    "gap": angle_title("added gap"),
    "compliance": f"{angle_title('added compliance')} per N·m".replace(" in ", "\nin "),
}
FAR_TORQUE_SHARE = 0.4
"""Share of the largest torque beyond which angle over torque is a compliance."""
PANEL, TOP, BOTTOM, BETWEEN = 1.75, 1.15, 0.6, 1.0
"""Inches, as in `panels`; wider apart, for each panel has a title and an axis of its own."""
LETTERS_BESIDE = 25
"""Letters of the magnitude that fit beside a panel in full size."""


def _size(line: str) -> float:
    """Points in which a bold line fits beside a panel."""
    return 10.5 * min(1.0, LETTERS_BESIDE / len(line))


def write_contributions(path: Path, shown: SweepPictureData) -> None:
    """One panel per part: pale, what was measured with all other parts taken off; dark, the model."""
    panels = parts(shown)
    height = TOP + len(panels) * PANEL + (len(panels) - 1) * BETWEEN + BOTTOM
    with styled():
        from matplotlib.lines import Line2D

        figure = new_figure(8.0, height, DPI)
        for i, part in enumerate(panels):
            low = BOTTOM + (len(panels) - 1 - i) * (PANEL + BETWEEN)
            axes = figure.add_axes((0.105, low / height, 0.565, PANEL / height))
            _panel(axes, shown, part)
            axes.set_title(part.title, fontsize=10.5, pad=7, x=0.0)
            for k, line in enumerate(part.lines):
                figure.text(
                    0.705, (low + PANEL - 0.2 - 0.27 * k) / height, line, va="center",
                    fontsize=_size(line) if k == 0 else 9.5, weight="bold" if k == 0 else "normal",
                    color=INK if k < 2 else MUTED,
                )  # fmt: skip
        titled(figure, 1 - 0.26 / height, "Contribution of each cause to the output angle")
        handles = [
            Line2D(
                [],
                [],
                color=RISING,
                marker="o",
                lw=0,
                ms=4,
                label="measured minus all other parts, torque rising",
            ),
            Line2D([], [], color=FALLING, marker="o", lw=0, ms=4, label="the same, torque falling"),
            Line2D([], [], color=INK, marker="o", lw=0, ms=3, label="model"),
        ]
        figure.legend(
            handles=handles, loc="center left", bbox_to_anchor=(0.025, 1 - 0.59 / height), ncols=3,
            fontsize=9, handletextpad=0.1, columnspacing=1.0, borderpad=0,
        )  # fmt: skip
        save_png(figure, path)


def _panel(axes: Axes, shown: SweepPictureData, part: ContributionPanel) -> None:
    if part.owner == OFFSET:
        _offset(axes, shown)
        return
    added, torque = shown.fit.added(part.owner), shown.history.torque_Nm
    factor, chosen = np.ones(len(torque)), shown.kept
    if part.view == "gap":
        factor = 2 * np.sign(torque)
    elif part.view == "compliance":
        chosen = chosen & (np.abs(torque) > FAR_TORQUE_SHARE * shown.largest_Nm)
        factor = 1 / np.where(chosen, torque, 1.0)
    model, measured = factor * added, factor * (added + shown.left)
    x = part.channel.values
    for rises, colour in ((True, RISING), (False, FALLING)):
        rows = thinned(chosen & (shown.rises == rises))
        axes.plot(
            x[rows], measured[rows], "o", ms=2.4, mew=0, color=colour, alpha=0.35, rasterized=True
        )
    rows = thinned(chosen)
    axes.plot(x[rows], model[rows], "o", ms=2.0, mew=0, color=INK, rasterized=True)
    low, high = np.quantile(measured[chosen], [0.002, 0.998])
    room = 0.1 * max(high - low, 1e-9)
    axes.set_ylim(low - room, high + room)
    axes.set_xlabel(part.channel.label)
    axes.set_ylabel(YLABELS[part.view], fontsize=9.5, labelpad=2)
    keep_inside(axes)
    axes.grid(True)
    if part.channel.levels:
        axes.set_xticks(range(len(part.channel.levels)), part.channel.levels)
        thin_labels(axes)
    elif part.channel.key == "cycle":
        from matplotlib.ticker import MaxNLocator

        axes.xaxis.set_major_locator(MaxNLocator(nbins="auto", integer=True))


def _offset(axes: Axes, shown: SweepPictureData) -> None:
    """Near zero torque: where the gap is crossed, by the reading and by the torque put right."""
    prepared = shown.explained.prepared
    read, history = prepared.sweep.history.torque_Nm, shown.history
    gap = shown.fit.measured_rig().gap_arcsec
    offset = shown.explained.offset_Nm
    angle = shown.left + history.sign * gap / 2
    reach = max(4 * abs(offset), 3 * prepared.band_Nm)
    rows = thinned((np.abs(read) < reach) & ~prepared.outlier)
    for rises, colour in ((True, RISING), (False, FALLING)):
        branch = rows[shown.rises[rows] == rises]
        axes.plot(read[branch], angle[branch], "o", ms=2.8, mew=0, color=colour, alpha=0.6)
    t = np.linspace(-reach, reach, 601)
    axes.plot(t, np.sign(t) * gap / 2, color=PALETTE[2], lw=1.2, ls=(0, (4, 3)))
    axes.plot(t, np.sign(t - offset) * gap / 2, color=INK, lw=1.4)
    axes.set_xlabel(f"{torque_title('torque reading')} (dashed: the gap if the reading were right)")
    axes.set_ylabel(angle_title("gap alone"))
    axes.grid(True)
