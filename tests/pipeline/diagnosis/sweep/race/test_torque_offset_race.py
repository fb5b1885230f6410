"""A shifted torque reading whose place, found again, leaves a few rows on the wrong side of the gap."""

from __future__ import annotations

import pytest
from hidden.adapter import diagnose
from hidden.cases import draw_case
from hidden.mark import mark


@pytest.mark.long
def test_the_first_place_serves_where_the_last_puts_rows_on_the_wrong_side() -> None:
    """A staircase, read 0.316 N·m too low; the place found from its first race, 0.268, passes some rows."""
    found = mark(draw_case(1600001, 55), diagnose)
    assert (found.verdict, found.found) == ("named", ("torque_offset",))


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    ("number", "kind"),
    [
        *(pytest.param(n, "single", marks=pytest.mark.long) for n in (69, 497)),
        (212, "pair"),
    ],
)
def test_the_last_place_serves_where_no_row_tells_it_from_the_first(number: int, kind: str) -> None:
    """The first was taken, 35 to 44 % too large: far from zero, more rows tell it from no offset."""
    found = mark(draw_case(4100001, number, kind), diagnose)
    (size,) = (s for s in found.sizes if s.cause == "torque_offset")
    assert size.deviations < 2


@pytest.mark.long
@pytest.mark.usefixtures("causes_only")
def test_a_gap_that_temperature_changes_is_crossed_where_its_rows_say() -> None:
    """70 to 11 arcsec, and a reading 1.424 N·m too high: 1.256 was said with 0.009 N·m of doubt.

    A gap of 70 arcsec was sought in all rows, and the temperature's noise passed for a lag.
    """
    found = mark(draw_case(4500001, 46, "pair"), diagnose)
    sizes = {s.cause: s for s in found.sizes}
    assert set(sizes) == {"torque_offset", "thermal_clearance"}
    assert all(s.deviations < 2 for s in sizes.values())
    # a row of 0.24 N·m about the crossing, 12 crossings; 0.05 K of noise in 7 K
    assert sizes["torque_offset"].error < 0.02
    assert sizes["thermal_clearance"].error < 0.02
