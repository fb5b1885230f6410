"""Torques that a plan asks for: none beyond rated torque, but where a record goes there itself."""

from __future__ import annotations

import pytest

from flexspline.pipeline.diagnosis.end_points.next_measurement import plans
from flexspline.pipeline.diagnosis.rated_limit import within_rated
from flexspline.results.diagnosis.advice import doing_words

WISHED = (30.0, 60.0, 120.0, 180.0)


@pytest.mark.parametrize(
    ("rated", "kept"),
    [
        (None, WISHED),
        (200.0, WISHED),
        (137.0, (30.0, 60.0, 120.0, 137.0)),
        (122.0, (30.0, 60.0, 120.0)),  # no torque of its own beside 120
        (100.0, (30.0, 60.0, 120.0)),
    ],
)
def test_torques_beyond_the_rated_one_give_way_to_it(
    rated: float | None, kept: tuple[float, ...]
) -> None:
    assert within_rated(WISHED, 120.0, rated) == kept


@pytest.mark.parametrize(("rated", "most"), [(None, 40.0), (25.0, 25.0), (5.0, 10.0)])
def test_end_points_keep_to_it_too(rated: float | None, most: float) -> None:
    for plan in plans(10.0, rated):
        assert plan.history.largest_Nm <= most
        if rated is not None and rated < 10.0 and plan.doing.kind == "closed_sweeps":
            said = doing_words(plan.doing)
            assert "not beyond: the record already exceeds the rated torque of 5 N·m" in said
