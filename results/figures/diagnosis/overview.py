"""Measurement and prediction: the torque-angle curve, and its difference from the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.results.diagnosis.data_used import kinds_left_out
from flexspline.results.figures.diagnosis.panels import DPI, FALLING, RISING, titled
from flexspline.results.figures.diagnosis.seen import SweepPictureData, thinned
from flexspline.results.figures.fitted_text import angle_title, keep_inside, torque_title
from flexspline.results.numbers import grouped
from flexspline.results.style import ACCENT, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from flexspline.pipeline.diagnosis.prediction import Prediction

DRAWN_TORQUE_RATIO = 1.04
"""Torque at the panels' ends over the largest that was measured: its marks are whole."""


def write_overview(path: Path, shown: SweepPictureData) -> None:
    """Two panels over the output's torque: angle, and measured less simulated."""
    prediction, torque = shown.diagnosis.prediction, shown.output_Nm
    inside = ~shown.kept
    model = shown.nominal - shown.left
    with styled():
        figure = new_figure(8.0, 5.4, DPI)
        above = figure.add_axes((0.095, 0.43, 0.875, 0.39))
        below = figure.add_axes((0.095, 0.104, 0.875, 0.295))
        angle = prediction.angle_arcsec(replace(shown.history, torque_Nm=torque)) + shown.nominal
        end_Nm = DRAWN_TORQUE_RATIO * shown.largest_Nm
        _simulation(above, below, prediction, end_Nm)
        for rises, colour, words in ((True, RISING, "rising"), (False, FALLING, "falling")):
            rows = thinned((shown.rises == rises) & ~inside)
            for axes, values in ((above, angle), (below, shown.nominal)):
                axes.plot(
                    torque[rows], values[rows], "o", ms=2.6, mew=0, color=colour, alpha=0.55,
                    rasterized=True, label=f"measured, torque {words}",
                )  # fmt: skip
        rows = thinned(shown.kept)
        if shown.analysis.causes:
            below.plot(
                torque[rows], model[rows], ".", ms=2.0, mew=0, color=INK, label="extended model",
                rasterized=True,
            )  # fmt: skip
        crossing, not_used = thinned(inside), _not_used(shown)
        for axes, values in ((above, angle), (below, shown.nominal)):
            axes.plot(
                torque[crossing], values[crossing], "x", ms=3.2, mew=0.8, color=ACCENT, alpha=0.7,
                label=not_used if len(crossing) else None,
            )  # fmt: skip
            axes.axvline(0, color=MUTED, lw=0.6)
            axes.grid(True)
            axes.set_xlim(-end_Nm, end_Nm)
        high = 1.12 * float(np.quantile(np.abs(shown.nominal[shown.kept]), 0.999))
        below.set_ylim(-high, high)
        above.tick_params(labelbottom=False)
        above.set_ylabel(angle_title("output angle"))
        below.set_ylabel(angle_title("difference"))
        below.set_xlabel(torque_title("output torque"))
        titled(figure, 0.955, "Measured and simulated angle, wave generator locked")
        named = dict(zip(*reversed(above.get_legend_handles_labels()), strict=True))
        named |= dict(zip(*reversed(below.get_legend_handles_labels()), strict=True))
        crosses = named.pop(not_used, None)
        _legend(figure, 0.893, named)
        if crosses is not None:
            _legend(figure, 0.842, {not_used: crosses})
        for axes in (above, below):
            keep_inside(axes)
        save_png(figure, path)


def _simulation(above: Axes, below: Axes, prediction: Prediction, end_Nm: float) -> None:
    """The simulated curve with its stated uncertainty, and that as a difference from itself."""
    for sign in (-1.0, 1.0):
        t = sign * np.linspace(1e-9, end_Nm, 50)
        line = prediction.compliance * t + sign * prediction.gap_arcsec / 2
        if prediction.bend is not None:
            line += prediction.bend.at(t)
        spread = np.hypot(prediction.gap_std_arcsec / 2, prediction.compliance_std * t)
        first = sign > 0
        above.fill_between(
            t, line - spread, line + spread, color=PALETTE[0], alpha=0.13, lw=0,
            label="simulation's stated uncertainty, 1σ" if first and spread.any() else None,
        )  # fmt: skip
        above.plot(t, line, color=PALETTE[0], lw=1.6, label="simulation" if first else None)
        below.fill_between(t, -spread, spread, color=PALETTE[0], alpha=0.13, lw=0)
    below.axhline(0, color=PALETTE[0], lw=1.6)


def _not_used(shown: SweepPictureData) -> str:
    """Why the crossed rows were not used, and how many each reason has."""
    kinds = kinds_left_out(shown.explained.prepared.row_counts)
    return "not used: " + ", ".join(f"{words} ({grouped(count, 0)})" for words, count in kinds)


def _legend(figure: Figure, y: float, named: Mapping[str, Artist]) -> None:
    figure.legend(
        named.values(), named.keys(), loc="center left", bbox_to_anchor=(0.085, y), ncols=3,
        fontsize=9, markerscale=2.0, columnspacing=1.3, borderpad=0,
    )  # fmt: skip
