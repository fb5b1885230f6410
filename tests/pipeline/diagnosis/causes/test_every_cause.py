"""One contract for every cause in `pipeline.diagnosis.causes`, and each magnitude by hand."""

from __future__ import annotations

from dataclasses import replace
from math import exp

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, shape_of, sweep

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext
from flexspline.pipeline.diagnosis.model.shape_check import CHANNELS, channels_needed, fault_of

UNITS = {
    "friction_hysteresis": "arcsec",
    "stiffness_hardening": "1",
    "series_compliance": "%",
    "clearance_offset": "arcsec",
    "thermal_clearance": "arcsec/K",
    "kinematic_error": "arcsec",
    "position_stiffness": "%",
    "direction_asymmetry": "%",
    "creep": "%",
    "wear": "arcsec/cycle",
    "sensor_drift": "arcsec/h",
    "torque_offset": "N·m",
    "rate_dependence": "arcsec per N·m/s",
}
"""The contract's table of sweep causes."""
EVERY = list(known_causes().values())
RIG = FitContext(PREDICTION, sweep())
SEARCHED = {"torque_offset"}
"""Found where the gap is crossed, not by shapes."""
OTHERS = {
    "one row": sweep().rows(np.arange(1)),
    "constant torque": replace(sweep(), torque_Nm=np.full(len(sweep()), 1.3)),
    "three units": sweep(cycles=2, units=3),
    "no holds": sweep(hold=0),
    "one cycle": sweep(cycles=1),
    "coarse": sweep(rows=8, hold=0),
    "standing clock": replace(sweep(), time_s=np.zeros(len(sweep()))),
}

each_cause = pytest.mark.parametrize("cause", EVERY, ids=lambda c: c.id)


def shapes(cause: Cause, rig: FitContext = RIG):
    return [*cause.shapes(rig), *cause.searched_apart] or [{}] * (cause.id in SEARCHED)


def test_the_contract_s_causes_are_all_there() -> None:
    assert {c.id for c in EVERY} == set(UNITS)


@each_cause
def test_words_and_units(cause: Cause) -> None:
    assert cause.unit == UNITS[cause.id]
    assert len(cause.title) > 5
    assert len(cause.reveals) > 15


@each_cause
def test_columns_are_finite_repeatable_and_of_one_shape(cause: Cause) -> None:
    tried = shapes(cause)
    assert tried
    together = cause.columns_of_all(tried, RIG.history)
    for shape, at_once in zip(tried, together, strict=True):
        columns = cause.columns(shape, RIG.history)
        assert columns.shape == at_once.shape
        assert columns.shape[0] == len(RIG.history)
        assert np.isfinite(columns).all()
        assert (columns == cause.columns(shape, RIG.history)).all()
        # the same sums in another order: rounding only
        np.testing.assert_allclose(at_once, columns, atol=1e-9 * (1 + np.abs(columns).max()))
        assert cause.spread(shape, RIG) > 0


@each_cause
def test_linear_in_the_amplitudes(cause: Cause) -> None:
    rng = np.random.default_rng(3)
    for shape in shapes(cause)[:6]:
        k = cause.columns(shape, RIG.history).shape[1]
        one, two = (Element(shape, tuple(rng.normal(size=k))) for _ in range(2))
        both = Element(shape, tuple(2 * np.array(one.amplitudes) + two.amplitudes))
        angle = cause.angle_arcsec([one, one, two], RIG.history)
        expected = cause.angle_arcsec([both], RIG.history)
        np.testing.assert_allclose(angle, expected, atol=1e-9 * (1 + np.abs(angle).max()))


@each_cause
@pytest.mark.parametrize("name", OTHERS)
def test_evaluates_on_any_history(cause: Cause, name: str) -> None:
    """A model fitted on one record predicts others."""
    history = OTHERS[name]
    for columns in cause.columns_of_all(shapes(cause), history):
        assert columns.shape[0] == len(history)
        assert np.isfinite(columns).all()


@each_cause
def test_units_do_not_know_of_each_other(cause: Cause) -> None:
    alone, three = sweep(cycles=2), sweep(cycles=2, units=3)
    for shape in shapes(cause):
        one, all_three = cause.columns(shape, alone), cause.columns(shape, three)
        np.testing.assert_allclose(
            all_three, np.tile(one, (3, 1)), atol=1e-9 * (1 + np.abs(one).max())
        )


@each_cause
def test_no_shapes_without_the_channel(cause: Cause) -> None:
    without = {channel: replace(sweep(), **{channel: None}) for channel in CHANNELS}
    for history in without.values():
        for shape in cause.shapes(FitContext(PREDICTION, history)):
            assert np.isfinite(cause.columns(shape, history)).all()
    for shape in shapes(cause):
        k = cause.columns(shape, RIG.history).shape[1]
        for channel in channels_needed(cause, [Element(shape, (1.0,) * k)]):
            with pytest.raises(ValueError, match="needs"):
                cause.columns(shape, without[channel])


@each_cause
def test_every_shape_may_be_read_back(cause: Cause) -> None:
    """The check of model files refuses nothing that a cause tries, on records of many kinds."""
    known = set()
    for history in (*OTHERS.values(), sweep(cycles=9), sweep(rows=200, hold=50)):
        tried = cause.shapes(FitContext(PREDICTION, history))
        together = cause.columns_of_all(tried, OTHERS["one row"]) if tried else []
        for shape, columns in zip(tried, together, strict=True):
            same = (*sorted(shape.items()), columns.shape[1])
            if same not in known:  # by a record before
                assert fault_of(cause, shape, columns.shape[1]) is None
            known.add(same)
    k = cause.columns(shapes(cause)[0], RIG.history).shape[1]
    assert fault_of(cause, {**shapes(cause)[0], "colour": 1.0}, k) is not None
    assert fault_of(cause, shapes(cause)[0], k + 1) is not None


@pytest.mark.parametrize("cause", [c for c in EVERY if c.positive], ids=lambda c: c.id)
def test_what_may_not_be_negative_has_a_magnitude_of_one_sign(cause: Cause) -> None:
    none = {"stiffness_hardening": 1.0}.get(cause.id, 0.0)
    for shape in shapes(cause):
        small = 0.02 * cause.spread(shape, RIG)
        assert cause.magnitude([Element(shape, (small,))], RIG) > none - 1e-9


# ---- magnitudes, each by a closed form; compliance c = 10 arcsec per N·m, T = 2 N·m


def magnitude(cause_id: str, shape: dict, *amplitudes: float, rig: FitContext = RIG) -> float:
    return known_causes()[cause_id].magnitude([Element(shape, amplitudes)], rig)


def test_friction_is_twice_one_slider_s_amplitude() -> None:
    shape = shape_of("friction_hysteresis", spread=0, loaded=0, held=1, start=0, deadband_Nm=0.0)
    assert shape["threshold_Nm"] < LARGEST / 2  # it has turned over before T = 0
    assert magnitude("friction_hysteresis", shape, 7.0) == pytest.approx(14.0, rel=1e-9)


def test_hardening_of_a_knee() -> None:
    """Below the knee at 0.3 T: compliance c + a/(0.3·2); above: c. Chords lie on either side."""
    shape = shape_of("stiffness_hardening", law=0, held=0, parameter=0.3)
    expected = (10.0 + 3.0 / 0.6) / 10.0
    assert magnitude("stiffness_hardening", shape, 3.0) == pytest.approx(expected, rel=1e-9)


def test_what_is_measured_beyond_the_simulation() -> None:
    rig = replace(RIG, measured=(12.5, 52.0))
    assert magnitude("series_compliance", {}, 0.4, rig=rig) == pytest.approx(25.0)
    assert magnitude("clearance_offset", {}, -3.0, rig=rig) == pytest.approx(-8.0)


def test_gap_per_kelvin() -> None:
    shape = shape_of("thermal_clearance", lag_s=0.0)
    assert magnitude("thermal_clearance", shape, -0.4) == pytest.approx(-0.4)
    warm = replace(sweep(), temperature_C=np.full(len(sweep()), 30.0))
    added = known_causes()["thermal_clearance"].columns(shape, warm)[:, 0] * -0.4
    # the gap changes by 10 K · −0.4; either side moves by half of it
    np.testing.assert_allclose(added, -2.0 * np.sign(warm.torque_Nm), atol=1e-12)


def test_largest_harmonic() -> None:
    shape = {"harmonic": 2.0}
    assert magnitude("kinematic_error", shape, 3.0, -4.0) == pytest.approx(5.0)
    assert magnitude("position_stiffness", shape, 0.3, 0.4) == pytest.approx(100 * 0.5 / 10.0)


def test_asymmetry_of_two_compliances() -> None:
    """Compliance 10 + 0.5 one way and 10 − 0.5 the other."""
    shape = shape_of("direction_asymmetry", exponent=1.0, rounding_Nm=0.0)
    plus, minus = 1 / 10.5, 1 / 9.5
    expected = 100 * (plus - minus) / ((plus + minus) / 2)
    assert magnitude("direction_asymmetry", shape, 0.5) == pytest.approx(expected, rel=1e-9)


def test_creep_of_one_kelvin_element() -> None:
    """Growth from a tenth of the hold to its end, 1 − exp(−t/τ) each, against the elastic twist."""
    hold, tau = 40.0, 25.0
    shape = shape_of("creep", shortest_s=tau, longest_s=tau, exponent=0.0, hold_s=hold)
    expected = 100 * 0.8 * (exp(-0.1 * hold / tau) - exp(-hold / tau)) / 10.0
    assert magnitude("creep", shape, 0.8) == pytest.approx(expected, rel=1e-9)


def test_growth_per_cycle_and_per_hour() -> None:
    assert magnitude(
        "wear", shape_of("wear", exponent=1.0, run_in_cycles=0.0), 6.0
    ) == pytest.approx(6.0 / 3)
    hours = 5.0 * (len(sweep()) - 1) / 3600
    shape = shape_of("sensor_drift", exponent=1.0, settling_s=0.0)
    assert magnitude("sensor_drift", shape, 2.0) == pytest.approx(2.0 / hours)
    angle = known_causes()["sensor_drift"].columns(shape, sweep())[:, 0] * 2.0
    assert angle[-1] - angle[0] == pytest.approx(2.0)


def test_lag_per_rate() -> None:
    """On a long ramp the twist lags by a·dT/dt, whatever the time constant."""
    shape = shape_of("rate_dependence", exponent=1.0, lag_s=2.0, deadband_Nm=0.0)
    assert magnitude("rate_dependence", shape, 30.0) == pytest.approx(30.0)
    history = sweep(cycles=1, hold=0, rows=400)  # 0.02 N·m in 5 s: 0.004 N·m/s
    added = known_causes()["rate_dependence"].columns(shape, history)[:, 0] * 30.0
    assert added[50] == pytest.approx(-30.0 * 0.004, rel=1e-6)
    assert added[250] == pytest.approx(30.0 * 0.004, rel=1e-6)


def test_torque_offset_is_the_reading_s() -> None:
    offset = known_causes()["torque_offset"]
    elements = [Element({}, (0.05,))]
    assert offset.magnitude(elements, RIG) == pytest.approx(0.05)
    true = offset.corrected(elements, RIG.history)
    np.testing.assert_allclose(true.torque_Nm, RIG.history.torque_Nm - 0.05)


@each_cause
def test_shapes_that_differ_but_for_a_spring_do(cause: Cause) -> None:
    """What two of them differ by is in proportion to the torque."""
    torque = RIG.history.torque_Nm
    for shape in shapes(cause):
        own = cause.columns(shape, RIG.history)[:, 0]
        for other in cause.but_for_a_spring(shape, RIG):
            apart = cause.columns(other, RIG.history)[:, 0] - own
            slope = apart @ torque / (torque @ torque)
            assert apart == pytest.approx(slope * torque, abs=1e-9)
            assert abs(slope) > 1e-3


def test_a_steepening_twist_s_rate_dependence_is_that_of_the_record_s_rates() -> None:
    """Of 3·(q/0.2)² at rates q of 0.2 and 0.4 N·m/s, as many rows each: Σ q³/Σ q² = 0.36 times 3/0.2²."""
    rate = known_causes()["rate_dependence"]
    history = sweep(cycles=2, rows=400, hold=0)
    assert history.time_s is not None
    steps = np.where(history.cycle == 0, LARGEST / 100 / 0.2, LARGEST / 100 / 0.4)
    history = replace(history, time_s=np.cumsum(steps))
    shape = shape_of("rate_dependence", history, exponent=2.0, lag_s=0.01, rate_Nm_per_s=0.2)
    found = rate.magnitude((Element(shape, (15.0,)),), FitContext(PREDICTION, history))
    assert found == pytest.approx(
        3 / 0.2**2 * 0.36, rel=0.02
    )  # corners of the torque are 2 % of the rows
