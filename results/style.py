"""How every picture looks: fonts, sizes, colours that survive grey print and colour blindness."""

from __future__ import annotations

import io
from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.results.atomic import write_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOUR_MAP = "viridis"
"""Perceptually uniform, monotonic in lightness: the same picture in grey and to every eye."""

INK = "#1f2429"
MUTED = "#6b747d"
RULE = "#c9ced3"
STEEL = "#cfd6dc"
LIGHT = "#dfe3e7"
"""Of bars that stand back, and of thin lines between panels."""
GRID = "#e4e7ea"
TINT = "#f1f4f7"
"""Behind words."""
SMALL_PRINT = "#5a636c"
"""`MUTED` for words on `TINT`, where that is too pale to read."""

# Four lightness steps (L* about 25, 47, 65, 84), hues apart on the blue-yellow axis that red-green
# blindness leaves intact.
PALETTE = ("#123f66", "#2f7ab8", "#dd8f2d", "#f5d38a")
ACCENT = "#b3371f"

REPORT_COLOURS: Mapping[str, str] = {
    "ink": INK,
    "muted": SMALL_PRINT,
    "rule": RULE,
    "tint": TINT,
    "blue": PALETTE[0],
    "amber": PALETTE[2],
    "pale-amber": "#fdf6ea",
    "red": ACCENT,
    "mark": ACCENT,
    "flag": INK,
}
"""Colours of a report by the names that its two templates use, PDF and HTML. Where a page is dark it has
others, but for the mark at a peak and its flag.
"""
STUDIO_COLOURS: Mapping[str, str] = {
    "ink": INK,
    "muted": MUTED,
    "rule": LIGHT,
    "strong": PALETTE[0],
    "accent": PALETTE[1],
    "bad": ACCENT,
}
"""Colours of the studio's page by the names that its style sheets use."""

DPI = 200
"""Dots per inch: charts of 8 in have 1600 pixels, 190 to the inch across a whole A4 page."""
PNG_LEVEL = 4
"""Of zlib, 1 to 9: in 0.6 of the time of Pillow's 6; pictures are 1 to 7 % larger."""
_RC: dict[str, Any] = {
    "font.family": "DejaVu Sans",  # ships with matplotlib
    "font.size": 10.5,
    "axes.titlesize": 12,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 12,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "text.color": INK,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "mathtext.default": "it",
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


def as_css(colours: Mapping[str, str]) -> str:
    """Colours as variables of a style sheet."""
    return f":root {{ {' '.join(f'--{name}: {value};' for name, value in colours.items())} }}\n"


def colour_scale() -> list[int]:
    """The colours of stress from 0 up, 256 of three bytes each, as pages take them."""
    import matplotlib as mpl

    rows: list[int] = mpl.colormaps[COLOUR_MAP](range(256), bytes=True)[:, :3].ravel().tolist()
    return rows


def styled() -> AbstractContextManager[None]:
    """The style as a context: nothing of it outlives the figure."""
    import matplotlib as mpl

    settings: Any = _RC
    return mpl.rc_context(settings)


def new_figure(width_in: float, height_in: float, dpi: int = DPI) -> Figure:
    """A figure bound to the Agg canvas, outside pyplot's global list."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), dpi=dpi, layout=None)
    FigureCanvasAgg(figure)
    return figure


def save_png(figure: Figure, path: Path) -> None:
    """Write the figure as PNG, whole or not at all, the same bytes for the same content.

    matplotlib would write the opacity too, which is 1 everywhere: a tenth more room and time.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    opaque = np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])
    words = PngInfo()
    words.add_text("Software", "flexspline")
    buffer = io.BytesIO()
    Image.fromarray(opaque).save(
        buffer, "PNG", compress_level=PNG_LEVEL, pnginfo=words, dpi=(figure.dpi, figure.dpi)
    )
    write_bytes(path, buffer.getvalue())
