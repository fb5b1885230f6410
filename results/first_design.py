"""`flexspline init`: a first design file, the default of its kind or scaled to a catalogue size."""

from __future__ import annotations

from flexspline.geometry.errors import DesignError
from flexspline.geometry.sized import sized_template
from flexspline.geometry.template import template

USUAL_RATIO = 100
"""Of a size without `--ratio`: within the 30 to 160 of catalogues."""


def first_design(kind: str, size: float | None, ratio: int | None, rated_Nm: float | None) -> str:
    """A commented design file; `size` as a catalogue names it, None: the kind's first values.

    Raises
    ------
    DesignError : no such kind, a size or a ratio that no design has, or a ratio or a torque without a size.
    """
    if size is not None:
        return sized_template(kind, size, USUAL_RATIO if ratio is None else ratio, rated_Nm)
    for option, value in (("--ratio", ratio), ("--rated", rated_Nm)):
        if value is not None:
            raise DesignError(option, value, "needs a --size, such as 25")
    return template(kind)
