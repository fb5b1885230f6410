"""Records of three causes that were not named before."""

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
