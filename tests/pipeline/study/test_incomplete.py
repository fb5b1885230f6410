"""A solve that fails costs a design its own figure, and the design only where that figure is asked for."""

from __future__ import annotations

import csv
from pathlib import Path

from study_bench import GRID, study_of, threads

from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.figures import TOTAL
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.run import run_study, trial_store_of
from flexspline.results.study.record import summary, words
from flexspline.results.study.tables import table_of, write_csv

K_B, PEAK, LIFT_OFF = (
    "K_b_Nm_per_rad", "wave_generator_peak_mises_MPa", "K_b_lobes_contact_Nm_per_rad",
)  # fmt: skip
FIGURES = {
    K_B: 3e4,
    "K_b_bounds_Nm_per_rad[0]": 2.9e4,
    "K_b_bounds_Nm_per_rad[1]": 3.1e4,
    "K_b_bounds_guaranteed": 1.0,
    PEAK: 300.0,
    "wave_generator_peak_at_excluded_border": 0.0,
    TOTAL: 90.0,
}
REASON = "K_b_lobes_contact: no equilibrium after 60 rounds"


def without_lift_off(task: Task) -> Outcome:
    """Every figure but lift-off's, which failed."""
    return Outcome(FIGURES, (REASON,))


def result_of(text: str, folder: Path) -> StudyResult:
    study = study_of(text)
    return run_study(study, trial_store_of(study, folder), threads, without_lift_off)


def test_a_figure_that_nothing_asks_for_may_be_missing(tmp_path: Path) -> None:
    result = result_of(GRID, tmp_path)
    assert result.built == result.feasible == result.incomplete == result.rows
    record = summary(result)
    assert (record["failed"], record["incomplete"]) == (0, len(result.rows))
    assert record["best"]
    said = f"{len(result.rows)} designs lack a figure that the study does not need"
    assert said in words(result, record | {"files": []})
    assert table_of(result)["reason"] == [REASON] * len(result.rows)


def test_an_objective_or_a_constraint_that_is_missing_fails_the_design(tmp_path: Path) -> None:
    objective = GRID.replace(f'"{K_B}" = "maximize"', f'"{LIFT_OFF}" = "maximize"')
    constraint = f'{GRID}\n[constraint]\n"{LIFT_OFF}" = {{ min = 1.0 }}\n'
    for i, text in enumerate((objective, constraint)):
        assert text != GRID
        result = result_of(text, tmp_path / str(i))
        assert result.built == result.feasible == result.incomplete == ()
        assert summary(result)["failed"] == len(result.rows)


def test_without_either_the_usual_figures_are_asked_for(tmp_path: Path) -> None:
    text = GRID.replace(f'[objective]\n"{K_B}" = "maximize"\n', "")
    assert text != GRID
    assert len(result_of(text, tmp_path).built) > 0
    asked = study_of(text)
    for key in (K_B, PEAK, TOTAL):
        assert not asked.is_answered({k: v for k, v in FIGURES.items() if k != key})


def test_rows_say_what_their_bounds_are(tmp_path: Path) -> None:
    result = result_of(GRID, tmp_path)
    (best, *_) = summary(result)["best"]
    assert best["figures"]["K_b_bounds_kind"] == "guaranteed"
    assert best["figures"]["wave_generator_peak_at_excluded_border"] is False
    path = tmp_path / "study.csv"
    write_csv(path, table_of(result))
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {r["K_b_bounds_kind"] for r in rows} == {"guaranteed"}
    assert {r["wave_generator_peak_at_excluded_border"] for r in rows} == {"false"}
    assert not [k for k in rows[0] if k.endswith("guaranteed")]
