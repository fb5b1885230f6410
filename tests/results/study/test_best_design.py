"""The best design of a study as a file, and what `flexspline run` would warn of in it."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from study_bench import study_of

from flexspline.geometry.load import load_design
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.run import trial_store_of
from flexspline.pipeline.study.source import study_name
from flexspline.pipeline.study.start import start_outcome
from flexspline.results.report.payload import payload_of
from flexspline.results.study.best_design import write_best_design
from flexspline.results.study.best_stress import BestStress
from flexspline.results.study.design_warnings import design_warnings
from flexspline.results.study.notes import notes
from flexspline.results.study.record import summary, words
from flexspline.results.study.report import study_document

RING, PEAK = "flexspline.ring_thickness_mm", "wave_generator_peak_mises_MPa"
STUDY = f"""
design = "xb1-40.toml"
[vary]
"{RING}" = {{ min = 0.5, max = 0.9 }}
[objective]
"K_b_Nm_per_rad" = "maximize"
[run]
method = "sobol"
"""

TOLERANCE = f"""
design = "xb1-40.toml"
[tolerance]
"{RING}" = {{ std = 0.01 }}
[run]
method = "tolerance"
"""
NO_OBJECTIVE = STUDY.replace('[objective]\n"K_b_Nm_per_rad" = "maximize"\n', "")


def result_of(*made: tuple[float, float], text: str = STUDY) -> StudyResult:
    """Of ring thickness [mm] and peak [MPa] of each design; a thicker ring is stiffer."""
    rows = tuple(
        Row(i, {RING: ring}, Outcome({"K_b_Nm_per_rad": 1e4 * ring, PEAK: peak}))
        for i, (ring, peak) in enumerate(made)
    )
    return StudyResult(study_of(text), rows)


def test_the_file_is_the_best_design(tmp_path: Path) -> None:
    result = result_of((0.55, 400.0), (0.7, 400.0), (0.6, 400.0))
    path = write_best_design(tmp_path, result)
    assert path == tmp_path / "best.toml"
    design = load_design(path)
    assert design.name == "XB1-40 cup, design 1 of test"
    assert design.flexspline.ring_thickness_mm == 0.7
    assert design == result.design_of(result.rows[1]).changed({"name": design.name})


def test_where_no_design_is_better_than_another_there_is_no_file(tmp_path: Path) -> None:
    result = result_of((0.55, 400.0), text=TOLERANCE)
    assert write_best_design(tmp_path, result) is None
    assert not list(design_warnings(result))
    assert not list(tmp_path.iterdir())


def test_a_ring_whose_teeth_do_not_fit_is_said_of_the_best() -> None:
    """19.2 + 0.9 mm is 0.35 mm outside the tooth root, 19.75 mm."""
    tooth, others = design_warnings(result_of((0.55, 400.0), (0.9, 400.0), (0.85, 400.0)))
    assert tooth.startswith("design 1 (in 2 of 3 designs): tooth-root radius")
    assert "other listed" not in tooth
    assert others.startswith("other listed designs with warnings: 2; ")
    assert not list(design_warnings(result_of((0.55, 400.0))))


@pytest.mark.parametrize(("peak", "said"), [(499.0, 0), (501.0, 1)])
def test_a_peak_above_the_fatigue_limit_is_said(peak: float, said: int) -> None:
    lines = [
        line
        for line in design_warnings(result_of((0.55, peak)))
        if "fatigue limit of 500 MPa" in line
    ]
    assert len(lines) == said
    told = notes(result_of((0.55, peak)), lines)
    in_report = [line for line in told if "fatigue_limit_MPa" in line]
    assert len(in_report) == said


def test_designs_above_the_fatigue_limit_are_counted() -> None:
    """Peaks of other sizes pass the same limit."""
    line, others = design_warnings(result_of((0.55, 600.0), (0.56, 501.0), (0.54, 499.0)))
    assert line.startswith(
        "design 1 (in 2 of 3 designs): Peak von Mises stress, wave-generator ellipse: 501"
    )
    assert others.startswith("other listed designs with warnings: 0; ")


def begun_with(result: StudyResult, slot: int) -> StudyResult:
    """The study as if the design of that row were its first."""
    return replace(result, study=replace(result.study, design=result.design_of(result.rows[slot])))


def test_what_the_first_design_is_warned_of_is_said_once_of_the_best() -> None:
    """Teeth that stand on no ring, as the docs promise, though every design has it."""
    result = begun_with(result_of((0.9, 400.0), (0.9, 400.0)), 0)
    (line,) = design_warnings(result)
    assert line.startswith("design 0 (in 2 of 2 designs): tooth-root radius")
    assert sum("tooth-root radius" in note for note in notes(result, design_warnings(result))) == 1
    assert len([*design_warnings(begun_with(result_of((0.9, 400.0)), 0))]) == 1


def test_a_warning_of_the_first_design_alone_is_said_as_its_own() -> None:
    result = begun_with(result_of((0.55, 400.0), (0.9, 400.0)), 1)
    kept = replace(result, rows=result.rows[:1])
    (line,) = design_warnings(kept)
    assert line.startswith("start design: tooth-root ")


@pytest.mark.parametrize("text", [TOLERANCE, NO_OBJECTIVE])
def test_where_none_is_best_the_first_design_s_warnings_are_said(text: str) -> None:
    result = begun_with(result_of((0.55, 400.0), (0.9, 400.0), (0.91, 400.0), text=text), 1)
    figures = {"backlash_arcsec.total": 80.0}
    rows = tuple(replace(r, outcome=Outcome({**r.outcome.figures, **figures})) for r in result.rows)
    (line,) = design_warnings(replace(result, rows=rows))
    assert line.startswith("start design (in 2 of 3 designs): tooth-root radius")


def test_rows_of_a_program_that_means_something_else_are_not_resumed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    study = study_of(STUDY)
    before = study_name(study)
    assert study_name(study) == before
    monkeypatch.setattr("flexspline.pipeline.study.source.FORMAT", 10**6)
    assert study_name(study) != before


def test_a_peak_that_no_metal_bears_is_said_as_in_a_run() -> None:
    (fatigue, elastic) = design_warnings(result_of((0.55, 2500.0)))
    assert "fatigue_limit_MPa" in fatigue
    assert "where no metal used in gears is elastic" in elastic


def begun(*figures: float) -> StudyResult:
    """A study whose first design had these figures."""
    result = result_of((0.7, 400.0))
    return replace(
        result, start=Outcome(dict(zip(("K_b_Nm_per_rad",), figures, strict=False)), ("no K",))
    )


def test_the_first_design_stands_beside_the_best() -> None:
    result = begun(5500.0)
    record = summary(result)
    assert record["start"]["values"] == {RING: 0.55}
    assert record["start"]["figures"]["K_b_Nm_per_rad"] == 5500.0
    lines = words(result, record | {"files": []}).splitlines()
    assert re.match(r"  start: ring thickness 0\.55.mm: K_b = 5.?500", lines[1])
    assert lines[2].startswith("  design 0: ")
    table = str(payload_of(study_document(result, ())))
    assert "'start'" in table
    assert "'0.55'" in table
    assert "start: no K" not in table


def test_a_first_design_that_fails_says_why() -> None:
    lines = words(begun(), summary(begun()) | {"files": []}).splitlines()
    assert lines[1].endswith(": no K")


def test_the_first_design_is_solved_once(tmp_path: Path) -> None:
    study, solved = study_of(STUDY), []

    def solve(task: Task) -> Outcome:
        solved.append(task.values)
        return Outcome({"K_b_Nm_per_rad": 7.0})

    found = [start_outcome(study, trial_store_of(study, tmp_path), None, solve) for _ in range(2)]
    assert solved == [{}]
    assert found[0] == found[1] == Outcome({"K_b_Nm_per_rad": 7.0})


def test_the_captions_say_only_what_is_drawn() -> None:
    """A bar marks what a constraint allows; and the picture's peak may not be the table's: both are said."""
    constrained = STUDY.replace("[run]", f'[constraint]\n"{PEAK}" = {{ max = 500.0 }}\n[run]')
    for text, bars in ((STUDY, False), (constrained, True)):
        made = study_document(
            result_of((0.55, 400.0), (0.7, 400.0), text=text),
            ("parallel.png", "best_stress.png"),
            best=BestStress(peak_MPa=377.0),
        )
        said = str(payload_of(made))
        assert ("a bar marks the range" in said) is bars
        assert "as flexspline run computes it: peak 377" in said
        assert "The study itself has 400" in said
        assert "leaves out bolt holes and is solved to 1 %" in said
