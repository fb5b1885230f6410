"""Which measurement to advise: the one that tells rivals apart, not the longest one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, joined, shape_of, sweep

from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import Doing
from flexspline.pipeline.diagnosis.plans import MeasurementPlan, most_telling, separations
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.held_out_splits import rate_range
from flexspline.pipeline.diagnosis.sweep.next_measurement import plans
from flexspline.results.diagnosis.advice import why

pytestmark = pytest.mark.usefixtures("causes_only")

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


def sliding_record(periods_s: tuple[float, ...], slope: float = 10.0, width: float = 5.0) -> Sweep:
    """Triangles of 2 N·m, a period each: a line [arcsec per N·m], a gap, and a block that slips at 0.2 N·m,
    `width` arcsec wide."""
    phase = (np.arange(100 * len(periods_s)) + 0.5) / 100
    torque = 4 / np.pi * np.arcsin(np.sin(2 * np.pi * phase))
    start = np.r_[0.0, np.cumsum(periods_s)]
    time = np.interp(phase, np.arange(len(start)), start)
    at, block = 0.0, np.empty(len(torque))
    for k, q in enumerate(torque):
        at = min(max(at, q - 0.2), q + 0.2)
        block[k] = at
    noise = np.random.default_rng(4).normal(0, 0.3, len(torque))
    angle = slope * torque + 30.0 * np.sign(torque) - width / 2 * (torque - block) / 0.2 + noise
    cycle = phase.astype(int)
    history = History(torque, np.zeros(len(torque), int), cycle, time)
    numbers = (tuple(np.unique(cycle) + 1.0),)
    return Sweep(Path("m.csv"), history, angle, ("",), numbers, np.arange(len(angle)) + 2, True)


@pytest.mark.parametrize(
    ("periods", "vary", "doing"),
    [
        ((60.0, 60.0, 60.0, 60.0), "torque_rate", None),
        ((20.0, 60.0, 720.0, 20.0), "torque_amplitude", "larger_torque"),
    ],
)
def test_what_the_record_has_is_not_asked_for(
    periods: tuple[float, ...], vary: str, doing: str | None
) -> None:
    """Cycles that differ by 36 times have shown already that friction does not follow the rate."""
    outcome, _ = diagnose_sweep(sliding_record(periods), PREDICTION)
    assert [c.id for c in outcome.causes] == ["friction_hysteresis"]
    after = outcome.next_measurement
    assert after is not None
    assert (after.aim, after.vary, after.doing and after.doing.kind) == ("confirm", vary, doing)


def test_a_part_left_out_is_confirmed_by_larger_torques() -> None:
    """What is to be varied is what the words beside it speak of."""
    outcome, _ = diagnose_sweep(sliding_record((60.0,) * 4, slope=16.0, width=0.0), PREDICTION)
    assert [c.id for c in outcome.causes] == ["series_compliance"]
    after = outcome.next_measurement
    assert after is not None
    assert (after.aim, after.vary) == ("confirm", "torque_amplitude")


def test_other_rates_lie_beyond_those_of_the_record() -> None:
    """0.4 and 0.011 N·m/s: the plan goes to ten times either, by triangles of the record's torque."""
    prepared = prepare(sliding_record((20.0, 60.0, 720.0, 20.0)), PREDICTION)
    (plan,) = [p for p in plans(prepared) if p.vary == "torque_rate"]
    now, new = rate_range(prepared.sweep.history), []
    for rows in np.array_split(np.arange(len(plan.history)), 3):  # its cycles have one number
        new.append(rate_range(plan.history.rows(rows))[0])
    # the record's rate is of steps between rows, a triangle's first row lies within its way
    assert max(new) == pytest.approx(10 * now[0], rel=0.1)
    assert min(new) == pytest.approx(now[1] / 10, rel=0.1)


@pytest.mark.parametrize(
    ("warmer_K", "vary", "doing"),
    [(6.0, "torque_amplitude", "larger_torque"), (0.6, "temperature_C", None)],
)
def test_temperatures_that_the_record_has_are_not_asked_for(
    warmer_K: float, vary: str, doing: str | None
) -> None:
    """Cycles 6 K apart have shown what the gap does with temperature; 3 K in all are a room’s own drift."""
    record = sliding_record((60.0,) * 6, width=0.0)
    warm = 20.0 + warmer_K * record.history.cycle
    gap = -2.0 * (warm - 20.0)
    record = replace(
        record,
        history=replace(record.history, temperature_C=warm),
        angle_arcsec=record.angle_arcsec + np.sign(record.history.torque_Nm) * gap / 2,
    )
    outcome, _ = diagnose_sweep(record, PREDICTION)
    assert [c.id for c in outcome.causes] == ["thermal_clearance"]
    after = outcome.next_measurement
    assert after is not None
    assert (after.aim, after.vary, after.doing and after.doing.kind) == ("confirm", vary, doing)


@pytest.mark.parametrize(
    ("rated", "torques"),
    [
        (None, (0.49, 0.98, 1.96, 2.94)),
        (8.0, (0.49, 0.98, 1.96, 2.94)),
        (2.6, (0.49, 0.98, 1.96, 2.6)),
        (2.0, None),  # as good as reached
        (1.2, None),
    ],
)
def test_no_larger_torque_is_asked_for_than_the_rated_one(
    rated: float | None, torques: tuple[float, ...] | None
) -> None:
    """Of a record up to 1.96 N·m that has shown all but how its friction goes on beyond."""
    prediction = replace(PREDICTION, rated_Nm=rated)
    outcome, _ = diagnose_sweep(sliding_record((20.0, 60.0, 720.0, 20.0)), prediction)
    after = outcome.next_measurement
    if torques is None:
        assert after is None
        return
    assert after is not None
    assert after.doing == Doing("larger_torque", torques, rated)
    said = why(after, "sweep")
    assert "sweep to 0.49, 0.98, 1.96, " in said
    stated = "within the rated torque of" if rated else "as far as the gear's rated torque allows"
    assert stated in said


def test_plans_that_are_compared_keep_to_rated_torque() -> None:
    prepared = prepare(sliding_record((60.0,) * 4), replace(PREDICTION, rated_Nm=1.5))
    for plan in plans(prepared):
        assert plan.history.largest_Nm <= 2.0 + 1e-9  # what the record has reached itself


def test_an_effect_of_the_position_asks_for_positions() -> None:
    """Ten positions have shown it: more torque says no more, whatever the rated one is."""
    record = sliding_record((60.0,) * 10, width=0.0)
    place = 36.0 * record.history.cycle
    angle = record.angle_arcsec + 6 * np.cos(np.radians(place - 50.0))
    history = replace(record.history, input_angle_deg=place)
    outcome, _ = diagnose_sweep(
        replace(record, history=history, angle_arcsec=angle), replace(PREDICTION, rated_Nm=50.0)
    )
    assert [c.id for c in outcome.causes] == ["kinematic_error"]
    after = outcome.next_measurement
    assert after is not None
    assert (after.vary, after.doing) == ("input_angle_deg", Doing("between_positions"))
    said = why(after, "sweep")
    assert "wave generator angles half way between those measured" in said
    assert "larg" not in said
