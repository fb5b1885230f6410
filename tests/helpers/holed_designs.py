"""Random flexsplines with bolt holes: a hole over the axis, narrow lands, thin and thick ends."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count, islice

from random_designs import design_of

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from


def holed_designs(number: int) -> list[Design]:
    """The first ones of `random_designs` that can be built and have holes in the flexspline."""
    return list(islice(_all(), number))


def _all() -> Iterator[Design]:
    for seed in count():
        try:
            design = design_from(design_of(seed, slips=False))
        except DesignError:
            continue
        if design.flexspline.bolts is not None:
            yield design
