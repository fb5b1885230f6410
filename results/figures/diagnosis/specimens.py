"""Specimens: measured stiffness compared with FE, by specimen and by every dimension that varies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.schema import key_words
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.results.figures.diagnosis.held_out import before_and_after
from flexspline.results.figures.diagnosis.panels import DPI, panel_legend, panel_sheet, titled
from flexspline.results.figures.diagnosis.seen import plain_names
from flexspline.results.style import GRID, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_NAMES = 24
"""Names below an axis of 7 inches, 0.29 inch each; of more, every k-th is written."""


def write_stiffness(path: Path, analysis: SpecimenAnalysis) -> None:
    """Measured over simulated stiffness of each specimen, with the calibrated and the chosen model."""
    n = len(analysis.measured)
    x = np.arange(n)
    with styled():
        figure = new_figure(8.0, 3.7, DPI)
        axes = figure.add_axes((0.095, 0.185, 0.875, 0.62))
        axes.plot(
            x, _pct(analysis.calibrated, analysis), "_", ms=16, mew=2.0, color=PALETTE[1],
            label="modulus fitted",
        )  # fmt: skip
        noise = 100 * analysis.noise * analysis.measured / analysis.simulated
        _against(axes, x, analysis, noise)
        names = plain_names(analysis.specimen)
        step = -(-n // MOST_NAMES)
        long = max(map(len, names)) * n > 90
        axes.set_xticks(
            x[::step], names[::step], rotation=40 if long else 0, ha="right" if long else "center"
        )
        axes.set_xlabel("specimen")
        axes.set_ylabel("difference from simulation in %")
        titled(figure, 0.945, "Measured stiffness against the simulation")
        figure.legend(
            loc="center left", bbox_to_anchor=(0.025, 0.865), ncols=4, fontsize=9, columnspacing=1.3,
            handletextpad=0.5, borderpad=0,
        )  # fmt: skip
        save_png(figure, path)


def write_dimensions(
    path: Path, analysis: SpecimenAnalysis, overrides: dict[str, np.ndarray]
) -> None:
    """Residual of the simulation and of the chosen model against every dimension that varies."""
    varying = {k: v for k, v in overrides.items() if np.ptp(v) > 0}
    with styled():
        title = "Measured minus simulated, over every dimension"
        figure, panels = panel_sheet(len(varying), title, "difference, %")
        for axes, (key, values) in zip(panels, varying.items(), strict=True):
            _against(axes, values, analysis, 100 * analysis.noise)
            axes.set_xlabel(_label(key))
        panel_legend(figure, panels[0].get_legend_handles_labels()[0])
        save_png(figure, path)


def write_held_out_specimens(path: Path, analysis: SpecimenAnalysis, gain: Gain) -> None:
    """Each specimen predicted from the others: before and after."""
    n = len(analysis.held_out)
    with styled():
        figure = new_figure(8.0, 3.6, DPI)
        axes = figure.add_axes((0.095, 0.185, 0.51, 0.62))
        bars = figure.add_axes((0.715, 0.185, 0.265, 0.62))
        x = np.arange(n)
        noise = 100 * rms(analysis.noise)
        axes.axhspan(-2 * noise, 2 * noise, color=GRID, lw=0, label="noise ± 2σ")
        axes.axhline(0, color=MUTED, lw=0.8)
        for values, words, colour in (
            (analysis.held_out_before, "simulation as designed", PALETTE[2]),
            (analysis.held_out, "with the causes", PALETTE[0]),
        ):
            axes.plot(x, 100 * values, "o", ms=5.5, color=colour, label=words)
        names = plain_names(analysis.specimen)
        step = -(-n // 12)
        axes.set_xticks(x[::step], names[::step], rotation=40 if max(map(len, names)) > 4 else 0)
        axes.set_xlabel("specimen, predicted from all others")
        axes.set_ylabel("error of 1/stiffness in %")
        axes.grid(axis="y")
        names = ("as\ndesigned", "modulus\nfitted", "with\ncauses")
        before_and_after(bars, gain, names, "noise")
        titled(figure, 0.945, "Error on specimens not used for fitting")
        figure.legend(
            *axes.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(0.085, 0.865), ncols=3,
            fontsize=9, handletextpad=0.4, columnspacing=1.2,
        )  # fmt: skip
        save_png(figure, path)


def _against(axes: Axes, x: np.ndarray, analysis: SpecimenAnalysis, noise_pct: np.ndarray) -> None:
    """Simulation, chosen model and measurement over x."""
    axes.axhline(0, color=PALETTE[0], lw=1.6, label="simulation")
    if analysis.chosen.terms:
        axes.plot(
            x, _pct(analysis.explained, analysis), "D", ms=6, mfc="none", mec=PALETTE[2], mew=1.8,
            label="with the causes",
        )  # fmt: skip
    axes.errorbar(
        x, _pct(analysis.measured, analysis), yerr=noise_pct, fmt="o", ms=5, color=INK, capsize=3, lw=1.2,
        label="measured, ± 1σ",
    )  # fmt: skip
    axes.grid(axis="y")


def _pct(stiffness: np.ndarray, analysis: SpecimenAnalysis) -> np.ndarray:
    return 100 * (stiffness / analysis.simulated - 1)


def _label(key: str) -> str:
    """``flexspline.wall_thickness_mm`` → flexspline wall thickness in mm."""
    words, unit = key_words(key)
    return (f"{words} in {unit}" if unit else words).replace("$", r"\$")
