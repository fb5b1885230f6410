"""The line that a study shows while it runs."""

import tomllib

import pytest
from example_files import EXAMPLES

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.drive import StudyProgress
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.load import study_from
from flexspline.results.study.progress import Watch, line

WALL = "flexspline.wall_thickness_mm"
STUDY = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ values = [0.38, 0.4, 0.42] }}
[objective]
"K_b_Nm_per_rad" = "maximize"
[run]
method = "grid"
"""


def test_the_end_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    study = study_from(tomllib.loads(STUDY), EXAMPLES, "test")
    watch = Watch(study)
    row = Row(0, {WALL: 0.4}, Outcome({"K_b_Nm_per_rad": 30e3}))
    for _ in range(2):
        watch(StudyProgress([row], 1, 4.0, 1))
    assert capsys.readouterr().err.count("1 of 1 designs") == 1


def test_rate_best_and_time_left() -> None:
    """Four rows, two of them in these 4 s, six to go: half a design per second."""
    study = study_from(tomllib.loads(STUDY), EXAMPLES, "test")
    figures = ({"K_b_Nm_per_rad": 30e3}, {"K_b_Nm_per_rad": 31e3}, {"K_b_Nm_per_rad": 29e3})
    rows = [Row(i, {WALL: 0.4}, Outcome(f)) for i, f in enumerate(figures)]
    rows.append(Row(3, {WALL: 0.9}, Outcome(faults=("too thick",))))
    said = line(study, StudyProgress(rows, 2, 4.0, 10)).replace("\N{NARROW NO-BREAK SPACE}", " ")
    assert said.split(" · ") == [
        "4 of 10 designs", "0.50 per s", "1 cannot be built or solved", "best 31 000 N·m/rad",
        "12 s left",
    ]  # fmt: skip


def test_a_tolerance_study_has_no_best() -> None:
    text = STUDY.replace('method = "grid"', 'method = "tolerance"\nevaluations = 64')
    text = text.replace(
        '[vary]\n"flexspline.wall_thickness_mm" = { values = [0.38, 0.4, 0.42] }\n', ""
    )
    study = study_from(tomllib.loads(text), EXAMPLES, "test")
    assert "best" not in line(
        study, StudyProgress([Row(0, {}, Outcome({"K_b_Nm_per_rad": 30e3}))], 1, 4.0, 64)
    )
