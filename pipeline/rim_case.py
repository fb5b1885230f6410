"""The load cases of the flexspline's rim, and the names of their figures; `load_cases` solves them."""

from __future__ import annotations

from typing import Literal, get_args

RimCase = Literal["lobes", "lobes_contact", "lobes_unsupported"]
RIM_CASES: tuple[RimCase, ...] = get_args(RimCase)
"""In the order of the reports."""


def figure_of(case: RimCase) -> str:
    """result.json's name of a case's stiffness, without its unit."""
    return f"K_b_{case}"
