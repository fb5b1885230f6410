"""The drawing sheet around the renders: title, colour bar with its unit, peak, legend, note.

The large view stands left, a small one right below, the colour bar at the right edge; the place
above the small view belongs to the peak's label, so that nothing ever overlaps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flexspline.results.renders.scene import Shot
from flexspline.results.style import ACCENT, COLOUR_MAP, INK, MUTED, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 1600, 1200
"""Pixels of the sheet: ten per mm where it is printed 160 mm wide."""
MAIN = (860, 950)
"""Pixels of the large view, width and height."""
INSET, LARGE_INSET = (440, 480), (600, 640)
"""Pixels of the small views, width and height; the large inset goes where there is no colour bar."""
_MAIN_AT, _INSET_AT = (40, 116), (930, 176)
"""Places of the views in pixels, from the left and the lower edge: side by side with a margin."""
_LABEL_AT = (1150, 850)
"""Place of the label in pixels, above the middle of the inset; of its middle line."""
_DPI = 100
"""Pixels per inch: only what turns pixels into matplotlib's inches and points, so any other would do."""
_TITLE, _SUBTITLE, _TEXT, _NOTE = 50, 38, 44, 34
"""Text heights in pixels: printed 80 mm wide, half size, the smallest is still 1.7 mm."""


@dataclass(frozen=True)
class Mark:
    """A point of the drawn part [mm], what is written about it, and which view shows it."""

    at_mm: np.ndarray
    text: str
    shown_by: Literal["main", "inset", "none"]


@dataclass(frozen=True)
class Bar:
    """Colour scale from 0 to `high`; the label carries the unit, `high_text` names the top."""

    label: str
    high: float
    high_text: str
    beyond: bool


@dataclass(frozen=True)
class Sheet:
    """Everything on the sheet but the views; `legend` is pairs of colour and words."""

    title: str
    subtitle: str
    inset_title: str
    note: str = ""
    bar: Bar | None = None
    mark: Mark | None = None
    legend: tuple[tuple[str, str], ...] = ()


def write_sheet(path: Path, main: Shot, inset: Shot, sheet: Sheet) -> None:
    """Write the sheet as a PNG of 1600 x 1200."""
    with styled():
        figure = new_figure(WIDTH / _DPI, HEIGHT / _DPI, _DPI)
        _image(figure, main, _MAIN_AT)
        _image(figure, inset, _INSET_AT)
        _say(figure, (44, 1140), sheet.title, _TITLE, INK, weight="bold")
        _say(figure, (44, 1082), sheet.subtitle, _SUBTITLE, MUTED)
        _say(figure, (44, 28), sheet.note, _NOTE, MUTED)
        middle = _INSET_AT[0] + inset.image.shape[1] / 2
        _say(figure, (middle, _INSET_AT[1] - 46), sheet.inset_title, _NOTE, MUTED, ha="center")
        if sheet.bar:
            _bar(figure, sheet.bar)
        if sheet.mark:
            _mark(figure, main, inset, sheet.mark)
        if sheet.legend:
            _legend(figure, sheet.legend)
        save_png(figure, path)


def _pt(pixels: float) -> float:
    return pixels * 72 / _DPI


def _image(figure: Figure, shot: Shot, at: tuple[int, int]) -> None:
    """Pixel by pixel, below all else; `figimage` would resample it."""
    from matplotlib.artist import Artist

    rows = np.flipud(np.dstack([shot.image, np.full(shot.image.shape[:2], 255, np.uint8)]))

    class Pixels(Artist):
        def draw(self, renderer: Any) -> None:
            context = renderer.new_gc()
            renderer.draw_image(context, *at, rows)
            context.restore()

    figure.add_artist(Pixels()).set_zorder(-1)


def _say(
    figure: Figure, at: tuple[float, float], text: str, size: int, colour: str, **look: Any
) -> None:
    """Words with their lower left at a pixel; `look`: of matplotlib's text."""
    figure.text(
        at[0] / WIDTH,
        at[1] / HEIGHT,
        text,
        fontsize=_pt(size),
        color=colour,
        va="bottom" if "\n" in text else "baseline",
        linespacing=1.2,
        parse_math=False,
        **look,
    )


def _bar(figure: Figure, bar: Bar) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    axes = figure.add_axes((1392 / WIDTH, 170 / HEIGHT, 46 / WIDTH, 750 / HEIGHT))
    scale = figure.colorbar(
        ScalarMappable(Normalize(0.0, bar.high), COLOUR_MAP),
        cax=axes,
        extend="max" if bar.beyond else "neither",
        extendfrac=0.04,
    )
    inside, words = ticks(bar.high)
    scale.set_ticks([*inside, bar.high], labels=[*words, bar.high_text])
    scale.outline.set_linewidth(0.8)
    axes.minorticks_off()
    longest = max(map(len, [*words, bar.high_text]))
    size = _TEXT * min(1.0, 5 / longest)  # five figures fill the margin
    axes.tick_params(labelsize=_pt(size), width=1.5, length=8, pad=8)
    _say(figure, (1476, 970), bar.label, _TEXT, INK, ha="center")


def ticks(high: float) -> tuple[list[float], list[str]]:
    """Round steps from 0 that leave room for the label at the top."""
    from matplotlib.ticker import MaxNLocator

    steps = MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, high)
    inside = [float(s) for s in steps if 0 <= s < 0.9 * high]
    places = max(len(_shortest(s).partition(".")[2]) for s in inside)
    return inside, [f"{s:.{places}f}" if s else "0" for s in inside]


def _shortest(number: float) -> str:
    """Six figures at most, without trailing zeros and without an exponent."""
    return np.format_float_positional(number, precision=6, fractional=False, trim="-")


def _overlay(figure: Figure) -> Axes:
    """Axes over the whole sheet in its pixels, from below left."""
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, HEIGHT)
    return axes


def _mark(figure: Figure, main: Shot, inset: Shot, mark: Mark) -> None:
    in_inset = mark.shown_by == "inset"
    shot, at, size = (inset, _INSET_AT, 18) if in_inset else (main, _MAIN_AT, 26)
    column, row = shot.pixel(mark.at_mm)
    x, y = at[0] + column, at[1] + shot.image.shape[0] - row
    axes = _overlay(figure)
    axes.plot([x], [y], "o", ms=_pt(size), mfc="none", mec="white", mew=_pt(10))
    axes.annotate(
        mark.text,
        (x, y),
        _LABEL_AT,
        fontsize=_pt(_TEXT),
        color=INK,
        ha="center",
        va="center",
        linespacing=1.2,
        parse_math=False,
        bbox={"boxstyle": "round,pad=0.3", "fc": "white", "ec": ACCENT, "lw": _pt(3.5)},
        arrowprops={
            "arrowstyle": "-",
            "color": ACCENT,
            "lw": _pt(4),
            "shrinkA": 0,
            "shrinkB": _pt(size / 2 + 2),
        },
    )
    axes.plot([x], [y], "o", ms=_pt(size), mfc="none", mec=ACCENT, mew=_pt(5))


def _legend(figure: Figure, entries: Sequence[tuple[str, str]]) -> None:
    from matplotlib.patches import Patch

    figure.legend(
        handles=[Patch(fc=colour, ec=INK, lw=0.8) for colour, _ in entries],
        labels=[text for _, text in entries],
        loc="lower left",
        bbox_to_anchor=(36 / WIDTH, 20 / HEIGHT),
        ncols=len(entries),
        fontsize=_pt(_NOTE + 3),
        handlelength=1.1,
        handleheight=1.0,
        columnspacing=1.4,
        borderpad=0.0,
    )
