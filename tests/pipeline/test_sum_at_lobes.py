"""Whether the backlash sum needs the rim is a property of the solver settings, and decided nowhere else."""

from collections.abc import Callable
from contextlib import suppress

import pytest
from example_files import EXAMPLES

from flexspline.geometry.design import Design, Solver
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.load import load_design
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.stiffness_pair import stiffness_pair
from flexspline.pipeline.study.evaluate import Task
from flexspline.pipeline.study.verify import solid_answer

DESIGN = load_design(EXAMPLES / "xb1-40.toml")


def pair_of(design: Design) -> None:
    stiffness_pair(analysis_context(design))


def solid_of(design: Design) -> None:
    found = solid_answer(Task(design.tables, {}, ("torsion",)), rim=False)
    assert found.outcome.reason == "seen"


@pytest.mark.parametrize(("load_case", "needed"), [("uniform", False), ("lobes", True)])
def test_only_the_lobes_need_the_rim(load_case: str, needed: bool) -> None:
    solver = Solver.model_validate({"load_case": load_case})
    assert solver.sum_at_lobes is needed
    assert (solver.K_b_in_sum == "K_b_lobes") is needed


@pytest.mark.parametrize("needed", [False, True])
@pytest.mark.parametrize(
    ("asks", "home"), [(pair_of, "pipeline.analysis"), (solid_of, "pipeline.study.verify")]
)
def test_who_solves_for_the_sum_asks_the_settings(
    asks: Callable[[Design], None], home: str, needed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def seen(*_: object, rim: bool, **__: object) -> None:
        asked.append(rim)
        raise ComputationError("seen")

    monkeypatch.setattr(Solver, "sum_at_lobes", needed)
    monkeypatch.setattr(f"flexspline.{home}.stiffnesses", seen)
    with suppress(ComputationError):
        asks(DESIGN)
    assert asked == [needed]
