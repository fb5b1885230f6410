"""Names of the whole gear's terms, for comparison with the backlash sum."""

from __future__ import annotations

from flexspline.pipeline.backlash import TERMS
from flexspline.pipeline.gear.gear_terms import TIGHT
from flexspline.results.quantities import quantity


def term_names() -> dict[str, str]:
    """Of the whole gear's terms, in the order of the sum; the gap of a tight gear is not in that."""
    names = {term: quantity(f"backlash_arcsec.{term}").name for term in TERMS}
    return {**names, TIGHT: "Gap without any clearance", "total": "Total"}
