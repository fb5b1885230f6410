"""dK/dp of every dimension of one design: solved once (`stiffness_slopes`), then read from the cache."""

from __future__ import annotations

from collections.abc import Callable

from flexspline.geometry.design import Design
from flexspline.geometry.keys import without_holes
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.storage import cache_folder
from flexspline.pipeline.study.slope import Slope, Slopes


def sensitivities(design: Design, say: Callable[[str], None]) -> tuple[Slope, ...]:
    """Return dK/dp of every length above 0 of both parts, the strongest first within a part.

    `say` is told the cache's faults, each dimension that is solved, and those that have no slope.

    Raises
    ------
    DesignError, ComputationError
    """
    cache = Cache(cache_folder(), say)

    def solve() -> Slopes:
        # here, as the solvers take a second to load
        from flexspline.pipeline.study.stiffness_slopes import slopes

        return slopes(design, say)

    # all of the design, as every key has a say in which steps can be built; its name has none
    tables = without_holes(design).model_dump(mode="json", exclude={"name"})
    kept, _ = cache.get("slopes by dimension", {"design": tables}, solve, _is_lasting)
    for key, why in kept.missing.items():
        say(f"no dK/dp of {key}: {why}")
    return kept.slopes


def _is_lasting(kept: Slopes) -> bool:
    """Whether more time or memory would have found no more."""
    of_slopes = (why for s in kept.slopes for why in (s.why, s.why_no_sum))
    reasons = (*of_slopes, *kept.missing.values())
    return not any(why.of_the_machine for why in reasons)
