"""What predictions may be off by: by hand, in the file, and where they extrapolate."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, shape_of, sweep

from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.measurement.errors import ModelFileError
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.doubt import (
    BEYOND_THE_EDGE,
    Deviation,
    PredictionUncertainty,
    deviation_of,
    parameter_columns,
    parameter_count,
)
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.extrapolation import extrapolated
from flexspline.pipeline.diagnosis.model.friction_memory import smaller_loops
from flexspline.pipeline.diagnosis.model.model_file import Provenance, read_model_file
from flexspline.pipeline.diagnosis.model.model_text import model_text
from flexspline.pipeline.diagnosis.model.predict import predict_file
from flexspline.pipeline.diagnosis.model.span import MeasuredSpan, span_of
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.results.diagnosis.prediction_words import beyond_words, prediction_warnings

PLAIN = ExtendedModel(11.0, 70.0, {"": 5.0}, {}, {})
ORIGIN = Provenance("flexspline", "gear", "m.csv", "0" * 64, "named", 3e4, 4e4, True, {}, {})
RECORD = sweep()
COVARIANCE = np.array([[0.04, 0.01, 0.0], [0.01, 0.09, 0.0], [0.0, 0.0, 0.16]])


def doubt(covariance: np.ndarray = COVARIANCE, **other: float) -> PredictionUncertainty:
    return replace(PredictionUncertainty(0.3, 0.0, covariance, span_of(RECORD)), **other)


def std(
    history: History, of: PredictionUncertainty | None = None, model: ExtendedModel = PLAIN
) -> np.ndarray:
    return deviation_of(model, of or doubt(), history, ("",)).std_arcsec


def test_reading_zero_compliance_and_gap_by_hand() -> None:
    """var = 0.3² + var z + 2·cov(z, c)·T + var c·T² + var g/4; at T = 0 half the gap, squared."""
    T = RECORD.torque_Nm
    expected = 0.09 + 0.04 + 0.02 * T + 0.09 * T**2 + np.where(T != 0, 0.04, 70.0**2 / 4)
    np.testing.assert_allclose(std(RECORD) ** 2, expected, rtol=1e-12)


def test_torque_noise_counts_near_the_gap_only() -> None:
    """Near T = 0 either side is as likely: off by the gap every second time, its square halved."""
    history = replace(
        RECORD, torque_Nm=np.where(np.abs(RECORD.torque_Nm) < 0.01, 1e-9, RECORD.torque_Nm)
    )
    noisy = std(history, doubt(np.empty((0, 0)), torque_noise_Nm=0.01))
    at_zero = history.torque_Nm == 1e-9
    np.testing.assert_allclose(noisy[at_zero] ** 2, 0.09 + 70.0**2 / 2, rtol=1e-6)
    np.testing.assert_allclose(noisy[np.abs(history.torque_Nm) > 0.1], 0.3, rtol=1e-12)


@pytest.mark.parametrize(
    ("channel", "changed", "growth"),
    [
        ("torque_Nm", replace(RECORD, torque_Nm=2 * RECORD.torque_Nm, time_s=2 * RECORD.time_s), 2.0),
        ("temperature_C", replace(RECORD, temperature_C=np.full(len(RECORD), 32.5 + 24.0)), 2.85),
        ("input_angle_deg", replace(RECORD, input_angle_deg=np.full(len(RECORD), 141.0 + 90.0)), 2.0),
        ("torque_rate", replace(RECORD, time_s=RECORD.time_s / 4), 1 + 2 - np.log2(1.5)),
    ],
)  # fmt: skip
def test_deviations_grow_outside_what_was_measured(
    channel: str, changed: History, growth: float
) -> None:
    """Temperature: 24 K above 32.5 °C of a range of 13 K. Position: a quarter turn past 0° to 141°."""
    found = deviation_of(PLAIN, doubt(np.empty((0, 0))), changed, ("",))
    assert set(found.rows_beyond) == {channel}
    assert found.std_arcsec[changed.torque_Nm != 0].max() == pytest.approx(
        0.3 * growth, rel=0.01
    )  # of the range: ± 0.1 K
    assert deviation_of(PLAIN, doubt(), RECORD, ("",)).rows_beyond == {}


def test_half_of_what_a_cause_adds_beyond_the_edge() -> None:
    """A gap that changes by −0.4 arcsec/K adds 0.2 arcsec on either side for each kelvin beyond 32.5 °C."""
    model = replace(PLAIN, elements={
        "thermal_clearance": (Element(shape_of("thermal_clearance"), (-0.4,)),)
    })  # fmt: skip
    warm = replace(RECORD, temperature_C=np.full(len(RECORD), 60.0))
    of = doubt(np.empty((0, 0)), reading_arcsec=0.0)
    highest = RECORD.temperature_C.max()
    far = np.abs(RECORD.torque_Nm) > 0.1
    expected = BEYOND_THE_EDGE * 0.2 * (60.0 - highest)
    np.testing.assert_allclose(std(warm, of, model)[far], expected, rtol=1e-9)


def test_half_of_what_a_rate_dependence_loses_where_torque_is_slower_than_measured() -> None:
    """A lag of 2 s with 3 arcsec per N·m/s: 3 arcsec times the rate on a ramp that has gone on for long."""
    shape = shape_of(
        "rate_dependence", lag_s=2.0, exponent=1.0, rate_Nm_per_s=1.0, ramp_s=10.0, deadband_Nm=0.0
    )
    model = replace(PLAIN, elements={"rate_dependence": (Element(shape, (3.0,)),)})
    torque, none = np.linspace(0, 10, 401), np.zeros(401, int)
    of = replace(
        doubt(np.empty((0, 0)), reading_arcsec=0.0),
        span=MeasuredSpan((-10.0, 10.0), rate_Nm_per_s=1.0, slowest_rate_Nm_per_s=0.5),
    )
    for rate, expected in ((0.5, 0.0), (0.4, 0.0), (0.05, BEYOND_THE_EDGE * 3 * (0.5 - 0.05))):
        history = History(torque, none, none, time_s=torque / rate)
        found = deviation_of(model, of, history, ("",))
        assert found.std_arcsec[-1] == pytest.approx(expected, rel=0.01, abs=1e-9)
        assert found.rows_beyond == ({} if expected == 0 else {"slow_torque_rate": 401})
        (*_, words) = ["", *map(beyond_words, extrapolated(found, of.span, history))]
        assert ("are slower than measured" in words) == (expected > 0)
        assert deviation_of(PLAIN, of, history, ("",)).rows_beyond == {}  # it knows no rate


STOP = replace(PLAIN, elements={"friction_hysteresis": (Element(
    shape_of("friction_hysteresis", threshold_Nm=0.3, spread=0, loaded=0, held=1, start=0,
             deadband_Nm=0.0), (2.0,)
),)})  # fmt: skip
"""One elastic-perfectly plastic element: 0.3 N·m, 2 arcsec to either side."""


def triangles(*peaks_Nm: float) -> History:
    """0 → +A → −A → 0 of each peak, 0.02 N·m a row."""
    ways = [(0.0, a, -a, 0.0) for a in peaks_Nm]
    corners = [0.0, *(end for way in ways for end in way[1:])]
    torque = np.concatenate([
        np.arange(1, round(abs(b - a) / 0.02) + 1) * 0.02 * np.sign(b - a) + a
        for a, b in pairwise(corners)
    ])  # fmt: skip
    return History.course(torque)


def test_what_friction_remembers_is_unknown_until_torque_has_wiped_it_out() -> None:
    """By hand: come to the first row from above a stop stands at −r, from below at r; a new one at T.

    From there it follows torque up to r: the past from above is wiped out after 2r = 0.6 N·m.
    """
    read = triangles(2.0, 2.0)
    torque = np.arange(1, 101) * 0.02
    new = np.minimum(torque / 0.3, 1)
    above = np.minimum((torque - 0.02) / 0.3 - 1, 1)
    expected = 0.3**2 + 2.0**2 * ((new - above) ** 2 + (new - 1) ** 2) / 2
    found = std(read, doubt(np.empty((0, 0))), STOP)
    np.testing.assert_allclose(found[:100] ** 2, expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found[100:][read.torque_Nm[100:] != 0], 0.3, rtol=1e-9)


@pytest.mark.parametrize("after", [(2.0,), (0.4, 2.0), (3.0, 3.0)])
def test_no_row_s_deviation_hangs_on_the_rows_after_it(after: tuple[float, ...]) -> None:
    """Ten loops of 1 N·m that wipe out 0.3 N·m: as sure whatever is measured afterwards."""
    alone, longer = triangles(*(1.0,) * 10), triangles(*(1.0,) * 10, *after)
    of = doubt(np.empty((0, 0)), span=span_of(triangles(1.0, 2.0)))
    n = len(alone)
    np.testing.assert_allclose(std(longer, of, STOP)[:n], std(alone, of, STOP), rtol=1e-9)


def test_the_file_holds_it_exactly(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(model_text(PLAIN, ORIGIN, doubt=doubt()), encoding="utf-8")
    back = read_model_file(path).doubt
    assert back is not None
    np.testing.assert_array_equal(back.covariance, COVARIANCE)
    none = np.zeros((0, 0))  # the same object on both sides: arrays have no truth value
    assert vars(replace(back, covariance=none)) == vars(replace(doubt(), covariance=none))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[0.04],", "", "row 1 of covariance"),
        ("[0.01, 0.09],", "[0.01, true],", "row 2 of covariance"),
        ("0.16]", "-0.16]", "a variance above 0"),
        ("  [0.0, 0.0, 0.16],\n", "", "of 2 parameters; the model has 3"),
        ("reading_arcsec = 0.3", "reading_arcsec = -0.3", "must not be negative"),
        ("smallest_loop_Nm = 2.0", "smallest_loop_Nm = 0.0", "must be above 0"),
        ("torque_Nm = [-2.0, 2.0]", "torque_Nm = [2.0, -2.0]", "the smaller first"),
        ("[doubt.measured]", "[doubt.other]", "measured is missing"),
    ],
)
def test_what_is_wrong_in_the_file_is_said(old: str, new: str, said: str, tmp_path: Path) -> None:
    text = model_text(PLAIN, ORIGIN, doubt=doubt())
    assert old in text
    path = tmp_path / "model.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(ModelFileError, match=said):
        read_model_file(path)


def test_a_prediction_says_which_rows_extrapolate(tmp_path: Path) -> None:
    path, csv = tmp_path / "model.toml", tmp_path / "t.csv"
    path.write_text(model_text(PLAIN, ORIGIN, doubt=doubt()), encoding="utf-8")
    csv.write_text("torque_Nm\n" + "".join(f"{t / 10}\n" for t in range(31)))
    found = predict_file(read_model_file(path), csv)
    (warning,) = prediction_warnings(found)
    assert warning == (
        "9 of 31 rows are beyond the measured torque: this file spans 0 to 3 N·m, the model's record "
        "-2 to 2 N·m; the model is less certain there, so their standard deviations are larger"
    )
    assert found.angle_std_arcsec is not None
    assert found.angle_std_arcsec[-1] > 1.4 * found.angle_std_arcsec[20]


def test_columns_are_as_many_as_counted() -> None:
    model = ExtendedModel(
        11.0, 70.0, {"a": 1.0, "b": 2.0},
        {"kinematic_error": (Element(shape_of("kinematic_error"), (1.0, 2.0)),),
         "torque_offset": (Element({}, (0.01,)),)},
        {"a": (0.0, 0.0), "b": (0.0, 0.0)},
    )  # fmt: skip
    history = sweep(units=2)
    columns = parameter_columns(model, history, model.at_teeth(history), ("a", "b"))
    assert columns.shape[1] == parameter_count(model) == 2 + 2 + 4 + 2 + 1


def test_friction_in_smaller_loops_than_any_measured_is_not_known() -> None:
    shape = shape_of("friction_hysteresis", threshold_Nm=0.3, spread=0, loaded=0, held=1, start=1)
    model = replace(PLAIN, elements={"friction_hysteresis": (Element(shape, (2.0,)),)})
    for size, wide in ((0.9, False), (0.5, True)):
        loops = replace(RECORD, torque_Nm=size * RECORD.torque_Nm)
        found = deviation_of(model, doubt(np.empty((0, 0))), loops, ("",))
        settled = (np.arange(len(RECORD)) > 60) & (RECORD.torque_Nm != 0)
        assert bool(found.std_arcsec[settled].min() > 1.9) is wide
        turned = len(RECORD) - int(np.argmax(np.diff(RECORD.torque_Nm) < 0)) - 1
        assert found.rows_beyond == ({"torque_amplitude": turned} if wide else {})


def test_small_loops_are_said_with_the_smallest_of_file_and_record() -> None:
    history = replace(RECORD, torque_Nm=0.5 * RECORD.torque_Nm)
    small = Deviation(np.ones(len(history)), {"torque_amplitude": 40})
    (line,) = map(beyond_words, extrapolated(small, span_of(RECORD), history))
    assert line == (
        f"40 of {len(history)} rows are in cycles smaller than measured: the smallest cycle reaches 1 N·m "
        "in this file and 2 N·m in the model's record; the friction of small loops is less certain, "
        "so their standard deviations are larger"
    )


@pytest.mark.parametrize("rows", [1_000, pytest.param(10_000, marks=pytest.mark.long)])
def test_a_reading_of_a_long_record_is_as_noisy_as_one_of_a_short_one(rows: int) -> None:
    """Rows beyond 6000 are averaged; single ones are predicted: 0.6 arcsec, the torque's noise among it."""
    history = sweep(cycles=3, rows=rows, hold=0)
    rng = np.random.default_rng(3)
    of_torque = 0.4 / PREDICTION.compliance
    angle = PREDICTION.angle_arcsec(history) + rng.normal(0, np.sqrt(0.6**2 - 0.4**2), len(history))
    read = replace(history, torque_Nm=history.torque_Nm + rng.normal(0, of_torque, len(history)))
    lines = np.arange(len(angle)) + 2
    record = Sweep(Path("rig.csv"), read, angle, ("",), ((1.0, 2.0, 3.0),), lines, True)
    analysis = diagnose_sweep(record, PREDICTION)[1]
    assert analysis is not None
    # torque's noise leads some rows to the wrong side of the gap; 3000 rows know a deviation to 1.3 %
    assert analysis.doubt.reading_arcsec == pytest.approx(0.6, rel=0.05)


def test_a_record_that_jumps_back_to_zero_has_no_loops_smaller_than_its_own() -> None:
    """Each cycle ends at its largest torque, and the next begins at 0 one row later."""
    one = np.concatenate([np.linspace(0, 2, 20), np.linspace(2, -2, 40), np.linspace(-2, 2, 40)])
    cycle = np.repeat(np.arange(3), len(one))
    history = History(np.tile(one, 3), np.zeros(len(cycle), int), cycle)
    assert not smaller_loops(span_of(history), history).any()
