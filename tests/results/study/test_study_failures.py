"""Designs of a study that cannot be built: by cause, with a count and an example, each part's own reason."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path

from example_files import EXAMPLES
from typer.testing import CliRunner

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate
from flexspline.pipeline.study.figures import USUAL_FIGURES
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.verified import Verified
from flexspline.results.cli import app
from flexspline.results.report.payload import payload_of
from flexspline.results.study.failures import (
    LISTED_REASONS,
    causes,
    contradiction,
    failure_lines,
    nothing_built,
)
from flexspline.results.study.record import summary, words
from flexspline.results.study.report import study_document

WALL, FILLET = "flexspline.wall_thickness_mm", "shaft.fillet_mm"
STUDY = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ min = 0.3, max = 3.0 }}
"{FILLET}" = {{ min = 0.0, max = 6.0 }}
[run]
method = "sobol"
"""


def result_of(*outcomes: Outcome) -> StudyResult:
    study = study_from(tomllib.loads(STUDY), EXAMPLES, "test")
    rows = (Row(i, {WALL: 0.4, FILLET: 0.5}, each) for i, each in enumerate(outcomes))
    return StudyResult(study, tuple(rows))


def outcome(wall: float, fillet: float) -> Outcome:
    tables = tomllib.loads((EXAMPLES / "xb1-40.toml").read_text(encoding="utf-8"))
    return evaluate(Task(tables, {WALL: wall, FILLET: fillet}, ()))


def test_every_fault_counts_not_only_a_design_s_first() -> None:
    """The wall is thicker than the ring in two designs, the shaft's fillet larger than its step in two."""
    result = result_of(outcome(0.7, 0.5), outcome(0.8, 5.0), outcome(0.4, 3.0))
    found = {cause.name: cause for cause in causes(result)}
    assert {name: cause.designs for name, cause in found.items()} == {
        "flexspline.ring_thickness_mm": 2,
        FILLET: 2,
    }
    shaft = found[FILLET]
    assert shaft.example.slot == 1
    assert shaft.fault.startswith("shaft.fillet_mm = 5")
    assert "segment[0] to segment[1]" in shaft.fault


def test_numbers_alone_make_no_other_cause() -> None:
    result = result_of(
        *(Outcome(faults=(f"K_b: edge {i}.5e-3 mm, {i} rounds",)) for i in (3, 4)),
        Outcome(faults=("K_e: edge 3 mm",)),
    )
    assert [(c.name, c.designs) for c in causes(result)] == [
        ("K_b: edge … mm, … rounds", 2),
        ("K_e: edge … mm", 1),
    ]


def test_report_terminal_and_json_say_the_same() -> None:
    result = result_of(outcome(0.4, 3.0), outcome(0.4, 4.0))
    said = "design 0 has 3.0: must be from 0 to 1 mm"
    record = summary(result)
    (cause,) = record["causes"]
    assert (cause["cause"], cause["designs"], cause["example"]["design"]) == (FILLET, 2, 0)
    assert f"2 × {FILLET}: {said}" in words(result, record | {"files": []})
    assert said in str(payload_of(study_document(result, ())))


def test_many_causes_are_cut_and_counted() -> None:
    letters = [chr(ord("a") + i) for i in range(LISTED_REASONS + 2)]
    lines = list(failure_lines(result_of(*(Outcome(faults=(letter,)) for letter in letters))))
    assert len(lines) == 1 + LISTED_REASONS + 1
    assert "and 2 more causes" in lines[-1]
    assert not list(failure_lines(result_of(Outcome({"K_b_Nm_per_rad": 1.0}))))


def test_no_word_of_constraints_where_there_are_none() -> None:
    result = result_of(Outcome({"K_b_Nm_per_rad": 1.0}))
    assert "constraint" not in words(result, summary(result) | {"files": []})


def test_a_contradiction_of_the_models_is_told_wherever_it_was_met() -> None:
    """In a row or where the best were verified; a fault of another kind is none."""
    failed = Outcome(faults=("K_b: no mesh",))
    assert not contradiction(result_of(failed))
    in_a_row = result_of(failed, Outcome(faults=("two are wrong",), contradicted=True))
    assert contradiction(in_a_row).endswith("in 1 of 2 designs; design 1: two are wrong")
    verified = replace(result_of(failed), verified=(Verified(0, (), "solid is wrong", True),))
    assert contradiction(verified).endswith("in 1 of 1 designs; design 0: solid is wrong")


def test_a_study_in_which_nothing_is_built_names_the_commonest_cause() -> None:
    nothing = nothing_built(result_of(outcome(0.7, 0.5), outcome(0.4, 3.0), outcome(0.4, 4.0)))
    assert nothing.startswith(
        "none of 3 designs could be built and solved; most frequent cause (2 ×): shaft.fillet_mm: design 1"
    )
    assert "must be from 0 to 1 mm" in nothing
    assert not nothing_built(
        result_of(outcome(0.7, 0.5), Outcome(dict.fromkeys(USUAL_FIGURES, 1.0)))
    )


def test_a_study_in_which_nothing_is_built_ends_with_status_1(tmp_path: Path) -> None:
    (tmp_path / "gear.toml").write_text(
        (EXAMPLES / "xb1-40.toml").read_text(encoding="utf-8"), "utf-8"
    )
    file = tmp_path / "short.toml"
    file.write_text(
        f'design = "gear.toml"\n[vary]\n"{WALL}" = {{ values = [2.0, 3.0] }}\n[run]\nmethod = "grid"\n'
        "workers = 1\n",
        "utf-8",
    )
    done = CliRunner().invoke(app, ["study", str(file), "--json"])
    assert done.exit_code == 1
    assert done.stderr.splitlines()[-1].startswith(
        f"flexspline: {file}: none of 2 designs could be built"
    )
    assert json.loads(done.stdout)["failed"] == 2
    assert (tmp_path / "short.out" / "study.csv").exists()
