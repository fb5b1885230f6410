"""Colours of the page's charts and of the stress: those of every other picture of this program."""

from __future__ import annotations

from functools import cache
from typing import Any

from flexspline.results.style import ACCENT, COLOUR_MAP, PALETTE


@cache
def looks() -> dict[str, Any]:
    """Palette as hex, and the stress scale as 256 colours of three bytes each."""
    from matplotlib import colormaps

    scale = colormaps[COLOUR_MAP](range(256), bytes=True)[:, :3]
    return {"palette": list(PALETTE), "accent": ACCENT, "scale": scale.ravel().tolist()}
