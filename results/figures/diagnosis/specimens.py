"""Specimens: measured stiffness against FE, by specimen and by every dimension that varies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.schema import key_words
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.results.figures.diagnosis.panels import BETWEEN, BOTTOM, DPI, PANEL, TOP
from flexspline.results.figures.diagnosis.seen import plain_names
from flexspline.results.numbers import figures_text
from flexspline.results.style import INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_NAMES = 24
"""Names below an axis of 7 inches, 0.29 inch each; of more, every k-th is written."""


def write_stiffness(path: Path, found: SpecimenAnalysis) -> None:
    """Measured over simulated stiffness of each specimen, with the calibrated and the chosen model."""
    n = len(found.measured)
    x = np.arange(n)
    with styled():
        figure = new_figure(8.0, 3.7, DPI)
        axes = figure.add_axes((0.095, 0.185, 0.875, 0.62))
        axes.axhline(0, color=PALETTE[0], lw=1.6, label="simulation")
        axes.plot(
            x, _pct(found.calibrated, found), "_", ms=16, mew=2.0, color=PALETTE[1],
            label="modulus fitted",
        )  # fmt: skip
        if found.chosen.terms:
            axes.plot(
                x, _pct(found.explained, found), "D", ms=6, mfc="none", mec=PALETTE[2], mew=1.8,
                label="with what was found",
            )  # fmt: skip
        axes.errorbar(
            x, _pct(found.measured, found), yerr=100 * found.noise * found.measured / found.simulated,
            fmt="o", ms=5, color=INK, capsize=3, lw=1.2, label="measured, ± 1σ",
        )  # fmt: skip
        names = plain_names(found.specimen)
        step = -(-n // MOST_NAMES)
        long = max(map(len, names)) * n > 90
        axes.set_xticks(
            x[::step], names[::step], rotation=40 if long else 0, ha="right" if long else "center"
        )
        axes.grid(axis="y")
        axes.set_xlabel("specimen")
        axes.set_ylabel("stiffness over simulated, %")
        figure.text(
            0.035,
            0.945,
            "Measured stiffness against the simulation",
            fontsize=12,
            weight="bold",
            va="center",
        )
        figure.legend(
            loc="center left", bbox_to_anchor=(0.025, 0.865), ncols=4, fontsize=9, columnspacing=1.3,
            handletextpad=0.5, borderpad=0,
        )  # fmt: skip
        save_png(figure, path)


def write_dimensions(path: Path, found: SpecimenAnalysis, overrides: dict[str, np.ndarray]) -> None:
    """Residual of the simulation and of the chosen model against every dimension that varies."""
    varying = {k: v for k, v in overrides.items() if np.ptp(v) > 0}
    rows = -(-len(varying) // 2)
    height = TOP + rows * PANEL + (rows - 1) * BETWEEN + BOTTOM
    measured, explained = _pct(found.measured, found), _pct(found.explained, found)
    with styled():
        figure = new_figure(8.0, height, DPI)
        for i, (key, values) in enumerate(varying.items()):
            row, column = divmod(i, 2)
            axes = figure.add_axes((
                0.095 + 0.475 * column,
                (BOTTOM + (rows - 1 - row) * (PANEL + BETWEEN)) / height,
                0.875 if len(varying) == 1 else 0.40,
                PANEL / height,
            ))  # fmt: skip
            _against(axes, values, measured, explained, 100 * found.noise, bool(found.chosen.terms))
            axes.set_xlabel(_label(key))
            axes.set_ylabel("over simulated, %" if column == 0 else "")
        figure.text(
            0.035, 1 - 0.28 / height, "Measured less simulated, against every dimension", fontsize=12,
            weight="bold", va="center",
        )  # fmt: skip
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="center left", bbox_to_anchor=(0.025, 1 - 0.62 / height), ncols=3,
            fontsize=9, columnspacing=1.3, handletextpad=0.5, borderpad=0,
        )  # fmt: skip
        save_png(figure, path)


def write_held_out_specimens(path: Path, found: SpecimenAnalysis, gain: Gain) -> None:
    """Each specimen predicted from the others: before and after."""
    n = len(found.held_out)
    with styled():
        figure = new_figure(8.0, 3.6, DPI)
        axes = figure.add_axes((0.095, 0.185, 0.51, 0.62))
        bars = figure.add_axes((0.715, 0.185, 0.265, 0.62))
        x = np.arange(n)
        noise = 100 * rms(found.noise)
        axes.axhspan(-2 * noise, 2 * noise, color="#e4e7ea", lw=0, label="noise ± 2σ")
        axes.axhline(0, color=MUTED, lw=0.8)
        for values, words, colour in (
            (found.held_out_before, "simulation as it stands", PALETTE[2]),
            (found.held_out, "with what was found", PALETTE[0]),
        ):
            axes.plot(x, 100 * values, "o", ms=5.5, color=colour, label=words)
        names = plain_names(found.specimen)
        step = -(-n // 12)
        axes.set_xticks(x[::step], names[::step], rotation=40 if max(map(len, names)) > 4 else 0)
        axes.set_xlabel("specimen, predicted from all others")
        axes.set_ylabel("error of 1/stiffness, %")
        axes.grid(axis="y")
        sizes = [gain.rmse_before, gain.rmse_calibrated, gain.rmse_after]
        bars.bar(
            range(3),
            sizes,
            width=0.62,
            color=[PALETTE[2], PALETTE[1], PALETTE[0]],
            edgecolor=INK,
            lw=0.6,
        )
        for i, size in enumerate(sizes):
            bars.annotate(
                figures_text(size), (i, size), (0, 4), textcoords="offset points", ha="center"
            )
        bars.axhline(gain.noise_floor, color=INK, lw=1.2, ls=(0, (4, 3)))
        bars.set_title(
            f"dashed: noise, {figures_text(gain.noise_floor)}", fontsize=9, weight="normal", pad=6
        )
        bars.set_xticks(range(3), ["as it\nstands", "modulus\nfitted", "with what\nwas found"])
        bars.set_ylim(0, 1.18 * max(*sizes, gain.noise_floor))
        bars.set_ylabel(f"rms error, {gain.unit}")
        figure.text(
            0.035,
            0.945,
            "Error on specimens not used for fitting",
            fontsize=12,
            weight="bold",
            va="center",
        )
        figure.legend(
            *axes.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(0.085, 0.865), ncols=3,
            fontsize=9, handletextpad=0.4, columnspacing=1.2,
        )  # fmt: skip
        save_png(figure, path)


def _against(
    axes: Axes,
    x: np.ndarray,
    measured: np.ndarray,
    explained: np.ndarray,
    noise: np.ndarray,
    found: bool,
) -> None:
    axes.axhline(0, color=PALETTE[0], lw=1.6, label="simulation")
    if found:
        axes.plot(
            x,
            explained,
            "D",
            ms=6,
            mfc="none",
            mec=PALETTE[2],
            mew=1.8,
            label="with what was found",
        )
    axes.errorbar(
        x, measured, yerr=noise, fmt="o", ms=5, color=INK, capsize=3, lw=1.2, label="measured, ± 1σ"
    )
    axes.grid(axis="y")


def _pct(stiffness: np.ndarray, found: SpecimenAnalysis) -> np.ndarray:
    return 100 * (stiffness / found.simulated - 1)


def _label(key: str) -> str:
    """``flexspline.wall_thickness_mm`` → flexspline wall thickness in mm."""
    words, unit = key_words(key)
    return (f"{words} in {unit}" if unit else words).replace("$", r"\$")
