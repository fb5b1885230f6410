"""Fast and solid model side by side; a disagreement beyond the bounds is seen."""

from dataclasses import replace
from pathlib import Path

import pytest
from example_files import EXAMPLES
from study_bench import WALL, study_of, threads

from flexspline.geometry.design import Solver
from flexspline.geometry.keys import without_holes
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate
from flexspline.pipeline.study.run import run_study, trial_store_of
from flexspline.pipeline.study.verify import checked

TEXT = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ values = [0.38, 0.42] }}
[objective]
"K_b_Nm_per_rad" = "maximize"
[run]
method = "grid"
verify = 1
"""


def figures(K: float, half: float) -> dict[str, float]:
    bounds = "K_b_bounds_Nm_per_rad"
    return {"K_b_Nm_per_rad": K, f"{bounds}[0]": K - half, f"{bounds}[1]": K + half}


@pytest.mark.parametrize(("solid", "agrees"), [(1015.0, True), (1025.0, False), (975.0, False)])
def test_intervals_that_do_not_meet_are_an_alarm(solid: float, agrees: bool) -> None:
    row = Row(3, {}, Outcome(figures(1000.0, 10.0)))
    (check,) = checked(row, Outcome(figures(solid, 10.0)), Solver()).checks
    assert check.agrees is agrees
    assert check.difference_pct == pytest.approx((solid - 1000.0) / 10.0)


def test_the_solid_model_of_a_part_without_holes_agrees(tmp_path: Path) -> None:
    study = study_of(TEXT)
    plain = replace(study, design=without_holes(study.design))

    def torsion(task: Task) -> Outcome:
        return evaluate(replace(task, solves=("torsion",)))

    result = run_study(plain, trial_store_of(plain, tmp_path), threads, lambda p: None, torsion)
    (verified,) = result.verified
    assert verified.slot == result.pareto[0].slot
    assert {c.key for c in verified.checks} == {
        "K_b_Nm_per_rad", "K_e_Nm_per_rad", "backlash_arcsec.total",
    }  # fmt: skip
    assert all(c.agrees for c in verified.checks)
    assert all(abs(c.difference_pct) > 0 for c in verified.checks)  # two models, not one twice


def test_examples_are_studies() -> None:
    from flexspline.pipeline.study.load import load_study

    methods = {load_study(p).file.run.method for p in sorted((EXAMPLES / "studies").glob("*.toml"))}
    assert methods == {"grid", "sobol", "optimize", "tolerance"}
