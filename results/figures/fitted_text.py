"""Fits text into limited space: wrapped, shortened, or in a smaller font."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from flexspline.results.quantities import quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Text


GROUND: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5}
"""Frame of words that a line may pass behind."""
EDGE_PX = 8.0
"""Left free at the edge of a sheet."""


def angle_title(name: str) -> str:
    """Of an axis over which an angle stands."""
    return f"{name} in {quantity('backlash_arcsec.total').unit}"


def torque_title(name: str) -> str:
    """Of an axis over which a torque stands."""
    return f"{name} in {quantity('rated_torque_Nm').unit}"


def wrapped(text: str, letters: int, lines: int = 2) -> str:
    """Broken into no more than so many lines of about so many letters; the rest becomes "…"."""
    return "\n".join(textwrap.wrap(text, letters, max_lines=lines, placeholder=" …"))


def fit(texts: Sequence[Text], width_px: float) -> None:
    """Make all of them smaller, alike, until none is wider than so many pixels."""
    widest = max((t.get_window_extent().width for t in texts if t.get_text()), default=0.0)
    if widest > width_px:
        for text in texts:
            text.set_fontsize(float(text.get_fontsize()) * width_px / widest)


def keep_inside(axes: Axes) -> None:
    """Move the axes' left side inwards until the numbers and the label beside it are on the sheet."""
    figure, taken = axes.get_figure(), axes.get_tightbbox()
    if figure is None or taken is None:
        return
    outside = EDGE_PX - taken.x0
    if outside > 0:
        place, share = axes.get_position(), outside / figure.bbox.width
        axes.set_position((place.x0 + share, place.y0, place.width - share, place.height))


def thin_labels(axes: Axes) -> None:
    """Blank labels below the axes, all but every second, third, …, until they stand apart."""
    labels = axes.get_xticklabels()
    if len(labels) < 2:
        return
    widest = max(t.get_window_extent().width for t in labels) + 4
    at = axes.get_xaxis_transform().transform([(x, 0) for x in axes.get_xticks()])[:, 0]
    spacing = float(min(abs(b - a) for a, b in pairwise(at)))
    step = -(-int(widest) // max(int(spacing), 1))
    axes.set_xticks(
        axes.get_xticks(), [t.get_text() if i % step == 0 else "" for i, t in enumerate(labels)]
    )
