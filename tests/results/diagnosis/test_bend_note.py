"""What is said of the simulated gear's bend where a record has less of it, or none."""

from __future__ import annotations

from dataclasses import replace

import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NamedCause
from flexspline.results.diagnosis.notes import notes

BEND = Bend((0.0, 1.0, 2.0), (0.0, 12.0, 0.0))
HARDER = NamedCause("stiffness_hardening", 1.0, (), 1.6, 0.03, "1", 40.0, 3.0)


@pytest.fixture(scope="module")
def diagnosis() -> Diagnosis:
    design = load_design(EXAMPLES / "xb1-40.toml")
    return diagnose_file(design, EXAMPLES / "measured" / "xb1-40-sweep.csv", 31_300.0, 44_000.0)


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (0.0, "contains nothing of this deviation"),
        (0.25, "contains up to 3 arcsec of this deviation"),
    ],
)
@pytest.mark.parametrize("cause", [None, HARDER])
def test_a_record_without_the_bend_is_not_said_to_be_straight(
    share: float, words: str, cause: NamedCause | None, diagnosis: Diagnosis
) -> None:
    prediction = replace(
        diagnosis.prediction,
        bend=BEND,
        measured_bend=BEND.scaled(share),
        lost_bend=BEND.scaled(1 - share),
    )
    outcome = DiagnosisOutcome("named", () if cause is None else (cause,))
    said = notes(replace(diagnosis, prediction=prediction, outcome=outcome))
    (note,) = [n for n in said if "deviates from its chord" in n]
    assert words in note
    assert ("Other curvature is counted as" in note) == (cause is not None)
