"""Which measurement to advise: the one that tells rivals apart, not the longest one."""

from dataclasses import replace

import numpy as np
from histories import joined, shape_of, sweep

from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.plans import MeasurementPlan, most_telling, separations

PLAIN = ExtendedModel(11.0, 70.0, {"": 0.0}, {}, {})
WARM = replace(
    PLAIN, elements={"thermal_clearance": (Element(shape_of("thermal_clearance"), (-0.4,)),)}
)
"""The gap shrinks as the gear warms up."""


def test_a_plan_is_not_better_for_its_length() -> None:
    """Warming up by 12 K tells the two apart; seven cycles that warm by 4 K add up to more readings only."""
    one = sweep(cycles=1)
    share = np.linspace(0.0, 1.0, len(one))
    telling = replace(one, temperature_C=20.0 + 12.0 * share)
    dull = joined([replace(one, temperature_C=20.0 + 5.0 * share)] * 7)
    plans = [
        MeasurementPlan("temperature_C", "warm it up", telling),
        MeasurementPlan("input_angle_deg", "seven positions", dull),
    ]
    assert separations(plans, [PLAIN, WARM], 0.4)[0].vary == "input_angle_deg"
    assert most_telling(plans, [PLAIN, WARM], 0.4).vary == "temperature_C"
