"""From file and stiffnesses to a diagnosis: what is refused first, and what is never asked for."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.with_stiffness import (
    DiagnosisOptions,
    GivenStiffness,
    diagnose_with_stiffness,
)
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
NAMES = ("K_b = ", "K_e = ")


def no_solver() -> AnalysisContext:
    raise AssertionError("solvers are asked for")


def test_a_missing_file_is_refused_before_anything_is_solved() -> None:
    with pytest.raises(MeasurementError, match="no such file"):
        diagnose_with_stiffness(
            DESIGN, Path("none.csv"), GivenStiffness((None, 4e4), NAMES), no_solver
        )


@pytest.mark.parametrize("given", [(3e4, None), (3e4, 4e4)])
def test_a_stiffness_beside_the_gear_s_curve_is_refused_before_the_file_is_read(
    given: tuple[float | None, float | None],
) -> None:
    with pytest.raises(DesignError, match="takes no K_b"):
        diagnose_with_stiffness(
            DESIGN,
            Path("none.csv"),
            GivenStiffness(given, NAMES),
            no_solver,
            DiagnosisOptions(gear=True),
        )


def test_stiffnesses_given_are_used_and_named_and_nothing_is_solved() -> None:
    said: list[str] = []
    sweep = EXAMPLES / "measured" / "xb1-40-sweep.csv"
    found, used = diagnose_with_stiffness(
        DESIGN,
        sweep,
        GivenStiffness((31377.0, 43275.0), NAMES),
        no_solver,
        progress=Progress(said.append),
    )
    assert (used.K_b_Nm_per_rad, used.K_e_Nm_per_rad) == (31377.0, 43275.0)
    assert found.given == ("K_b = 31377", "K_e = 43275")
    assert found.verdict == "named"
    assert [line.endswith("] diagnosis") for line in said] == [True]
