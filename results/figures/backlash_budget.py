"""The backlash budget: terms that add up to the total, and the sources of its standard deviation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from flexspline.pipeline.backlash import STD_KEY, TERMS, Backlash
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
from flexspline.results.doubt import NOT_STATED, SOURCES
from flexspline.results.figures.chart import Chart
from flexspline.results.figures.fitted_text import angle_title, fit, wrapped
from flexspline.results.quantities import quantity
from flexspline.results.style import (
    ACCENT,
    INK,
    LIGHT,
    MUTED,
    PALETTE,
    new_figure,
    save_png,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexspline.results.report.content import ReportContent

ADDED = "#b9a3cf"
CALIBRATION = "Calibration by measurement"
ROW, ABOVE, BELOW = 0.62, 0.52, 0.62
"""Inches: of a row of the waterfall, above the rows and below them."""
NAME_LETTERS = 20
"""Of a row's name on one line."""
VALUES, SHARES = 1.31, 1.46
"""Where the columns of the figures and of their shares end, in widths of the waterfall."""
POWER_OF_TEN = 1e6
"""arcsec: from there on matplotlib writes multiples of a power (`axes.formatter.limits`)."""


@dataclass(frozen=True)
class BudgetBar:
    """A bar from `start` over `size` [arcsec], and the words beside it."""

    name: str
    start: float
    size: float
    colour: str
    value: str
    share: str = ""
    is_sum: bool = False


def write_budget(path: Path, backlash: Backlash, extended: ExtendedBacklash | None = None) -> None:
    """Write the chart: a waterfall of the terms with the total's 1σ bar, and 1σ by source.

    The figures stand in a column of their own, so that no bar meets them. With `extended`, the
    terms that a measurement added follow the simulated total.
    """
    rows = _simulated(backlash, extended is not None)
    if extended is not None:
        rows += _measured(extended)
    with styled():
        height = ABOVE + ROW * len(rows) + BELOW
        figure = new_figure(8.0, height)
        terms = figure.add_axes((0.205, BELOW / height, 0.325, ROW * len(rows) / height))
        _waterfall(terms, rows, backlash)
        figure.text(
            0.012, 1 - 0.27 / height, "Backlash between $\\mathbf{−T_L}$ and $\\mathbf{+T_L}$",
            fontsize=12, weight="bold", va="center",
        )  # fmt: skip
        deep = 0.66 * len(SOURCES)
        sources = figure.add_axes((0.855, 1 - (ABOVE + deep) / height, 0.07, deep / height))
        _sources(sources, backlash)
        unit = quantity(STD_KEY).unit
        figure.text(
            0.75,
            1 - 0.27 / height,
            f"1σ by source, {unit}",
            fontsize=12,
            weight="bold",
            va="center",
        )
        save_png(figure, path)


def _simulated(backlash: Backlash, more: bool) -> list[BudgetBar]:
    """The four terms and their sum."""
    total, start, rows = backlash.total_arcsec, 0.0, []
    for (term, size), colour in zip(backlash.terms_arcsec.items(), PALETTE, strict=True):
        entry = quantity(f"backlash_arcsec.{term}")
        share = f"{100 * size / total:.0f}"
        rows.append(BudgetBar(entry.name, start, size, colour, entry.short(size), share))
        start += size
    entry, std = quantity("backlash_arcsec.total"), backlash.std_arcsec
    spread = "" if std is None else f"\n± {entry.short(std)}"
    name = ("Simulated" if more else "Backlash") + (" ± 1σ" if spread else "")
    rows.append(BudgetBar(name, 0.0, total, LIGHT, f"{entry.short(total)}{spread}", is_sum=True))
    return rows


def _measured(extended: ExtendedBacklash) -> list[BudgetBar]:
    """What the extended model adds, and the new sum; ids are the short names of causes."""
    entry, start, rows = quantity("backlash_arcsec.total"), extended.nominal.total_arcsec, []
    terms = {CALIBRATION: extended.calibration_arcsec, **extended.causes_arcsec}
    for cause, size in terms.items():
        plus = "+" if size >= 0 else ""
        name = cause.replace("_", " ").capitalize()
        rows.append(BudgetBar(name, start, size, ADDED, f"{plus}{entry.short(size)}"))
        start += size
    rows.append(BudgetBar("Extended", 0.0, start, LIGHT, entry.short(start), is_sum=True))
    return rows


def _waterfall(axes: Axes, rows: Sequence[BudgetBar], backlash: Backlash) -> None:
    ends = [0.0, *(r.start + r.size for r in rows)]
    std = backlash.std_arcsec
    for i, row in enumerate(rows):
        axes.barh(
            i, row.size, left=row.start, height=0.62, color=row.colour, edgecolor=INK,
            linewidth=0.9 if row.is_sum else 0.6,
        )  # fmt: skip
        if i + 1 < len(rows):
            end = row.start + row.size
            axes.plot([end, end], [i + 0.31, i + 0.69], color=MUTED, lw=0.8)
    if std is not None:
        at, total = len(TERMS), backlash.total_arcsec
        axes.errorbar(total, at, xerr=std, color=ACCENT, lw=2, capsize=6, capthick=2)
        ends += [total - std, total + std]
    low, high = min(ends), max(ends)
    axes.set_xlim(low - 0.04 * (high - low) if low < 0 else 0, high + 0.04 * (high - low))
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_yticks(range(len(rows)), [wrapped(r.name, NAME_LETTERS) for r in rows])
    for i, row in enumerate(rows):
        if row.is_sum:
            axes.get_yticklabels()[i].set_fontweight("bold")
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.axvline(0, color=MUTED, lw=0.8)
    axes.locator_params(axis="x", nbins=4)
    _figures(axes, rows)
    axes.grid(axis="x")
    # matplotlib before 3.11 writes the power of ten of such an axis at the right end, as high as the label
    side: Literal["left", "center"] = "left" if high >= POWER_OF_TEN else "center"
    axes.set_xlabel(angle_title("angle at the output"), loc=side)


def _figures(axes: Axes, rows: Sequence[BudgetBar]) -> None:
    """Each row's value and share in two columns, of one size, under their units; a sum's doubt below it."""
    across = axes.get_yaxis_transform()
    values, shares = [], []
    for i, row in enumerate(rows):
        weight = "bold" if row.is_sum else "normal"
        values.append(axes.text(
            VALUES, i, row.value, transform=across, weight=weight, ha="right", va="center"
        ))  # fmt: skip
        shares.append(axes.text(
            SHARES, i, row.share, transform=across, weight=weight, ha="right", va="center"
        ))  # fmt: skip
    heads = ((VALUES, quantity("backlash_arcsec.total").unit), (SHARES, "%"))
    for at, head in heads[: 2 if any(row.share for row in rows) else 1]:
        axes.annotate(
            head, (at, 1), (0, 4), "axes fraction", "offset points",
            color=MUTED, ha="right", va="bottom",
        )  # fmt: skip
    fit(values, (VALUES - 1) * axes.bbox.width - 6)
    fit(shares, (SHARES - VALUES) * axes.bbox.width - 6)


def _sources(axes: Axes, backlash: Backlash) -> None:
    """A bar for each source of doubt; which is not stated says so."""
    stds = backlash.std_by_source_arcsec
    entry = quantity(STD_KEY)
    annotations = []
    for row, source in enumerate(SOURCES):
        axes.barh(row, stds.get(source, 0.0), height=0.55, color=ACCENT)
        stated = source in stds
        annotations.append(axes.annotate(
            entry.short(stds[source]) if stated else NOT_STATED.replace(" ", "\n"),
            (stds.get(source, 0.0), row),
            (5, 0),
            textcoords="offset points",
            va="center",
            color=INK if stated else MUTED,
        ))  # fmt: skip
    axes.set_yticks(range(len(SOURCES)), [wrapped(n, 10) for n in SOURCES.values()])
    axes.set_ylim(len(SOURCES) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.set_xlim(0, max(max(stds.values(), default=0.0), 1e-9))
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)
    for text in annotations:
        fit([text], 0.9 * axes.bbox.width)


def _caption(content: ReportContent) -> str:
    text = "The terms of the backlash sum"
    if content.backlash.std_arcsec is not None:
        text += ", the total with one standard deviation, and the sources of this deviation"
    if content.extended is not None:
        return f"{text}. Below the simulated sum: the terms that {content.extended.model} adds."
    return f"{text}."


CHART = Chart(
    write=write_budget,
    arguments=lambda run, extended: (run.backlash, extended),
    caption=_caption,
    width_pct=62,
)
