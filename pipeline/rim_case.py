"""The load cases of the flexspline's rim, one entry each; `load_cases` solves them.

All that lists figures reads their names, so that this file loads no solver: each is imported when called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from flexspline.fea.deadline import Deadline
    from flexspline.fea.types import Elastic, Stiffness
    from flexspline.geometry.outline import Meridian

RimCase = Literal["lobes", "lobes_contact", "lobes_unsupported"]
RimSolve = Callable[["Meridian", "Elastic", float, "Deadline"], Iterator["Stiffness"]]
"""K_b of a body of revolution in a load case of its rim, by each mesh until its bounds are near enough: of
outline, material, their relative width, and when to end."""


@dataclass(frozen=True)
class LoadCase:
    """A load case of the rim.

    Attributes
    ----------
    title : what it is called while it is solved, and in tables where `results.quantities` has no other words.
    solve : answers it on a meridian; None where that takes another case's answer: see `load_cases`.
    """

    title: str
    solve: RimSolve | None


def held_rim(
    outline: Meridian, material: Elastic, relative_width: float, deadline: Deadline
) -> Iterator[Stiffness]:
    """Solve the lobe load with the seat held radially."""
    from flexspline.fea.axisymmetric.lobes import lobe_stiffnesses

    return lobe_stiffnesses(outline, material, True, relative_width, deadline)


def free_rim(
    outline: Meridian, material: Elastic, relative_width: float, deadline: Deadline
) -> Iterator[Stiffness]:
    """Solve the lobe load with the seat free."""
    from flexspline.fea.axisymmetric.lobes import lobe_stiffnesses

    return lobe_stiffnesses(outline, material, False, relative_width, deadline)


RIM_CASES: Mapping[RimCase, LoadCase] = {
    "lobes": LoadCase("lobes", held_rim),
    "lobes_contact": LoadCase("lobes, rim resting on the seat", None),
    "lobes_unsupported": LoadCase("lobes, rim unsupported", free_rim),
}
"""In the order of the reports."""


def figure_of(case: RimCase) -> str:
    """Return result.json's name of a case's stiffness, without its unit."""
    return f"K_b_{case}"
