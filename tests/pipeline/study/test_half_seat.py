"""The peak on a seat half as wide in studies: the same as `flexspline stiffness`, solved where asked for."""

from __future__ import annotations

import pytest
from example_files import EXAMPLES
from study_bench import GRID, study_of

import flexspline
from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.types import Elastic
from flexspline.geometry.meridian import with_narrow_seat
from flexspline.pipeline.study.evaluate import STUDY_STRESS_TOLERANCE, Task, evaluate
from flexspline.pipeline.study.figures import USUAL_SOLVES
from flexspline.pipeline.study.source import solves_of

HALF_SEAT = "wave_generator_peak_half_seat_mises_MPa"
CUP = flexspline.load_design(EXAMPLES / "xb1-40.toml")


def test_a_row_has_the_peak_of_the_narrow_seat() -> None:
    """The example's bolt holes are left out, as `flexspline stiffness` leaves them out of this figure."""
    row = evaluate(Task(CUP.tables, {}, ("half_seat",)))
    assert row.reason == ""
    part = CUP.part("flexspline").without_holes()
    fine = ellipse_stress(
        with_narrow_seat(part.meridian, 0.5), Elastic.of(part.material), CUP.w0_mm,
        part.exclusion_mm, STUDY_STRESS_TOLERANCE / 4,
    ).peak  # fmt: skip
    # the study's mesh is settled to its own tolerance
    assert row.figures[HALF_SEAT] == pytest.approx(fine.mises_MPa, rel=STUDY_STRESS_TOLERANCE)
    assert row.figures["wave_generator_peak_half_seat_at_excluded_border"] == 0.0
    assert "wave_generator_peak_mises_MPa" not in row.figures


@pytest.mark.parametrize(
    "asked",
    [
        GRID.replace("K_b_Nm_per_rad", HALF_SEAT).replace("maximize", "minimize"),
        GRID + f'[constraint]\n"{HALF_SEAT}" = {{ max = 480.0 }}\n',
    ],
)
def test_it_is_solved_only_where_it_is_asked_for(asked: str) -> None:
    assert "half_seat" not in solves_of(study_of(GRID), USUAL_SOLVES)
    assert "half_seat" in solves_of(study_of(asked), USUAL_SOLVES)
