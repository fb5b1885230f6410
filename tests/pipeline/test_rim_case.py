"""A load case of the rim is listed once, and solved."""

from __future__ import annotations

from typing import get_args

from flexspline.pipeline.load_cases import CASES
from flexspline.pipeline.rim_case import RIM_CASES, RimCase


def test_every_load_case_has_its_entry_in_the_order_of_the_names() -> None:
    assert tuple(RIM_CASES) == get_args(RimCase)


def test_every_load_case_is_solved() -> None:
    assert set(CASES) == set(RIM_CASES)
