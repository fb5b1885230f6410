"""The backlash budget: four terms that add up to the total, and the sources of its doubt."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pipeline.backlash import Backlash
from results.quantities import quantity
from results.style import ACCENT, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TERMS = ("shaft", "flexspline", "flank_clearance", "bearing_play")
SOURCES = {
    "youngs_modulus": "Young's modulus",
    "flank_clearance": "flank clearance",
    "radial_clearance": "bearing clearance",
}


def write_budget(path: Path, backlash: Backlash) -> None:
    """Write the chart: a waterfall of the terms with the total's 1σ bar, and 1σ by source."""
    with styled():
        figure = new_figure(8.0, 4.3)
        terms = figure.add_axes((0.205, 0.14, 0.46, 0.74))
        sources = figure.add_axes((0.835, 0.38, 0.135, 0.50))
        _waterfall(terms, backlash)
        _sources(sources, backlash)
        save_png(figure, path)


def _waterfall(axes: Axes, backlash: Backlash) -> None:
    values = [getattr(backlash, f"{t}_arcsec") for t in TERMS]
    total, std = backlash.total_arcsec, backlash.std_arcsec
    reach = max(total + std, sum(values))
    start = 0.0
    for row, (term, value, colour) in enumerate(zip(TERMS, values, PALETTE, strict=True)):
        entry = quantity(f"backlash_arcsec.{term}")
        axes.barh(row, value, left=start, height=0.62, color=colour, edgecolor=INK, linewidth=0.6)
        inside = start + value > 0.75 * reach
        axes.annotate(
            f"{entry.text(value)}  ({100 * value / total:.0f} %)",
            (start if inside else start + value, row),
            (-6 if inside else 6, 0),
            textcoords="offset points",
            ha="right" if inside else "left",
            va="center",
        )
        start += value
        axes.plot([start, start], [row + 0.31, row + 0.69], color=MUTED, lw=0.8)
    row = len(TERMS)
    axes.barh(row, total, height=0.62, color="#dfe3e7", edgecolor=INK, linewidth=0.9)
    axes.errorbar(total, row, xerr=std, color=ACCENT, lw=2, capsize=6, capthick=2)
    entry = quantity("backlash_arcsec.total")
    axes.text(
        0.04 * reach,
        row,
        f"{entry.text(total)} ± {entry.text(std)} (1σ)",
        va="center",
        weight="bold",
    )
    names = [quantity(f"backlash_arcsec.{t}").name for t in (*TERMS, "total")]
    axes.set_yticks(range(len(names)), [n.replace(", total", "") for n in names])
    axes.get_yticklabels()[-1].set_fontweight("bold")
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x")
    axes.set_xlim(0, 1.04 * reach)
    axes.set_xlabel(f"angle at the output in {entry.unit}")
    axes.set_title("Backlash between $\\mathbf{−T_L}$ and $\\mathbf{+T_L}$", x=-0.42)


def _sources(axes: Axes, backlash: Backlash) -> None:
    stds = backlash.std_by_source_arcsec
    names = [SOURCES.get(name, name.replace("_", " ")) for name in stds]
    entry = quantity("backlash_arcsec.std")
    axes.barh(range(len(stds)), list(stds.values()), height=0.55, color=ACCENT)
    for row, value in enumerate(stds.values()):
        axes.annotate(
            entry.text(value), (value, row), (5, 0), textcoords="offset points", va="center"
        )
    axes.set_yticks(range(len(stds)), [n.replace(" ", "\n", 1) for n in names])
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.set_xlim(0, 1.45 * max(max(stds.values(), default=0.0), 1e-9))
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)
    axes.set_title(f"1σ by source, {entry.unit}", x=-1.0)
