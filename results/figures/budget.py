"""The backlash budget: terms that add up to the total, and the sources of its doubt."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pipeline.backlash import Backlash
from pipeline.diagnosis.extended_backlash import ExtendedBacklash
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


ADDED = "#b9a3cf"
CALIBRATION = "Calibration by measurement"


def write_budget(path: Path, backlash: Backlash, extended: ExtendedBacklash | None = None) -> None:
    """Write the chart: a waterfall of the terms with the total's 1σ bar, and 1σ by source.

    With `extended`, the terms that a measurement added follow the simulated total.
    """
    added = _added(extended) if extended else []
    with styled():
        height = 4.3 + 0.52 * (len(added) + bool(added))
        figure = new_figure(8.0, height)
        fixed = 4.3 / height
        terms = figure.add_axes((0.205, 0.14 * fixed, 0.46, 1 - 0.26 * fixed))
        sources = figure.add_axes((0.835, 1 - 0.62 * fixed, 0.135, 0.50 * fixed))
        _waterfall(terms, backlash, extended, added)
        _sources(sources, backlash)
        save_png(figure, path)


def _added(extended: ExtendedBacklash) -> list[tuple[str, float]]:
    """Name and size of each added term; ids are the short names of causes."""
    terms = {CALIBRATION: extended.calibration_arcsec, **extended.causes_arcsec}
    return [(_wrapped(n.replace("_", " ").capitalize()), v) for n, v in terms.items()]


def _wrapped(name: str) -> str:
    """Two lines, broken near the middle."""
    words, first = name.split(), ""
    if len(name) <= 18:
        return name
    while words and len(first) + len(words[0]) <= (len(name) + 1) // 2 + 1:
        first += ("" if not first else " ") + words.pop(0)
    return f"{first}\n{' '.join(words)}"


def _waterfall(
    axes: Axes,
    backlash: Backlash,
    extended: ExtendedBacklash | None,
    added: list[tuple[str, float]],
) -> None:
    values = [getattr(backlash, f"{t}_arcsec") for t in TERMS]
    total, std = backlash.total_arcsec, backlash.std_arcsec
    peak, level = total, total
    for _, value in added:
        level += value
        peak = max(peak, level)
    reach = max(total + std, sum(values), peak)
    entry = quantity("backlash_arcsec.total")
    start = 0.0
    for row, (term, value, colour) in enumerate(zip(TERMS, values, PALETTE, strict=True)):
        words = f"{quantity(f'backlash_arcsec.{term}').text(value)}  ({100 * value / total:.0f} %)"
        _step(axes, row, start, value, colour, words, reach)
        start += value
    row = len(TERMS)
    _sum(axes, row, total, f"{entry.text(total)} ± {entry.text(std)} (1σ)", reach)
    axes.errorbar(total, row, xerr=std, color=ACCENT, lw=2, capsize=6, capthick=2)
    names = [quantity(f"backlash_arcsec.{t}").name for t in (*TERMS, "total")]
    names = [n.replace(", total", "") for n in names]
    bold = [row]
    if extended:
        names[-1] = "Simulated"
        axes.plot([total, total], [row + 0.31, row + 0.69], color=MUTED, lw=0.8)
        for _, value in added:
            row += 1
            plus = "+" if value >= 0 else ""
            _step(axes, row, start, value, ADDED, f"{plus}{entry.text(value)}", reach)
            start += value
        bold.append(row + 1)
        _sum(axes, row + 1, start, f"{entry.text(start)}, with what was measured", reach)
        names += [*(n for n, _ in added), "Extended"]
    axes.set_yticks(range(len(names)), names)
    for row in bold:
        axes.get_yticklabels()[row].set_fontweight("bold")
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x")
    axes.set_xlim(0, 1.04 * reach)
    axes.set_xlabel(f"angle at the output in {entry.unit}")
    axes.set_title("Backlash between $\\mathbf{−T_L}$ and $\\mathbf{+T_L}$", x=-0.42)


def _step(
    axes: Axes, row: int, start: float, value: float, colour: str, words: str, reach: float
) -> None:
    """One bar from `start` on, its figure on the side that has room, a thread to the next."""
    axes.barh(row, value, left=start, height=0.62, color=colour, edgecolor=INK, linewidth=0.6)
    low, high = sorted((start, start + value))
    inside = high > 0.75 * reach
    axes.annotate(
        words,
        (low if inside else high, row),
        (-6 if inside else 6, 0),
        textcoords="offset points",
        ha="right" if inside else "left",
        va="center",
    )
    end = start + value
    axes.plot([end, end], [row + 0.31, row + 0.69], color=MUTED, lw=0.8)


def _sum(axes: Axes, row: int, total: float, words: str, reach: float) -> None:
    axes.barh(row, total, height=0.62, color="#dfe3e7", edgecolor=INK, linewidth=0.9)
    axes.text(0.04 * reach, row, words, va="center", weight="bold")


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
