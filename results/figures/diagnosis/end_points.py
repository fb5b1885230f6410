"""End points: every unit compared with the predicted envelope, and the positions of its ends."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.pipeline.diagnosis.end_points.envelope import COVERED_WORDS
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis, UnitFinding
from flexspline.results.figures.diagnosis.panels import DPI, titled
from flexspline.results.figures.diagnosis.seen import plain_names
from flexspline.results.figures.fitted_text import angle_title, fit, keep_inside
from flexspline.results.numbers import signed
from flexspline.results.style import ACCENT, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_UNITS = 30
"""Units drawn, a figure of 14 inches; of more, those furthest out."""
ROW = 0.42
"""Inches of a row of bars."""
TITLE = "Lost motion of each unit against the prediction"
TITLE_OF_SEVERAL = "Lost motion of each unit at the torque of its largest deviation"
"""Where units were measured at several torques: one torque of each unit is drawn."""


def shown_units(analysis: EndPointAnalysis) -> list[UnitFinding]:
    """In the file's order; of very many, those furthest out."""
    units = list(analysis.units)
    if len(units) <= MOST_UNITS:
        return units
    worst = sorted(units, key=lambda u: u.p_value)[:MOST_UNITS]
    return [u for u in units if u in worst]


@contextmanager
def _unit_rows(
    path: Path, labels: Sequence[str], title: str, x_title: str, marker_scale: float = 1.0
) -> Iterator[Axes]:
    """A picture with a row for each unit, written where the block ends; right of the axes there is room."""
    height = 1.55 + ROW * len(labels)
    with styled():
        figure = new_figure(8.0, height, DPI)
        axes = figure.add_axes((0.13, 0.6 / height, 0.61, ROW * len(labels) / height))
        yield axes
        axes.set_ylim(len(labels) - 0.5, -0.5)
        axes.set_yticks(range(len(labels)), labels)
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="x")
        axes.set_xlabel(angle_title(x_title))
        keep_inside(axes)
        titled(figure, 1 - 0.28 / height, title)
        figure.legend(
            loc="center left", bbox_to_anchor=(0.025, 1 - 0.64 / height), ncols=4, fontsize=9,
            columnspacing=1.3, handlelength=1.5, handletextpad=0.5, borderpad=0, markerscale=marker_scale,
        )  # fmt: skip
        save_png(figure, path)


def write_envelope(path: Path, analysis: EndPointAnalysis) -> None:
    """Lost motion of each unit, and what a good unit may show."""
    units = shown_units(analysis)
    names = plain_names(tuple(u.unit for u in units))
    torques = len(analysis.envelopes) > 1
    labels = [
        f"unit {n}" + (f", ± {u.torque_Nm:g} N·m" if torques else "")
        for n, u in zip(names, units, strict=True)
    ]
    title = TITLE_OF_SEVERAL if torques else TITLE
    with _unit_rows(path, labels, title, "angle between −T and +T", 0.8) as axes:
        ends, annotations = [], []
        for row, unit in enumerate(units):
            envelope = analysis.envelope_at(unit.torque_Nm)
            low, high = envelope.interval_arcsec
            first = row == 0
            axes.barh(
                row, high - low, left=low, height=0.66, color=PALETTE[0], alpha=0.15, lw=0,
                label=f"{COVERED_WORDS} good units" if first else None,
            )  # fmt: skip
            axes.plot(
                [envelope.total_arcsec] * 2, [row - 0.33, row + 0.33], color=PALETTE[0], lw=2,
                label="simulation" if first else None,
            )  # fmt: skip
            limit = envelope.limit_arcsec()
            if np.isfinite(limit):
                axes.plot(
                    [limit] * 2, [row - 0.33, row + 0.33], color=MUTED, lw=1.4, ls=(0, (2, 1.5)),
                    label="largest angle from clearance" if first else None,
                )  # fmt: skip
                ends.append(limit)
            colour = INK if unit.within else ACCENT
            axes.plot(
                unit.total_arcsec, row, "o", ms=7, color=colour, zorder=4,
                label="measured" if first else None,
            )  # fmt: skip
            ends += [low, high, unit.total_arcsec]
            words = "within" if unit.within else "beyond"
            annotations.append(axes.annotate(
                f"{unit.total_arcsec:.1f} arcsec, {words} ({signed(unit.z, 1)} σ)",
                (1.02, row), xycoords=("axes fraction", "data"), va="center", fontsize=9.5,
                color=colour, weight="normal" if unit.within else "bold", annotation_clip=False,
            ))  # fmt: skip
        fit(annotations, 0.235 * axes.figure.bbox.width)
        room = 0.06 * (max(ends) - min(ends) + 1e-9)
        axes.set_xlim(min(ends) - room, max(ends) + room)


def write_positions(path: Path, analysis: EndPointAnalysis) -> None:
    """Where each unit's two ends lie, and its middle."""
    units = shown_units(analysis)
    labels = [f"unit {n}" for n in plain_names(tuple(u.unit for u in units))]
    reach = analysis.mids.asymmetry_reach_arcsec
    with _unit_rows(path, labels, "Positions of both ends of each unit", "measured angle") as axes:
        axes.axvspan(
            -reach,
            reach,
            color=PALETTE[2],
            alpha=0.25,
            lw=0,
            label="largest effect of a stiffer direction",
        )
        axes.axvline(0, color=MUTED, lw=0.8)
        for row, unit in enumerate(units):
            half, first = unit.total_arcsec / 2, row == 0
            expected = unit.predicted_arcsec / 2
            axes.plot(
                [-expected, expected], [row - 0.22] * 2, color=PALETTE[0], lw=2.2, alpha=0.55,
                label="simulation" if first else None,
            )  # fmt: skip
            axes.plot(
                [unit.mid_arcsec - half, unit.mid_arcsec + half], [row + 0.08] * 2, "|-", color=INK, lw=1.6,
                ms=9, mew=1.6, label="measured, −T to +T" if first else None,
            )  # fmt: skip
            axes.plot(
                unit.mid_arcsec, row + 0.08, "o", color=INK, ms=5, label="middle" if first else None
            )
            axes.annotate(
                f"middle {signed(unit.mid_arcsec, 1)} arcsec", (1.02, row),
                xycoords=("axes fraction", "data"), va="center", fontsize=9.5, annotation_clip=False,
            )  # fmt: skip
