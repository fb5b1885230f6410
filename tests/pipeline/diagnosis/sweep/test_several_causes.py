"""Records of three causes, and of friction ahead of the gap, that were named wrongly before."""

from __future__ import annotations

import pytest
from hidden.adapter import diagnose
from hidden.cases import draw_case
from hidden.mark import mark


@pytest.mark.parametrize(
    "number",
    [
        # creep of 4.4 ± 0.3 %/decade had ± 2.4 from springs that hardening was said to hide
        97,
        # a stiffness of three positions left the compliance open, and friction was said to be a spring
        89,
    ],
)
def test_three_causes_are_named(number: int) -> None:
    assert mark(draw_case(3000001, number, "triple"), diagnose).exact


def test_an_offset_of_four_deviations_of_a_reading_is_named_beside_two_causes() -> None:
    assert mark(draw_case(3000002, 14, "triple"), diagnose).exact


@pytest.mark.parametrize("number", [15, 22])
def test_friction_ahead_is_found_again_until_it_settles(number: int) -> None:
    """A torque 0.17 N·m, or 0.07, off after three races made creep, or a lag, of what it left."""
    assert mark(draw_case(3000011, number, "single", "friction_ahead"), diagnose).exact
