"""End points: possible explanations, and measurements that would distinguish them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.end_points.race import Hypothesis
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.words import title_of
from flexspline.results.figures.diagnosis.panels import DPI, titled
from flexspline.results.figures.diagnosis.seen import plain_names
from flexspline.results.figures.fitted_text import fit, wrapped
from flexspline.results.numbers import figures_text
from flexspline.results.style import INK, LIGHT, PALETTE, new_figure, save_png, styled

MOST_RIVALS = 8
"""Explanations drawn: with all plans and at most 0.5 inch a row, 7.6 inches; the shares are of those."""
SMALLEST_SHARE = 0.005
"""Share of the odds below which an explanation is left out: it would read 0 %."""
FEWEST_RIVALS = 2
"""Explanations drawn however small their shares: one alone has nothing beside it."""
LABEL_SHARE = 0.44
"""Of the figure's width, left of the bars."""
ROW, ROW_OF_THREE_LINES = 0.36, 0.5
"""Inches of a row: of at most two lines of 9.5 points (0.15 inch each), and of three."""
LABEL_LETTERS, LABEL_LINES = 44, 3
"""Letters of a line beside the bars, where 3.5 inches are free; two causes and a unit take three lines."""
MOST_PLANS = 4
"""Further measurements drawn: all that are compared."""
UNNAMED_CURVE = "an unnamed curve over torque"


def write_rivals(path: Path, analysis: EndPointAnalysis) -> None:
    """What each explanation has for it, and what further measurements would tell."""
    ranked, share = _shown(analysis.hypotheses)
    names = plain_names(tuple(u.unit for u in analysis.units))
    plans = analysis.plans[:MOST_PLANS]
    labels = [wrapped(_words(h, names), LABEL_LETTERS, LABEL_LINES) for h in ranked]
    row_in = ROW if max(t.count("\n") for t in labels) < 2 else ROW_OF_THREE_LINES
    height = 1.45 + row_in * len(ranked) + (ROW * (len(plans) + 1.9) if plans else 0)
    with styled():
        figure = new_figure(8.0, height, DPI)
        top = 0.5
        axes = figure.add_axes((
            0.47, 1 - (top + row_in * len(ranked)) / height, 0.43, row_in * len(ranked) / height
        ))  # fmt: skip
        axes.barh(
            range(len(ranked)), 100 * share, height=0.6,
            color=[PALETTE[1] if h.causes else LIGHT for h in ranked], edgecolor=INK, lw=0.6,
        )  # fmt: skip
        for row, value in enumerate(share):
            axes.annotate(
                f"{100 * value:.0f} %", (100 * value, row), (5, 0), textcoords="offset points", va="center",
                fontsize=9.5,
            )  # fmt: skip
        axes.set_yticks(range(len(ranked)), labels, fontsize=9.5)
        fit(axes.get_yticklabels(), LABEL_SHARE * figure.bbox.width)
        _bare(axes, len(ranked))
        axes.set_xlabel("share of the odds of the causes shown, in %", fontsize=9.5)
        axes.set_xlim(0, 118 * share.max())
        titled(figure, 1 - 0.26 / height, "Possible causes")
        if plans:
            low = figure.add_axes((0.47, 0.55 / height, 0.43, ROW * len(plans) / height))
            sizes = [p.separation for p in plans]
            low.barh(range(len(plans)), sizes, height=0.6, color=PALETTE[2], edgecolor=INK, lw=0.6)
            for row, size in enumerate(sizes):
                low.annotate(
                    figures_text(size, 2), (size, row), (5, 0), textcoords="offset points", va="center",
                    fontsize=9.5,
                )  # fmt: skip
            low.set_yticks(range(len(plans)), [_plan(p.vary) for p in plans], fontsize=9.5)
            _bare(low, len(plans))
            low.set_xlim(0, 1.18 * max(*sizes, 1e-9))
            low.set_xlabel(
                "smallest difference between two rivals, as multiple of the noise", fontsize=9.5
            )
            titled(
                figure,
                (0.55 + ROW * len(plans) + 0.22) / height,
                "Measurements that distinguish them",
            )
        save_png(figure, path)


def _shown(hypotheses: Sequence[Hypothesis]) -> tuple[list[Hypothesis], np.ndarray]:
    """Those that are drawn, the likeliest first, and the share of each."""
    ranked = sorted(hypotheses, key=lambda h: -h.score)[:MOST_RIVALS]
    odds = np.exp(np.array([h.score for h in ranked]) - ranked[0].score)
    count = max(int((odds / odds.sum() >= SMALLEST_SHARE).sum()), FEWEST_RIVALS)
    return ranked[:count], odds[:count] / odds[:count].sum()


def _bare(axes, rows: int) -> None:  # type: ignore[no-untyped-def]
    axes.set_ylim(rows - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x")


def _words(hypothesis: Hypothesis, names: tuple[str, ...]) -> str:
    if not hypothesis.causes:
        return "the simulation, within its uncertainty"
    titles = [
        UNNAMED_CURVE if c.startswith("?") else title_of(c).partition(" (")[0]
        for c in hypothesis.causes
    ]
    text = joined(titles, "and")
    return text if hypothesis.own is None else f"{text}, unit {names[hypothesis.own]}"


def _plan(vary: str) -> str:
    return {
        "repeat": "the same end points again",
        "torque_Nm": "end points at other torques",
        "sweep": "a closed torque sweep",
        "torque_amplitude": "closed sweeps of several sizes",
    }.get(vary, channel_words(vary))
